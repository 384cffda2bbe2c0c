"""Lights as the GPU reads them, and how far each one reaches. No GL here."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from elemental.core.layout import layouts, pack_array
from elemental.passes.light_shapes import shapes_of
from elemental.passes.scene_pack import Array
from elemental.scene.model import Light

KINDS = ("directional", "point", "spot")
"""In the order of LIGHT_*."""
CONE_MARGIN = 1e-3
"""Least difference of a spot's cone cosines, as KHR_lights_punctual recommends."""
LEAST_MASK_ANGLE, WIDEST_MASK_ANGLE = math.radians(0.1), math.radians(85.0)
"""Half angles of a spot between which its mask fills the cone: a plane can't be wider."""
NO_AXIS = np.zeros(3, np.float32)
EVERYWHERE = -1.0
"""Radius in LightBounds of a light that reaches everywhere."""


def reach(light: Light, cutoff: float) -> float:
    """How far a point or spot light reaches, m: its range or, without one, where its irradiance has
    fallen to `cutoff` lux.

    With that as its range, the window of KHR_lights_punctual takes at most `cutoff` away at any
    distance d: I / d² (d / r)⁴ = cutoff (d / r)² for I = cutoff r².
    """
    if math.isfinite(light.range):
        return light.range
    return math.sqrt(float(light.strength.max()) / cutoff)


def mask_scale(light: Light) -> float:
    """Of a spot 1 / tan of the outer angle, of a sun its masks a metre."""
    if light.kind == "directional":
        return 1.0 / light.mask_size
    return 1.0 / math.tan(min(max(light.outer_angle, LEAST_MASK_ANGLE), WIDEST_MASK_ANGLE))


def light_bounds(lights: Sequence[Light], ranges: Sequence[float]) -> Array:
    """(L, 4) float32 centre and radius, m, of a sphere around what each light reaches.

    ranges: of `reach`, infinite where it reaches everywhere. A spot light's sphere goes through its
    tip and the rim of its cone, or around the rim alone where that is the larger.
    """
    spheres = np.zeros((max(len(lights), 1), 4), np.float32)
    spheres[:, 3] = EVERYWHERE
    for number, (light, far) in enumerate(zip(lights, ranges, strict=True)):
        if light.kind == "directional" or math.isinf(far):
            continue
        along, radius = 0.0, far
        if light.kind == "spot":
            cosine, sine = math.cos(light.outer_angle), math.sin(light.outer_angle)
            wide = light.outer_angle > math.pi / 4
            along = far * cosine if wide else far / (2.0 * cosine)
            radius = far * sine if wide else along
        spheres[number, :3] = light.position + np.float32(along) * light.direction
        spheres[number, 3] = radius
    return spheres


def pack_lights(
    lights: Sequence[Light],
    first_view: Sequence[int],
    cascades: Sequence[tuple[int, int]],
    ranges: Sequence[float] | None = None,
    penumbras: bool = True,
) -> Array:
    """(lights,) of the GLSL struct Light; one of intensity 0 where there is none.

    first_view: -1 without a shadow; cascades: (first view, count); ranges, m: instead of the
    lights' own; penumbras: whether a light's size softens its shadows. Profiles are numbered as
    in `shapes_of`.
    """
    if not lights:
        zero, down = np.zeros(3, np.float32), np.array([0.0, -1.0, 0.0], np.float32)
        dark = Light("none", "directional", zero, 0.0, zero, down, casts_shadow=False)
        lights, first_view, cascades, ranges = [dark], [-1], [(0, 0)], None
    if ranges is None:
        ranges = [light.range for light in lights]
    layers = {id(shape): layer for layer, shape in enumerate(shapes_of(lights))}
    cosines = np.cos([(light.inner_angle, light.outer_angle) for light in lights])
    spot_scale = 1.0 / np.maximum(cosines[:, 0] - cosines[:, 1], CONE_MARGIN)
    return pack_array(
        layouts().struct("Light"),
        len(lights),
        position_ws=[light.position for light in lights],
        range=[0.0 if math.isinf(radius) else radius for radius in ranges],
        direction_ws=[light.direction for light in lights],
        source_radius=[light.source_radius for light in lights],
        penumbra_radius=[light.source_radius * penumbras for light in lights],
        intensity=[light.strength for light in lights],
        kind=[KINDS.index(light.kind) for light in lights],
        spot_scale=spot_scale,
        spot_offset=-cosines[:, 1] * spot_scale,
        shadow_view=first_view,
        first_cascade=[first for first, _ in cascades],
        cascade_count=[count for _, count in cascades],
        profile=[layers.get(id(light.profile), -1) for light in lights],
        mask=[layers.get(id(light.mask), -1) for light in lights],
        profile_axis_ws=[
            light.profile_axis if light.profile or light.mask else NO_AXIS for light in lights
        ],
        mask_scale=[mask_scale(light) for light in lights],
        mask_offset=[light.mask_offset for light in lights],
    )
