"""The sun of an environment image: cut out of it, and made a light with a disc and shadows.

Cones of a fixed set of directions meet a disc of half a degree or miss it, so its light falls in
patches; a directional light of the same irradiance does not, and its shadows are sharp. What lies
within the sun's rim keeps at most the rim's radiance. What was above it is summed as a vector
(radiance, direction, solid angle), whose dot product with a normal is the irradiance of any plane
that sees the whole disc: the light has exactly that.

Bright windows, lamps at arm's length and overcast skies are no suns: they are not compact, or
not much brighter than what surrounds them. All thresholds are [inferred], chosen so that the
published skies tried pass and windows of 30 degrees don't.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from elemental.scene.arrays import FloatArray
from elemental.scene.lights import Environment, ImageSun, Light

F64 = npt.NDArray[np.float64]

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
"""Of linear Rec. 709 primaries."""

WIDEST_SUN = math.radians(6.0)
"""Largest angular radius of the disc, rad. The real one has 0.27 degrees, painted ones more."""
WIDEST_RIM = math.radians(10.0)
"""Where the search for the rim ends: a glow that is wider is the sky's."""
FINEST_RING = math.radians(0.25)
"""Width of the rings in which the rim is looked for, where texels are not larger."""
RIM_CONTRAST = 8.0
"""The rim is the first ring whose radiance is at most so many times the sphere's median."""
SUN_CONTRAST = 20.0
"""Least radiance of the disc in those of its rim: windows into a dark room reach 10 to 15."""
LEAST_SHARE = 0.05
"""Least part of the irradiance of a plane that faces the sun: less does no harm in the image."""
TRIES = 4
"""Bright places that are looked at before an image counts as one without a sun."""
MEDIAN_SAMPLES = 512
"""Rows and columns that the median is taken of, at most."""


def with_sun(environment: Environment) -> Environment:
    """The environment with the sun of its image, if it has one."""
    if environment.radiance is None:
        return environment
    return replace(environment, sun=find_sun(environment.radiance))


def find_sun(radiance: FloatArray) -> ImageSun | None:
    """The sun of an equirectangular image (H, W, 3), finite and not negative; None without one.

    Of several the one of the largest irradiance; the others stay in the image.
    """
    image = _Image(radiance)
    if image.texel > WIDEST_SUN:
        return None
    left = image.luminance.copy()
    median = _median(left)
    best: ImageSun | None = None
    for _ in range(TRIES):
        row, column = np.unravel_index(int(left.argmax()), left.shape)
        peak = float(left[row, column])
        if peak <= SUN_CONTRAST * median:
            break
        patch = image.cap(image.direction(int(row), int(column)))
        sun = _sun_in(image, patch, peak, RIM_CONTRAST * median)
        if sun is not None and (best is None or sun.light.intensity > best.light.intensity):
            best = sun
        left[patch.at] = np.where(patch.angle <= WIDEST_RIM, 0.0, left[patch.at])
    return best


@dataclass(frozen=True)
class _Cap:
    """The N texels near a direction, in (rows, columns) ``at``: directions (N, 3), solid (N,) sr,
    angle (N,) rad from that direction, radiance (N, 3)."""

    at: tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]
    directions: F64
    solid: F64
    angle: F64
    radiance: F64


