"""Which shadow views a frame needs, and the lights that point at them. No GL here."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from elemental.core.layout import layouts, pack_array
from elemental.passes import shadow_fit
from elemental.passes.camera_view import far_plane
from elemental.passes.light_pack import light_bounds, pack_lights, reach
from elemental.passes.scene_pack import Array
from elemental.passes.shadow_fit import Bounds, FittedView, ViewFrustum
from elemental.scene.model import Camera, Light

CULLED_FROM = 5
"""So many point and spot lights are worth a pass that finds out where each one reaches."""


@dataclass(frozen=True)
class ShadowSettings:
    """resolution: texels a side of each map; cascades: most of them for a directional light;
    reach: how far they go from the camera in m, 0 = the scene's diagonal. culling: many lights are
    culled, those without a range at `cutoff` lux."""

    resolution: int = 1024
    cascades: int = 3
    reach: float = 0.0
    culling: bool = True
    cutoff: float = 1e-3


@dataclass(frozen=True)
class ShadowPlan:
    """lights (L,) of the struct Light, never empty; views (V,) of the struct ShadowView, the
    cascades behind the `fixed` ones, which do not depend on the camera; names by view; `layers`
    that no camera exceeds. bounds (L, 4) of `light_bounds`; culled: whether they are worth it."""

    lights: Array
    bounds: Array
    culled: bool
    views: Array
    names: list[str]
    fixed: int
    layers: int


def plan_shadows(
    lights: Sequence[Light],
    bounds: Bounds,
    camera: Camera,
    size: tuple[int, int],
    settings: ShadowSettings,
) -> ShadowPlan:
    """The views of every light that casts shadows. size: (width, height) px of the picture."""
    frustum = _frustum(camera, size, bounds)
    views: dict[str, FittedView] = {}
    first_view = []
    for number, light in enumerate(lights):
        fitted = _fixed_views(light, bounds, settings.resolution) if light.casts_shadow else []
        first_view.append(len(views) if fitted else -1)
        views |= {f"{number}.{light.kind}.{k}": view for k, view in enumerate(fitted)}
    fixed = len(views)
    cascades = []
    for number, light in enumerate(lights):
        first = len(views)
        if light.kind == "directional" and light.casts_shadow:
            whole = views[f"{number}.directional.0"]
            fitted = _cascades(light, bounds, frustum, settings, whole.texel)
            views |= {f"{number}.cascade.{k}": view for k, view in enumerate(fitted)}
        cascades.append((first, len(views) - first))
    suns = sum(light.kind == "directional" and light.casts_shadow for light in lights)
    culled = settings.culling and len(lights) - _suns(lights) >= CULLED_FROM
    ranges = [reach(light, settings.cutoff) if culled else light.range for light in lights]
    return ShadowPlan(
        lights=pack_lights(lights, first_view, cascades, ranges),
        bounds=light_bounds(lights, ranges),
        culled=culled,
        views=_pack_views(list(views.values())),
        names=list(views),
        fixed=fixed,
        layers=fixed + suns * settings.cascades,
    )


def _suns(lights: Sequence[Light]) -> int:
    return sum(light.kind == "directional" for light in lights)


def _fixed_views(light: Light, bounds: Bounds, resolution: int) -> list[FittedView]:
    if light.kind == "directional":
        return [shadow_fit.scene_view(light, bounds, resolution)]
    if light.kind == "spot":
        return [shadow_fit.spot_view(light, bounds, resolution)]
    return shadow_fit.point_views(light, bounds, resolution)


def _cascades(
    light: Light, bounds: Bounds, frustum: ViewFrustum, settings: ShadowSettings, coarsest: float
) -> list[FittedView]:
    """Those with smaller texels than `coarsest`, the whole scene's: others show no more."""
    diagonal = float(np.linalg.norm(bounds[1] - bounds[0]))
    views = shadow_fit.cascade_views(
        light,
        bounds,
        frustum,
        count=settings.cascades,
        reach=settings.reach or diagonal,
        resolution=settings.resolution,
    )
    return [view for view in views if view.texel < coarsest]


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


def _pack_views(fitted: Sequence[FittedView]) -> Array:
    return pack_array(
        layouts().struct("ShadowView"),
        len(fitted),
        clip_from_world=np.array([view.clip_from_world for view in fitted]).reshape(-1, 4, 4),
        texel=[view.texel for view in fitted],
        depth_bias=[shadow_fit.DEPTH_BIAS] * len(fitted),
    )
