"""A small late-afternoon sky without its sun, which is a light of its own."""

from __future__ import annotations

import numpy as np

from atrium.mesh import F64
from atrium.textures import noise

WIDTH, HEIGHT = 256, 128
SUN_DIRECTION = (-0.76, 0.66, 0.42)
"""Towards the sun, not normalized; atrium.toml names the opposite, the way its light travels."""


def sky_radiance() -> F64:
    """Equirectangular radiance (HEIGHT, WIDTH, 3): blue zenith, warm towards the sun, clouds.

    Row 0 looks up, the middle column along -z, as `elemental.scene.model.Environment` has it.
    """
    theta = (np.arange(HEIGHT) + 0.5) / HEIGHT * np.pi
    phi = ((np.arange(WIDTH) + 0.5) / WIDTH - 0.5) * 2.0 * np.pi
    up = np.cos(theta)[:, None]
    level = np.sin(theta)[:, None]
    direction = np.stack(
        np.broadcast_arrays(level * np.sin(phi)[None], up, -level * np.cos(phi)[None]), axis=-1
    )
    to_sun = np.array(SUN_DIRECTION) / np.linalg.norm(SUN_DIRECTION)
    towards = direction @ to_sun
    haze = np.exp(-np.clip(up, 0.0, 1.0) * 4.0)[..., None]
    zenith, horizon = np.array([0.16, 0.36, 0.92]), np.array([0.85, 0.80, 0.78])
    sky = zenith + (horizon - zenith) * haze
    glow = np.clip(towards, 0.0, 1.0)[..., None]
    sky = sky + np.array([1.0, 0.72, 0.42]) * (0.35 * glow**4 + 1.4 * glow**48)
    cloud = np.clip(noise(91, 1.9, WIDTH)[:HEIGHT] * 0.8 - 0.35, 0.0, 1.0)[..., None]
    cloud = cloud * np.clip(up * 3.0, 0.0, 1.0)[..., None]
    sky = sky * (1.0 - 0.6 * cloud) + cloud * np.array([1.15, 1.05, 0.98])
    ground = np.array([0.20, 0.17, 0.13])
    return np.asarray(np.where(up[..., None] < 0.0, ground, sky))


def sky_hdr() -> bytes:
    """The sky as a Radiance RGBE picture."""
    return rgbe(sky_radiance())


def rgbe(radiance: F64) -> bytes:
    """Radiance (H, W, 3) as a Radiance RGBE picture, flat scanlines (Ward, "Real Pixels")."""
    height, width = radiance.shape[:2]
    largest = radiance.max(axis=-1)
    mantissa, exponent = np.frexp(largest)
    scale = np.where(largest > 1e-32, mantissa * 256.0 / np.maximum(largest, 1e-32), 0.0)
    pixels = np.empty((height, width, 4), dtype=np.uint8)
    pixels[..., :3] = (radiance * scale[..., None]).astype(np.uint8)
    pixels[..., 3] = np.where(largest > 1e-32, exponent + 128, 0)
    header = f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n"
    return header.encode() + pixels.tobytes()