class _Image:
    """The directions and solid angles of an image's texels."""

    def __init__(self, radiance: FloatArray) -> None:
        self.radiance = radiance
        self.height, self.width = radiance.shape[:2]
        self.texel = max(math.pi / self.height, 2.0 * math.pi / self.width)
        self._theta = (np.arange(self.height) + 0.5) * math.pi / self.height
        self._azimuth = ((np.arange(self.width) + 0.5) / self.width - 0.5) * 2.0 * math.pi
        self.luminance = radiance.reshape(-1, 3).dot(LUMINANCE.astype(np.float32))
        self.luminance = self.luminance.reshape(self.height, self.width)
        sines = np.sin(self._theta)
        self.row_solid = sines * (4.0 * math.pi / (sines.sum() * self.width))

    def direction(self, row: int, column: int) -> F64:
        """(3,) unit, towards a texel's centre."""
        towards: F64 = self._directions(np.array([row]), np.array([column]))[0]
        return towards

    def _directions(self, rows: npt.NDArray[np.int64], columns: npt.NDArray[np.int64]) -> F64:
        theta, azimuth = self._theta[rows], self._azimuth[columns]
        level = np.sin(theta)
        return np.stack((level * np.sin(azimuth), np.cos(theta), -level * np.cos(azimuth)), axis=-1)

    def cap(self, towards: F64) -> _Cap:
        """What lies within twice the widest rim of a direction."""
        middle = math.acos(min(max(float(towards[1]), -1.0), 1.0))
        near = np.flatnonzero(np.abs(self._theta - middle) <= 2.0 * WIDEST_RIM)
        theta = self._theta[near, None]
        beside = towards[0] * np.sin(self._azimuth) - towards[2] * np.cos(self._azimuth)
        cosines = beside * np.sin(theta) + towards[1] * np.cos(theta)
        rows, columns = np.nonzero(cosines >= math.cos(2.0 * WIDEST_RIM))
        rows = rows + near[0]
        at = (rows, columns)
        directions = self._directions(rows, columns)
        angle = np.arccos(np.clip(directions @ towards, -1.0, 1.0))
        radiance = self.radiance[at].astype(np.float64)
        return _Cap(at, directions, self.row_solid[rows], angle, radiance)

    def facing_irradiance(self, towards: F64) -> float:
        """Luminance on a plane that faces a direction."""
        x, y, z = towards.tolist()
        level = (x * np.sin(self._azimuth) - z * np.cos(self._azimuth)).astype(np.float32)
        total = 0.0
        for theta, solid, row in zip(self._theta, self.row_solid, self.luminance, strict=True):
            cosines = np.maximum(
                level * np.float32(math.sin(theta)) + np.float32(y * math.cos(theta)), 0
            )
            total += float(cosines.dot(row)) * float(solid)
        return total


def _sun_in(image: _Image, near: _Cap, peak: float, rim_luminance: float) -> ImageSun | None:
    """The sun around the middle of a cap, whose brightest texel has the luminance ``peak``."""
    luminance = near.radiance @ LUMINANCE
    bright = (luminance >= 0.5 * peak) & (near.angle <= WIDEST_RIM)
    centre = _unit((near.solid * luminance)[bright] @ near.directions[bright])
    angle = np.arccos(np.clip(near.directions @ centre, -1.0, 1.0))
    ring = max(image.texel, FINEST_RING)
    number = (angle / ring).astype(np.int64)
    weights = np.bincount(number, near.solid)
    sums = np.bincount(number, near.solid * luminance)
    last = math.ceil(WIDEST_RIM / ring)
    dim = sums[:last] <= rim_luminance * weights[:last]
    dim &= weights[:last] > 0.0
    dim[0] = False
    first = int(dim.argmax()) if dim.any() else last
    around = (number >= first) & (number < first + 2)
    rim = np.average(near.radiance[around], axis=0, weights=near.solid[around])
    inside = number < first
    excess = np.maximum(near.radiance - rim, 0.0) * inside[:, None]
    power = excess @ LUMINANCE * near.solid
    if not power.any():
        return None
    # Of a uniform disc its very area, however far a faint glow goes on.
    area = power.sum() ** 2 / (power * power / near.solid).sum()
    radius = math.acos(max(1.0 - area / (2.0 * math.pi), -1.0))
    vector = (excess * near.solid[:, None]).T @ near.directions
    towards = _unit(LUMINANCE @ vector)
    strength = np.maximum(vector @ towards, 0.0)
    illuminance = float(LUMINANCE @ strength)
    if (
        radius > WIDEST_SUN
        or power.sum() < SUN_CONTRAST * area * float(LUMINANCE @ rim)
        or illuminance < LEAST_SHARE * image.facing_irradiance(towards)
    ):
        return None
    rest = image.radiance.copy()
    rest[near.at] = np.where(inside[:, None], np.minimum(near.radiance, rim), near.radiance)
    light = Light(
        name="sun of the environment",
        kind="directional",
        color=(strength / illuminance).astype(np.float32),
        intensity=illuminance,
        position=np.zeros(3, np.float32),
        direction=(-towards).astype(np.float32),
        source_radius=radius,
    )
    return ImageSun(light, rest)


def _median(luminance: FloatArray) -> float:
    """Over the sphere, of rows and columns evenly chosen."""
    height, width = luminance.shape
    rows = np.arange(0, height, -(-height // MEDIAN_SAMPLES))
    some = luminance[rows, :: -(-width // MEDIAN_SAMPLES)]
    weights = np.repeat(np.sin((rows + 0.5) * math.pi / height), some.shape[1])
    order = np.argsort(some, axis=None)
    below = np.cumsum(weights[order])
    return float(some.ravel()[order[np.searchsorted(below, 0.5 * below[-1])]])


def _unit(vector: F64) -> F64:
    unit: F64 = vector / np.linalg.norm(vector)
    return unit
