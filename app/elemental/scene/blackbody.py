"""The colour of a glowing black body, as a light's colour temperature names it."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import numpy.typing as npt

from elemental.scene.arrays import FloatArray

COOLEST, HOTTEST = 1000.0, 40000.0
"""K: what a lamp can be said to have. Below the lower nothing but red is left."""
WAVELENGTHS = np.arange(380.0, 781.0, 5.0) * 1e-9
"""m: the visible range in the steps that colorimetry uses [CIE 15:2004]."""
PLANCK, LIGHT_SPEED, BOLTZMANN = 6.62607015e-34, 2.99792458e8, 1.380649e-23
"""J s, m/s, J/K [SI Brochure, 9th edition]."""
REC709_FROM_XYZ = np.array(
    [
        [3.2404542, -1.5371385, -0.4985314],
        [-0.9692660, 1.8760108, 0.0415560],
        [0.0556434, -0.2040259, 1.0572252],
    ]
)
"""Linear Rec. 709 primaries with a white point of D65 [IEC 61966-2-1]."""
LUMINANCE = np.linalg.inv(REC709_FROM_XYZ)[1]
"""Y of linear red, green and blue."""


def blackbody_color(temperature: float) -> FloatArray:
    """(3,) float32 linear Rec. 709 colour of luminance 1 at a temperature in K.

    What lies outside the triangle of primaries is clipped: below 1900 K there is no blue.
    """
    return np.array(_color(temperature), np.float32)


@lru_cache(maxsize=1024)
def _color(temperature: float) -> tuple[float, ...]:
    color = np.maximum(REC709_FROM_XYZ @ blackbody_xyz(temperature), 0.0)
    return tuple((color / (LUMINANCE @ color)).tolist())


def blackbody_xyz(temperature: float) -> npt.NDArray[np.float64]:
    """(3,) CIE 1931 tristimulus values, Y = 1, by Planck's law."""
    exponent = PLANCK * LIGHT_SPEED / (WAVELENGTHS * BOLTZMANN * temperature)
    # Against the value in the middle, lest cool bodies underflow.
    relative = exponent[len(exponent) // 2] - exponent
    radiance = WAVELENGTHS**-5.0 * np.exp(relative) / -np.expm1(-exponent)
    xyz = color_matching(WAVELENGTHS * 1e9) @ radiance
    return np.asarray(xyz / xyz[1])


def color_matching(nm: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """(3, N) CIE 1931 2° colour matching functions, as sums of lopsided Gaussians.

    [Wyman13 "Simple Analytic Approximations to the CIE XYZ Color Matching Functions", table 1]
    """

    def lobe(height: float, center: float, left: float, right: float) -> npt.NDArray[np.float64]:
        away = (nm - center) * np.where(nm < center, left, right)
        return np.asarray(height * np.exp(-0.5 * away * away))

    return np.array(
        [
            lobe(0.362, 442.0, 0.0624, 0.0374)
            + lobe(1.056, 599.8, 0.0264, 0.0323)
            + lobe(-0.065, 501.1, 0.0490, 0.0382),
            lobe(0.821, 568.8, 0.0213, 0.0247) + lobe(0.286, 530.9, 0.0613, 0.0322),
            lobe(1.217, 437.0, 0.0845, 0.0278) + lobe(0.681, 459.0, 0.0385, 0.0725),
        ]
    )
