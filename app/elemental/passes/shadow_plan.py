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

KINDS = ("directional", "point", "spot")
"""In the order of LIGHT_*."""
CONE_MARGIN = 1e-3
"""Least difference of a spot's cone cosines, as KHR_lights_punctual recommends."""


@dataclass(frozen=True)
class ShadowSettings:
    """resolution: texels a side of each map; cascades: most of them for a directional light;
    reach: how far they go from the camera in m, 0 = the scene's diagonal."""

    resolution: int = 1024
    cascades: int = 3
    reach: float = 0.0


@dataclass(frozen=True)
class ShadowPlan:
    """lights (L,) of the struct Light, never empty; views (V,) of the struct ShadowView, the
    cascades behind the `fixed` ones, which do not depend on the camera; names by view; `layers`
    that no camera exceeds."""

    lights: Array
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
    return ShadowPlan(
        lights=pack_lights(lights, first_view, cascades),
        views=_pack_views(list(views.values())),
        names=list(views),
        fixed=fixed,
        layers=fixed + suns * settings.cascades,
    )


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


def pack_lights(
    lights: Sequence[Light], first_view: Sequence[int], cascades: Sequence[tuple[int, int]]
) -> Array:
    """(lights,) of the GLSL struct Light; one of intensity 0 where there is none.

    first_view: -1 without a shadow; cascades: (first view, count).
    """
    if not lights:
        zero, down = np.zeros(3, np.float32), np.array([0.0, -1.0, 0.0], np.float32)
        dark = Light("none", "directional", zero, 0.0, zero, down, casts_shadow=False)
        lights, first_view, cascades = [dark], [-1], [(0, 0)]
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
        first_cascade=[first for first, _ in cascades],
        cascade_count=[count for _, count in cascades],
    )
