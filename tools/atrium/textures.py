"""Procedural, seamlessly tiling textures, as encoded image files."""

from __future__ import annotations

import io
from collections.abc import Sequence

import numpy as np
from PIL import Image

from atrium.mesh import F64

SIZE = 512
"""Texels a side."""


def noise(seed: int, slope: float, size: int = SIZE) -> F64:
    """Tiling noise (size, size) with mean 0 and deviation 1 whose spectrum falls as 1/f^slope."""
    frequency = np.hypot(*np.meshgrid(np.fft.fftfreq(size), np.fft.fftfreq(size)))
    frequency[0, 0] = np.inf
    white = np.fft.fft2(np.random.default_rng(seed).normal(size=(size, size)))
    field = np.fft.ifft2(white * frequency**-slope).real
    return np.asarray(field / field.std())


def _grid() -> tuple[F64, F64]:
    """Texel centres (u, v), each (SIZE, SIZE), 0..1."""
    centre = (np.arange(SIZE) + 0.5) / SIZE
    v, u = np.meshgrid(centre, centre, indexing="ij")
    return u, v


def _srgb(linear: F64) -> F64:
    """IEC 61966-2-1 encoding."""
    clipped = np.clip(linear, 0.0, 1.0)
    return np.where(clipped <= 0.0031308, 12.92 * clipped, 1.055 * clipped ** (1.0 / 2.4) - 0.055)


def _jpeg(image: F64, quality: int = 86) -> bytes:
    """(H, W, 3) or (H, W) values 0..1 as a JPEG file."""
    stream = io.BytesIO()
    pixels = np.round(np.clip(image, 0.0, 1.0) * 255.0).astype(np.uint8)
    Image.fromarray(pixels).save(stream, "JPEG", quality=quality, subsampling=0)
    return stream.getvalue()


def color_map(linear: F64) -> bytes:
    """(H, W, 3) linear reflectance as an sRGB file."""
    return _jpeg(_srgb(linear))


def normal_map(height: F64, metres_a_tile: float) -> bytes:
    """The tangent-space normal map of a tiling height field (H, W) in metres; +y is up (-v)."""
    step = metres_a_tile / SIZE
    du = (np.roll(height, -1, axis=1) - np.roll(height, 1, axis=1)) / (2.0 * step)
    dv = (np.roll(height, -1, axis=0) - np.roll(height, 1, axis=0)) / (2.0 * step)
    normal = np.stack([-du, dv, np.ones_like(du)], axis=-1)
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    return _jpeg(normal * 0.5 + 0.5, 92)


def roughness_map(roughness: F64) -> bytes:
    """(H, W) roughness of a dielectric as a metallic-roughness file."""
    return _jpeg(np.stack([np.ones_like(roughness), roughness, np.zeros_like(roughness)], axis=-1))


def tint(base: Sequence[float], variation: F64) -> F64:
    """A colour times a (H, W) factor, warmer where it is darker: (H, W, 3)."""
    warm = np.stack([variation**0.85, variation, variation**1.2], axis=-1)
    return np.array(base) * warm


def stone() -> tuple[F64, F64]:
    """Limestone: relative colour (H, W) about 1, height in metres."""
    broad, fine = noise(11, 1.6), noise(12, 0.7)
    pits = np.clip(noise(13, 1.0) - 1.7, 0.0, 1.0)
    return 1.0 + 0.045 * broad + 0.03 * fine - 0.25 * pits, 0.0012 * noise(14, 1.4) - 0.006 * pits


def _courses(rows: int, columns: int, joint: float) -> tuple[F64, F64]:
    """A running bond: height 0..1 (1 on the stones, 0 in the joints) and each stone's number."""
    u, v = _grid()
    row = np.floor(v * rows).astype(int)
    shifted = u * columns + 0.5 * (row % 2)
    column = np.floor(shifted).astype(int) % columns
    across = np.abs((shifted % 1.0) - 0.5) / columns
    along = np.abs((v * rows) % 1.0 - 0.5) / rows
    edge = np.minimum(0.5 / columns - across, 0.5 / rows - along)
    return np.clip(edge / joint - 0.4, 0.0, 1.0), (row * columns + column).astype(np.float64)


def _shade_of(number: F64, seed: int, spread: float) -> F64:
    """A factor about 1 for each stone."""
    table = 1.0 + spread * np.random.default_rng(seed).uniform(-1.0, 1.0, 4096)
    return np.asarray(table[number.astype(int)])


def ashlar() -> tuple[F64, F64]:
    """Dressed wall blocks, eight courses of four: relative colour, height in metres."""
    face, number = _courses(8, 4, 0.007)
    color = (0.72 + 0.28 * face) * _shade_of(number, 21, 0.09) * (1.0 + 0.05 * noise(22, 1.3))
    return color, 0.008 * face + 0.0012 * noise(23, 1.2)


