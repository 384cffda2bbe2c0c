"""Which shadow views a frame needs, and the lights that point at them. No GL here."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from elemental.core.layout import layouts, pack_array
from elemental.passes import shadow_fit
from elemental.passes.camera_view import far_plane
from elemental.passes.scene_pack import Array
from elemental.passes.shadow_fit import Bounds, FittedView, ViewFrustum
from elemental.scene.model import Camera, Light

CASCADE, SCENE, LOCAL = "cascades", "scene", "local"
MAPS = (CASCADE, SCENE, LOCAL)
"""Texture arrays, in the order of SHADOW_MAP_*."""
KINDS = ("directional", "point", "spot")
"""In the order of LIGHT_*."""
LARGEST_MAP = 4096
CONE_MARGIN = 1e-3
"""Least difference of a spot's cone cosines, as KHR_lights_punctual recommends."""


@dataclass(frozen=True)
class ShadowSettings:
    """resolution: texels a side of a cascade and of a local map; the scene map has twice as many.
    cascades: of a directional light; reach: how far they go in m, 0 = the scene's diagonal."""

    resolution: int = 1024
    cascades: int = 3
    reach: float = 0.0

    def texels(self, map_name: str) -> int:
        """Texels a side of the maps in one array."""
        return min(self.resolution * (2 if map_name == SCENE else 1), LARGEST_MAP)


@dataclass(frozen=True)
class ShadowPlan:
    """lights (L,) of the struct Light, never empty; views (V,) of the struct ShadowView."""

    lights: Array
    views: Array

    def layers(self, map_name: str) -> int:
        """Views that one texture array holds."""
        return int(np.count_nonzero(self.views["map"] == MAPS.index(map_name)))


def plan_shadows(
    lights: Sequence[Light],
    bounds: Bounds,
    camera: Camera,
    size: tuple[int, int],
    settings: ShadowSettings,
) -> ShadowPlan:
    """The views of every light that casts shadows. size: (width, height) px of the picture."""
    frustum = _frustum(camera, size, bounds)
    diagonal = float(np.linalg.norm(bounds[1] - bounds[0]))
    fitted: list[tuple[str, FittedView]] = []
    first_view, cascade_counts = [], []
    for light in lights:
        views = _views(light, bounds, frustum, settings, settings.reach or diagonal)
        first_view.append(len(fitted) if views else -1)
        cascade_counts.append(sum(name == CASCADE for name, _ in views))
        fitted += views
    return ShadowPlan(pack_lights(lights, first_view, cascade_counts), _pack_views(fitted))


def _views(
    light: Light, bounds: Bounds, frustum: ViewFrustum, settings: ShadowSettings, reach: float
) -> list[tuple[str, FittedView]]:
    if not light.casts_shadow:
        return []
    local = settings.texels(LOCAL)
    if light.kind == "spot":
        return [(LOCAL, shadow_fit.spot_view(light, bounds, local))]
    if light.kind == "point":
        return [(LOCAL, view) for view in shadow_fit.point_views(light, bounds, local)]
    whole = shadow_fit.scene_view(light, bounds, settings.texels(SCENE))
    cascades = shadow_fit.cascade_views(
        light,
        bounds,
        frustum,
        count=settings.cascades,
        reach=reach,
        resolution=settings.texels(CASCADE),
    )
    # A cascade no finer than the map of the whole scene would show the same.
    return [(SCENE, whole), *((CASCADE, view) for view in cascades if view.texel < whole.texel)]


def _frustum(camera: Camera, size: tuple[int, int], bounds: Bounds) -> ViewFrustum:
    tangent = math.tan(camera.fov_y / 2)
    matrix = camera.world_from_view
    return ViewFrustum(
        eye=matrix[:3, 3],
        forward=-matrix[:3, 2] / np.linalg.norm(matrix[:3, 2]),
        near=camera.near,
        far=far_plane(camera, bounds),
        corner_tangent=math.hypot(tangent, tangent * size[0] / size[1]),
    )


def _pack_views(fitted: Sequence[tuple[str, FittedView]]) -> Array:
    counts = dict.fromkeys(MAPS, 0)
    layers = []
    for name, _ in fitted:
        layers.append(counts[name])
        counts[name] += 1
    return pack_array(
        layouts().struct("ShadowView"),
        len(fitted),
        clip_from_world=np.array([view.clip_from_world for _, view in fitted]).reshape(-1, 4, 4),
        texel=[view.texel for _, view in fitted],
        depth_bias=[shadow_fit.DEPTH_BIAS] * len(fitted),
        map=[MAPS.index(name) for name, _ in fitted],
        layer=layers,
    )


def pack_lights(
    lights: Sequence[Light], first_view: Sequence[int], cascade_counts: Sequence[int]
) -> Array:
    """(lights,) of the GLSL struct Light; one of intensity 0 where there is none."""
    if not lights:
        zero, down = np.zeros(3, np.float32), np.array([0.0, -1.0, 0.0], np.float32)
        dark = Light("none", "directional", zero, 0.0, zero, down, casts_shadow=False)
        lights, first_view, cascade_counts = [dark], [-1], [0]
    cosines = np.cos([(light.inner_angle, light.outer_angle) for light in lights])
    spot_scale = 1.0 / np.maximum(cosines[:, 0] - cosines[:, 1], CONE_MARGIN)
    return pack_array(
        layouts().struct("Light"),
        len(lights),
        position_ws=[light.position for light in lights],
        range=[0.0 if math.isinf(light.range) else light.range for light in lights],
        direction_ws=[light.direction for light in lights],
        source_radius=[light.source_radius for light in lights],
        intensity=[light.color * light.intensity for light in lights],
        kind=[KINDS.index(light.kind) for light in lights],
        spot_scale=spot_scale,
        spot_offset=-cosines[:, 1] * spot_scale,
        shadow_view=first_view,
        cascade_count=cascade_counts,
    )
