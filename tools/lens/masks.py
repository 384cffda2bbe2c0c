"""Dirt on a lens and shapes of an aperture, as arrays of grey levels 0..1."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Grey = npt.NDArray[np.float64]

DIRT_SIZE = (512, 288)
"""px; it is stretched over the picture."""
SHAPE_SIZE = 64
"""px a side of an aperture's shape."""


def dirt(seed: int = 7) -> Grey:
    """(H, W): dust, droplets with bright rims, wiped streaks and a haze that thickens outwards."""
    rng = np.random.default_rng(seed)
    width, height = DIRT_SIZE
    y, x = np.mgrid[0:height, 0:width].astype(float)
    grey = 0.03 * _haze(rng, x / width, y / width)
    for _ in range(420):  # dust
        grey += _spot(x, y, _place(rng), rng.uniform(0.6, 2.2), rng.uniform(0.05, 0.35))
    for _ in range(60):  # droplets
        grey += _ring(x, y, _place(rng), rng.uniform(4, 22), rng.uniform(0.04, 0.22))
    for _ in range(14):  # streaks of a cloth
        grey += _streak(x, y, _place(rng), rng.uniform(-0.5, 0.2), rng)
    rim = np.hypot(2 * x / width - 1, 2 * y / height - 1) / np.sqrt(2)
    return np.asarray(np.clip(grey * (1.2 + 2.4 * rim**2), 0, 1))


def aperture(blades: int) -> Grey:
    """(SIDE, SIDE): the opening between straight blades, 0: a round one, brighter at its rim."""
    place = (np.arange(SHAPE_SIZE) + 0.5) / SHAPE_SIZE * 2 - 1
    x, y = np.meshgrid(place, place)
    if blades:
        angles = 2 * np.pi * (np.arange(blades) + 0.5) / blades
        inner = np.cos(np.pi / blades)
        reach = np.max([x * np.cos(a) + y * np.sin(a) for a in angles], axis=0) / inner
    else:
        reach = np.hypot(x, y)
    edge = 2.0 / SHAPE_SIZE
    inside = np.clip((1 - edge - reach) / edge + 0.5, 0, 1)
    return np.asarray(inside * (0.62 + 0.38 * np.clip(reach, 0, 1) ** 4))


def _place(rng: np.random.Generator) -> tuple[float, float]:
    width, height = DIRT_SIZE
    return float(rng.uniform(0, width)), float(rng.uniform(0, height))


def _haze(rng: np.random.Generator, u: Grey, v: Grey) -> Grey:
    """Smooth noise of a few waves, about 0..1."""
    sum_ = np.zeros_like(u)
    for octave in range(1, 6):
        direction = rng.uniform(0, 2 * np.pi)
        along = u * np.cos(direction) + v * np.sin(direction)
        sum_ += np.sin(2 * np.pi * (1.7**octave) * along + rng.uniform(0, 6.28)) / octave
    return np.asarray(0.5 + 0.25 * sum_)


def _spot(x: Grey, y: Grey, at: tuple[float, float], radius: float, level: float) -> Grey:
    distance2 = (x - at[0]) ** 2 + (y - at[1]) ** 2
    return np.asarray(level * np.exp(-0.5 * distance2 / radius**2))


def _ring(x: Grey, y: Grey, at: tuple[float, float], radius: float, level: float) -> Grey:
    reach = np.hypot(x - at[0], y - at[1]) / radius
    body = 0.35 * 0.5 * (1 - np.tanh(7 * (reach - 0.95)))
    return np.asarray(level * (body + np.exp(-0.5 * ((reach - 0.9) / 0.07) ** 2)))


def _streak(
    x: Grey, y: Grey, at: tuple[float, float], angle: float, rng: np.random.Generator
) -> Grey:
    along = (x - at[0]) * np.cos(angle) + (y - at[1]) * np.sin(angle)
    across = (y - at[1]) * np.cos(angle) - (x - at[0]) * np.sin(angle)
    across += 0.0004 * rng.uniform(-1, 1) * along**2
    length, width = rng.uniform(40, 160), rng.uniform(0.8, 2.4)
    level = rng.uniform(0.02, 0.10)
    return np.asarray(level * np.exp(-0.5 * (along / length) ** 2 - 0.5 * (across / width) ** 2))
