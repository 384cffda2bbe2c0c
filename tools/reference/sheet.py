"""The side-by-side sheet: ours, the reference, the signed relative error in false colour."""

from __future__ import annotations

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from elemental.scene.model import ByteArray, FloatArray
from reference.metrics import relative_error

WHITE_PERCENTILE = 95.0
"""The reference's luminance at this percentile is shown as WHITE_LEVEL."""
WHITE_LEVEL = 0.8
ERROR_RANGE = 0.5
"""Relative error shown in full colour: red where ours is brighter, blue where it is darker."""
LABEL_PX = 18


def tone(radiance: FloatArray, scale: float) -> ByteArray:
    """Linear radiance times `scale` as sRGB bytes, clipped."""
    x = np.clip(radiance * scale, 0.0, 1.0)
    encoded = np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1.0 / 2.4) - 0.055)
    return np.asarray(np.round(encoded * 255.0), dtype=np.uint8)


def false_color(error: FloatArray) -> ByteArray:
    """Signed error (H, W) from blue over white to red."""
    x = np.clip(error / ERROR_RANGE, -1.0, 1.0)[..., None]
    warm, cool = np.array([0.75, 0.05, 0.05]), np.array([0.05, 0.15, 0.75])
    mixed = 1.0 + np.maximum(x, 0.0) * (warm - 1.0) + np.maximum(-x, 0.0) * (cool - 1.0)
    return np.asarray(np.round(mixed * 255.0), dtype=np.uint8)


def sheet(ours: FloatArray, reference: FloatArray, title: str) -> Image.Image:
    """Three pictures beside each other under their labels."""
    luminance = reference.mean(axis=2)
    scale = WHITE_LEVEL / max(float(np.percentile(luminance, WHITE_PERCENTILE)), 1e-9)
    panels = (
        (f"ours: {title}", tone(ours, scale)),
        ("path traced", tone(reference, scale)),
        (
            f"relative error: blue -{ERROR_RANGE:.0%}, red +{ERROR_RANGE:.0%}",
            false_color(relative_error(ours, reference)),
        ),
    )
    height, width = luminance.shape
    picture = Image.new("RGB", (3 * width + 4, height + LABEL_PX), (24, 24, 24))
    draw, font = ImageDraw.Draw(picture), ImageFont.load_default(12)
    for k, (label, pixels) in enumerate(panels):
        picture.paste(Image.fromarray(pixels), (k * (width + 2), LABEL_PX))
        draw.text((k * (width + 2) + 4, 2), label, fill=(230, 230, 230), font=font)
    return picture