def tiles() -> tuple[F64, F64]:
    """Square terracotta floor tiles, six by six: relative colour, height in metres."""
    u, v = _grid()
    count = 6
    across = 0.5 - np.abs(np.stack([u * count % 1.0, v * count % 1.0]) - 0.5)
    face = np.clip(across.min(axis=0) * 14.0 - 0.4, 0.0, 1.0)
    number = np.floor(u * count) * count + np.floor(v * count)
    color = (0.55 + 0.45 * face) * _shade_of(number, 31, 0.18) * (1.0 + 0.06 * noise(32, 1.4))
    return color, 0.004 * face + 0.0008 * noise(33, 1.2)


def marble_floor() -> tuple[F64, F64]:
    """Polished paving with inlaid diamonds: colour (H, W, 3), roughness (H, W)."""
    u, v = _grid()
    cream, green, red = (0.70, 0.64, 0.54), (0.10, 0.17, 0.14), (0.36, 0.11, 0.08)
    cell = np.stack([u * 2.0 % 1.0, v * 2.0 % 1.0]) - 0.5
    diamond = np.abs(cell).sum(axis=0)
    corner = (0.5 - np.abs(cell)).sum(axis=0)
    border = 0.5 - np.abs(cell).max(axis=0)
    veins = np.clip(1.0 - 3.0 * np.abs(noise(41, 1.5)), 0.0, 1.0)
    color = np.broadcast_to(np.array(cream), (*u.shape, 3)).copy()
    color *= (1.0 - 0.22 * veins + 0.03 * noise(42, 1.1))[..., None]
    dark = np.array(green) * (1.0 + 0.9 * veins)[..., None]
    checker = (np.floor(u * 2.0) + np.floor(v * 2.0)) % 2 == 0
    color = np.where(((diamond < 0.30) & checker)[..., None], dark, color)
    inlay = np.array(red) * (1.0 + 0.5 * veins)[..., None]
    color = np.where(((diamond < 0.22) & ~checker)[..., None], inlay, color)
    color = np.where((corner < 0.14)[..., None], dark, color)
    joint = border < 0.006
    color = np.where(joint[..., None], color * 0.45, color)
    roughness = 0.14 + 0.035 * noise(43, 1.3) + 0.05 * veins
    return color, np.clip(np.where(joint, 0.6, roughness), 0.06, 1.0)


def wood() -> tuple[F64, F64]:
    """Planks along u, four a tile: relative colour, height in metres."""
    _, v = _grid()
    plank = np.floor(v * 4.0)
    offset = 40 * plank.astype(int)
    rows = np.arange(SIZE)[:, None]
    columns = (np.arange(SIZE)[None, :] // 10 + offset) % SIZE
    grain = noise(51, 1.1)[rows, columns]
    gap = np.clip((0.5 - np.abs(v * 4.0 % 1.0 - 0.5)) * 40.0, 0.0, 1.0)
    color = (0.4 + 0.6 * gap) * _shade_of(plank, 52, 0.15) * (1.0 + 0.13 * grain)
    return np.clip(color, 0.05, 2.0), 0.004 * gap + 0.0006 * grain


def roof() -> tuple[F64, F64]:
    """Barrel tiles running down v: relative colour, height in metres."""
    u, v = _grid()
    barrel = np.abs(np.sin(np.pi * u * 8.0))
    lap = (v * 4.0 + 0.5 * (np.floor(u * 8.0) % 2)) % 1.0
    number = np.floor(u * 8.0) * 8 + np.floor(v * 4.0 + 0.5 * (np.floor(u * 8.0) % 2)) % 4
    color = _shade_of(number, 61, 0.22) * (0.6 + 0.4 * barrel) * (1.0 + 0.08 * noise(62, 1.2))
    return np.clip(color, 0.05, 2.0), 0.05 * barrel + 0.02 * lap


def damask() -> F64:
    """A woven ornament: relative colour (H, W) for cloth of any dye."""
    u, v = _grid()
    x, y = u * 4.0 % 1.0 - 0.5, (v * 4.0 + 0.5 * (np.floor(u * 4.0) % 2)) % 1.0 - 0.5
    radius, angle = np.hypot(x, y), np.arctan2(y, x)
    petal = radius < 0.22 + 0.12 * np.cos(4.0 * angle)
    ring = np.abs(radius - 0.42) < 0.018
    thread = 0.03 * np.sin(2.0 * np.pi * 128.0 * u) * np.sin(2.0 * np.pi * 128.0 * v)
    return np.where(petal ^ ring, 1.25, 0.85) + thread + 0.03 * noise(71, 0.8)


def melt() -> F64:
    """The melt's glow (H, W, 3), 0..1: bright metal under a broken dark crust."""
    heat = np.clip(0.62 + 0.34 * noise(81, 1.7), 0.0, 1.0)
    cracks = np.clip(1.0 - 4.0 * np.abs(noise(82, 1.5)), 0.0, 1.0)
    glow = np.clip(0.18 + 0.82 * np.maximum(heat**2, cracks), 0.0, 1.0)
    return np.stack([glow, glow**1.9 * 0.85, glow**4.0 * 0.5], axis=-1)
