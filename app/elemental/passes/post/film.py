"""The film and the lens in front of it as the uniform block Film. docs/post.md has the formulas."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import Any

import numpy as np
import numpy.typing as npt

from elemental.core.cube_lut import CubeLut
from elemental.core.layout import Block, layouts, pack

GREY = 0.18
"""Radiance that the curve leaves where it is, if it lies on the toe or the line."""
SHARPEST_BEND = 1e-3
"""Least height of a bend: a curve that needs none gets a corner [inferred]."""
FRINGE = 0.01
"""How far each of red and blue is moved at the rim at fringe 1, share of the picture [inferred]."""
NEUTRAL_KELVIN = 6500.0

NO_LUT = ((1.0, 1.0, 1.0), (0.0, 0.0, 0.0), 0.0)
"""Scale, offset and share where there is none."""

CURVE = ("film.slope", "film.toe", "film.shoulder", "film.black_clip", "film.white_clip")

# Bradford's cone responses [Lam85] and the linear Rec. 709 primaries.
LMS_FROM_XYZ = np.array(
    [[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]]
)
XYZ_FROM_RGB = np.array(
    [[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750],
     [0.0193339, 0.1191920, 0.9503041]]
)  # fmt: skip


def film_block(s: Mapping[str, Any], luts: Sequence[tuple[CubeLut, float]], frame: int) -> Block:
    """The block Film of a frame. ``luts``: up to two tables, each with its share of the picture."""
    grain = s["grain.intensity"] + s["grain.jitter"] > 0.0
    first, second = (_lut(*luts[k]) if k < len(luts) else NO_LUT for k in range(2))
    return pack(
        layouts().block("Film"),
        graded_from_scene=_grading(s["film.white_point"], s["scene_color.tint"]),
        **_curve(*(s[key] for key in CURVE)),
        vignette=s["vignette.intensity"],
        grain=s["grain.intensity"],
        grain_jitter_px=s["grain.jitter"],
        fringe=FRINGE * s["scene_color.fringe"],
        lut_scale=first[0],
        lut_offset=first[1],
        lut_share=first[2],
        lut2_scale=second[0],
        lut2_offset=second[1],
        lut2_share=second[2],
        grain_seed=frame % (1 << 16) if grain else 0,
        dirt_tint=[s["bloom.dirt_intensity"] * channel for channel in s["bloom.dirt_tint"]],
    )


def _lut(table: CubeLut, share: float) -> tuple[Any, Any, float]:
    """(scale, offset, share): from display values to the texture's coordinates."""
    scale = (table.size - 1) / table.size / (table.high - table.low)
    return scale, 0.5 / table.size - table.low * scale, share


@lru_cache(maxsize=64)
def _curve(
    slope: float, toe: float, shoulder: float, black_clip: float, white_clip: float
) -> dict[str, float]:
    toe_height = 1.0 - toe
    toe_scale = max(toe_height + black_clip, SHARPEST_BEND)
    grey = GREY - toe_height
    if grey < 0.0:  # on the toe: how far into it
        grey = toe_scale * math.atanh(max(grey / toe_scale, -0.999))
    toe_start = math.log10(GREY) - grey / slope
    line_height = toe_height - slope * toe_start
    return {
        "slope": slope,
        "toe_start": toe_start,
        "toe_scale": toe_scale,
        "shoulder_start": (shoulder - line_height) / slope,
        "shoulder_scale": max(1.0 + white_clip - shoulder, SHARPEST_BEND),
        "line_height": line_height,
    }


@lru_cache(maxsize=64)
def _grading(kelvin: float, tint: tuple[float, float, float]) -> npt.NDArray[np.float64]:
    """(4, 4): light of that colour temperature to white, times the tint."""
    matrix = np.eye(4)
    if kelvin != NEUTRAL_KELVIN:
        to_lms = LMS_FROM_XYZ @ XYZ_FROM_RGB
        gain = (LMS_FROM_XYZ @ daylight_xyz(NEUTRAL_KELVIN)) / (LMS_FROM_XYZ @ daylight_xyz(kelvin))
        matrix[:3, :3] = np.linalg.inv(to_lms) @ np.diag(gain) @ to_lms
    matrix[:3, :3] = np.diag(tint) @ matrix[:3, :3]
    return matrix


def daylight_xyz(kelvin: float) -> npt.NDArray[np.float64]:
    """(3,) XYZ with Y = 1 of daylight, below 4000 K of a black body [CIE15], [Kim02]."""
    t = 1000.0 / kelvin
    if kelvin < 4000.0:
        x = 0.179910 + t * (0.8776956 + t * (-0.2343589 - 0.2661239 * t))
        low = (-1.1063814, -1.34811020, 2.18555832, -0.20219683)
        high = (-0.9549476, -1.37418593, 2.09137015, -0.16748867)
        cubic = low if kelvin < 2222.0 else high
        y = ((cubic[0] * x + cubic[1]) * x + cubic[2]) * x + cubic[3]
    else:
        below = (0.244063, 0.09911, 2.9678, -4.6070)
        above = (0.237040, 0.24748, 1.9018, -2.0064)
        cubic = below if kelvin <= 7000.0 else above
        x = cubic[0] + t * (cubic[1] + t * (cubic[2] + t * cubic[3]))
        y = -3.0 * x * x + 2.870 * x - 0.275
    return np.array([x / y, 1.0, (1.0 - x - y) / y])
