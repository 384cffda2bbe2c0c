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
LINE_PX, FONT_PX, MARGIN_PX = 16, 12, 4


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
    labels = [wrapped(label, width - 2 * MARGIN_PX) for label, _ in panels]
    top = LINE_PX * max(map(len, labels)) + 2
    picture = Image.new("RGB", (3 * width + 4, top + height), (24, 24, 24))
    draw, font = ImageDraw.Draw(picture), ImageFont.load_default(FONT_PX)
    for k, ((_, pixels), lines) in enumerate(zip(panels, labels, strict=True)):
        left = k * (width + 2)
        picture.paste(Image.fromarray(pixels), (left, top))
        for row, line in enumerate(lines):
            place = (left + MARGIN_PX, 2 + row * LINE_PX)
            draw.text(place, line, fill=(230, 230, 230), font=font)
    return picture


def wrapped(label: str, width: int) -> list[str]:
    """The label as lines of at most `width` px, broken at spaces, in words where it has to be."""
    font = ImageFont.load_default(FONT_PX)
    lines = [""]
    for word in label.split():
        joined = f"{lines[-1]} {word}".lstrip()
        if font.getlength(joined) <= width:
            lines[-1] = joined
            continue
        if lines[-1]:
            lines.append("")
        for letter in word:
            if lines[-1] and font.getlength(lines[-1] + letter) > width:
                lines.append("")
            lines[-1] += letter
    return lines
