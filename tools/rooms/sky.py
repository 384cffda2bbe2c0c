"""The environment of `under_sky`: a gradient, a sun's disc and three bright windows."""

from __future__ import annotations

import numpy as np

from atrium.mesh import F64
from atrium.sky import rgbe

WIDTH, HEIGHT = 128, 64
TO_SUN = (0.55, 0.7, 0.45)
SUN_RADIUS_DEG = 5.0
SUN_RADIANCE = (130.0, 115.0, 90.0)
WINDOW_RADIANCE = (6.0, 7.0, 8.0)
WINDOWS_DEG = ((-150.0, -120.0), (-70.0, -40.0), (20.0, 50.0))
"""Azimuths between which a window stands, from -z towards +x; each from 5 to 35 degrees up."""


def sky_radiance() -> F64:
    """Equirectangular radiance (HEIGHT, WIDTH, 3), laid out as `elemental.scene.model.Environment`.

    Texels on the disc's and the windows' rims are whole or none.
    """
    theta = ((np.arange(HEIGHT) + 0.5) / HEIGHT * np.pi)[:, None]
    azimuth = (((np.arange(WIDTH) + 0.5) / WIDTH - 0.5) * 2.0 * np.pi)[None]
    up, level = np.cos(theta), np.sin(theta)
    direction = np.stack(
        np.broadcast_arrays(level * np.sin(azimuth), up, -level * np.cos(azimuth)), axis=-1
    )
    height = np.clip(up, 0.0, 1.0)[..., None]
    sky = np.array([0.9, 0.85, 0.8]) * (1.0 - height) + np.array([0.25, 0.45, 0.9]) * height
    radiance = np.where(up[..., None] < 0.0, np.array([0.15, 0.13, 0.1]), sky)
    radiance = np.broadcast_to(radiance, direction.shape).copy()
    elevation, turn = 90.0 - np.degrees(theta), np.degrees(azimuth)
    for low, high in WINDOWS_DEG:
        inside = (elevation > 5.0) & (elevation < 35.0) & (turn > low) & (turn < high)
        radiance[inside] = WINDOW_RADIANCE
    to_sun = np.array(TO_SUN) / np.linalg.norm(TO_SUN)
    radiance[direction @ to_sun > np.cos(np.radians(SUN_RADIUS_DEG))] = SUN_RADIANCE
    return radiance


def windows_hdr() -> bytes:
    """The environment as a Radiance RGBE picture."""
    return rgbe(sky_radiance())
