"""Shading formulas of glsl/lib in float64, for tests that need them whole."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[Any]


def environment_brdf(f0: float | Array, roughness: float | Array, n_o_v: float | Array) -> Array:
    """glsl/lib/brdf.glsl's fit of what a GGX surface mirrors of a uniform environment."""
    r, s = np.asarray(roughness, float), np.sqrt(np.asarray(n_o_v, float))
    grazing = np.exp(
        0.051 + s * (-0.548 + s * (-1.160 - 8.007 * s))
        + r * (-1.677 + s * (3.414 + 7.621 * s) + r * (-6.422 - 8.690 * s + 5.962 * r))
    )  # fmt: skip
    loss = np.exp(
        -2.922 + s * (-0.473 + s * (-11.660 + 3.549 * s))
        + r * (1.073 + s * (25.026 + 2.432 * s) + r * (-9.110 - 15.918 * s + 7.639 * r))
    )  # fmt: skip
    return np.asarray(f0 * np.maximum(1.0 - loss - grazing, 0.0) + grazing)


MIRRORED_BY_ROUGH_DIELECTRIC = 0.0225
"""Share of a hemisphere's light that a dielectric of roughness 1 mirrors (lib/brdf.glsl,
mirrored_share)."""
