"""Luminous flux and intensity of lights: lm and cd."""

from __future__ import annotations

import math

import numpy as np

from elemental.scene.ies import LightProfile
from elemental.scene.lights import Light

STEPS = (720, 360)
"""Of the integral over a profile, from pole to pole and round the axis."""


def solid_angle(light: Light) -> float:
    """Lumens of a point or spot light for each candela of its intensity, sr: the integral over all
    directions of what its cone and its profile let through."""
    if light.profile is not None:
        return _profile_solid_angle(light.profile, light)
    if light.kind == "point":
        return 4.0 * math.pi
    inner, outer = math.cos(light.inner_angle), math.cos(light.outer_angle)
    # Full inside the inner cone; from there to the outer the square of a ramp in the cosine.
    return 2.0 * math.pi * ((1.0 - inner) + (inner - outer) / 3.0)


def _profile_solid_angle(profile: LightProfile, light: Light) -> float:
    vertical = (np.arange(STEPS[0]) + 0.5) / STEPS[0] * math.pi
    horizontal = (np.arange(STEPS[1]) + 0.5) / STEPS[1] * 2.0 * math.pi
    through = profile.intensity(*np.meshgrid(vertical, horizontal, indexing="ij")) / profile.peak
    if light.kind == "spot":
        inner, outer = math.cos(light.inner_angle), math.cos(light.outer_angle)
        ramp = (np.cos(vertical) - outer) / max(inner - outer, 1e-9)
        through = through * np.clip(ramp, 0.0, 1.0)[:, None] ** 2
    ring = np.sin(vertical)[:, None] * (math.pi / STEPS[0]) * (2.0 * math.pi / STEPS[1])
    return float((through * ring).sum())
