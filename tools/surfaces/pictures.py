"""The decals' pictures: RGBA and normal maps of 256 texels a side, as PNG files."""

from __future__ import annotations

import io

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from atrium.textures import noise

F64 = NDArray[np.float64]

SIZE = 256
EDGE = 1.5
"""Texels over which an edge goes from nothing to whole."""


def _grid() -> tuple[F64, F64]:
    """x to the right and y up, -1..1, each (SIZE, SIZE)."""
    centre = 2.0 * (np.arange(SIZE) + 0.5) / SIZE - 1.0
    x, y = np.meshgrid(centre, -centre)
    return x, y


def _inside(distance: F64) -> F64:
    """1 where a signed distance (halves of the picture) is below 0, 0 above, over EDGE texels."""
    return np.clip(0.5 - distance * SIZE / (2.0 * EDGE), 0.0, 1.0)


def _png(rgb: F64, alpha: F64 | None = None) -> bytes:
    """Display codes 0..1 as a PNG file."""
    layers = [rgb] if alpha is None else [rgb, alpha[..., None]]
    pixels = np.round(np.clip(np.concatenate(layers, axis=-1), 0, 1) * 255).astype(np.uint8)
    stream = io.BytesIO()
    Image.fromarray(pixels).save(stream, "PNG", optimize=True)
    return stream.getvalue()


def _colored(shape: F64, color: tuple[float, float, float]) -> F64:
    return np.asarray(shape[..., None] * np.array(color))


def _normals(height: F64, texels_high: float) -> F64:
    """Tangent-space normals 0..1 of a height field 0..1 that is so many texels high; +y is up."""
    du = np.gradient(height * texels_high, axis=1)
    dv = np.gradient(height * texels_high, axis=0)
    normal = np.stack([-du, dv, np.ones_like(du)], axis=-1)
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    return np.asarray((normal * 127.0 + 128.0) / 255.0)


def poster() -> bytes:
    """A sun over the sea, in a frame, with torn edges."""
    x, y = _grid()
    sky = _colored(1.0 - 0.35 * np.clip(y, 0, 1), (0.96, 0.74, 0.42))
    ring = np.hypot(x, y - 0.15)
    for radius, color in ((0.62, (0.9, 0.46, 0.24)), (0.45, (0.95, 0.83, 0.55)),
                          (0.3, (0.8, 0.2, 0.12))):  # fmt: skip
        disc = _inside(ring - radius)[..., None]
        sky = sky * (1 - disc) + disc * np.array(color)
    wave = 0.05 * np.sin(9.0 * x) - 0.22
    for level, color in ((0.0, (0.1, 0.34, 0.42)), (-0.16, (0.07, 0.24, 0.34)),
                         (-0.34, (0.04, 0.14, 0.24))):  # fmt: skip
        sea = _inside(y - wave - level * (1.0 + 0.2 * np.sin(4 * x + 3 * level)))[..., None]
        sky = sky * (1 - sea) + sea * np.array(color)
    frame = 1.0 - _inside(np.maximum(np.abs(x), np.abs(y)) - 0.9)
    sky = sky * (1 - frame[..., None]) + frame[..., None] * np.array([0.93, 0.9, 0.82])
    sky *= 1.0 + 0.03 * noise(11, 1.0, SIZE)[..., None]
    torn = np.maximum(np.abs(x), np.abs(y)) + 0.012 * noise(5, 1.2, SIZE) - 0.965
    return _png(sky, _inside(torn))


def splash() -> bytes:
    """A splash of paint: a ragged disc with drops around it."""
    x, y = _grid()
    angle, reach = np.arctan2(y, x), np.hypot(x, y)
    rng = np.random.default_rng(3)
    rim = 0.42 + sum(
        rng.uniform(0.02, 0.07) * np.sin(k * angle + rng.uniform(0, 6.3)) for k in range(2, 12)
    )
    shape = reach - rim
    for _ in range(26):
        turn, far = rng.uniform(0, 2 * np.pi), rng.uniform(0.5, 0.9)
        size = rng.uniform(0.015, 0.06) * (1.2 - far)
        drop = np.hypot(x - far * np.cos(turn), y - far * np.sin(turn)) - size
        shape = np.minimum(shape, drop)
    tone = 1.0 + 0.04 * noise(9, 1.5, SIZE)
    return _png(_colored(tone, (0.74, 0.09, 0.07)), _inside(shape))


def _crack_depth() -> F64:
    """How deep the cracks are, 0..1: the ridges of noise, deepest along the middle."""
    x, y = _grid()
    bent = y + 0.25 * noise(21, 1.8, SIZE) * 0.5
    main = np.exp(-((bent / 0.03) ** 2)) * _inside(np.abs(x) - 0.9)
    fine = np.exp(-((noise(23, 1.7, SIZE) / 0.05) ** 2))
    return np.clip(main + fine * np.exp(-((bent / 0.3) ** 2)) * _inside(np.abs(x) - 0.8), 0.0, 1.0)


def crack() -> bytes:
    """Dark where the cracks are, clear elsewhere."""
    depth = _crack_depth()
    return _png(_colored(np.ones_like(depth), (0.1, 0.09, 0.08)), 0.85 * depth)


def crack_normals() -> bytes:
    """The cracks' walls."""
    return _png(_normals(-_crack_depth(), 5.0))


def puddle() -> bytes:
    """Where a puddle is, in alpha; white."""
    x, y = _grid()
    shore = np.hypot(x, y) - 0.68 + 0.16 * noise(31, 1.9, SIZE)
    alpha = np.clip(0.5 - shore * 6.0, 0.0, 1.0)
    return _png(np.ones((SIZE, SIZE, 3)), alpha)


def rune() -> bytes:
    """A ring with a sign in it; white."""
    x, y = _grid()
    reach = np.hypot(x, y)
    ring = np.minimum(np.abs(reach - 0.82) - 0.05, np.abs(reach - 0.62) - 0.015)
    bars = [np.maximum(np.abs(x), np.abs(y) - 0.45) - 0.045]
    for turn in (0.9, -0.9):
        across = x * np.cos(turn) + y * np.sin(turn)
        along = -x * np.sin(turn) + y * np.cos(turn)
        bars.append(np.maximum(np.abs(across) - 0.04, np.abs(along - 0.18) - 0.26))
    ticks = np.abs(((np.arctan2(y, x) * 12 / np.pi) % 2.0) - 1.0) * 0.09 - 0.03
    shape = np.minimum.reduce([ring, *bars, np.maximum(ticks, np.abs(reach - 0.72) - 0.05)])
    return _png(np.ones((SIZE, SIZE, 3)), _inside(shape))


def arrow() -> bytes:
    """A worn arrow that points up; white."""
    x, y = _grid()
    head = np.maximum(np.abs(x) * 1.1 + (y - 0.85) * 0.9, 0.1 - y)
    shaft = np.maximum(np.abs(x) - 0.2, np.abs(y + 0.35) - 0.5)
    worn = np.clip(0.9 + 0.35 * noise(41, 1.0, SIZE), 0.0, 1.0)
    return _png(np.ones((SIZE, SIZE, 3)), _inside(np.minimum(head, shaft)) * worn)


PICTURES = {
    "poster.png": poster,
    "splash.png": splash,
    "crack.png": crack,
    "crack_normal.png": crack_normals,
    "puddle.png": puddle,
    "rune.png": rune,
    "arrow.png": arrow,
}
"""File name -> its maker."""
