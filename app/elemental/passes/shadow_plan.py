"""Which shadow views a frame needs, and the lights that point at them. No GL here."""

from __future__ import annotations

import math
from collections.abc import Hashable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from elemental.passes import shadow_fit
from elemental.passes.camera_view import clip_range
from elemental.passes.light_pack import light_bounds, pack_lights, reach
from elemental.passes.light_shapes import Shape, shapes_of
from elemental.passes.scene_pack import Array
from elemental.passes.shadow_budget import FACES, ShadowBudget, Shares
from elemental.passes.shadow_fit import Bounds, FittedView, ViewFrustum
from elemental.passes.shadow_tiles import TilePool
from elemental.passes.shadow_views import (
    EmitterViews,
    FixedViews,
    PackedViews,
    PlacedView,
    pack_placed,
    views_of_emitters,
)
from elemental.scene.area_lights import AreaLight
from elemental.scene.lights import same_objects
from elemental.scene.model import Camera, Light

CULLED_FROM = 5
"""So many point and spot lights are worth a pass that finds out where each one reaches."""


@dataclass(frozen=True)
class ShadowSettings:
    """resolution: texels a side of each map; cascades: most of them for a directional light;
    reach: how far they go from the camera in m, 0 = `open_reach`; budget: maps that all
    lights share; penumbras: a light's size softens its shadows. culling: many lights are culled,
    those without a range at `cutoff` lux."""

    resolution: int = 1024
    cascades: int = 3
    reach: float = 0.0
    budget: int = 32
    penumbras: bool = True
    culling: bool = True
    cutoff: float = 1e-3


@dataclass(frozen=True)
class ShadowPlan:
    """lights (L,) of the struct Light, never empty; views: those of emitters first, the cascades
    last; `layers` that no camera exceeds; unshadowed: lights that the budget leaves without a map.
    bounds (L, 4) of `light_bounds`; culled: whether they are worth it. shapes: of `shapes_of`.
    key: differs when a light or a fixed view does. from_emitters: the first so many views are of
    area lights."""

    lights: Array
    bounds: Array
    culled: bool
    views: PackedViews
    layers: int
    unshadowed: int
    shapes: list[Shape]
    key: Hashable
    from_emitters: int = 0


@dataclass(frozen=True)
class PlacedLights:
    """structs (L,) of the struct Light; bounds and key: of the ShadowPlan. They hold while each
    sun, by its number, has as many `cascades`."""

    cascades: dict[int, int]
    structs: Array
    bounds: Array
    key: Hashable


@dataclass
class ShadowPlanner:
    """Plans frame after frame: keeps what does not change, and sizes and tiles where it can.

    Lights are compared as objects: one that changes is replaced by another.
    """

    settings: ShadowSettings
    _budget: ShadowBudget = field(init=False)
    _pool: TilePool = field(init=False)
    _lights: list[Light] = field(default_factory=list)
    _emitters: list[AreaLight] = field(default_factory=list)
    _reaches: list[float] = field(default_factory=list)
    _shapes: list[Shape] = field(default_factory=list)
    _spheres: Array = field(default_factory=lambda: light_bounds([], []))
    _fitted: dict[int, tuple[Hashable, list[FittedView]]] = field(default_factory=dict)
    _of_emitters: EmitterViews | None = None
    _fixed: FixedViews | None = None
    _packed: PlacedLights | None = None

    def __post_init__(self) -> None:
        s = self.settings
        self._budget = ShadowBudget(s.budget, s.resolution, s.cascades)
        self._pool = TilePool(0, s.resolution)

    def set_cutoff(self, cutoff: float) -> None:
        """Have lights without a range end at another irradiance, lux; their maps stay."""
        if cutoff != self.settings.cutoff:
            self.settings = replace(self.settings, cutoff=cutoff)
            self._lights = []

    def plan(
        self,
        lights: Sequence[Light],
        bounds: Bounds,
        camera: Camera,
        size: tuple[int, int],
        emitters: Sequence[AreaLight] = (),
    ) -> ShadowPlan:
        """The views of the lights that get shadow maps, and of the area lights ``emitters``.

        size: (width, height) px of the picture.
        """
        self._take_over(lights, emitters)
        frustum = _frustum(camera, size, bounds)
        shares = self._budget.share(lights, self._spheres, frustum)
        fixed = self._fixed_views(lights, shares, bounds)
        cascades = self._cascades(lights, fixed, bounds, frustum)
        moved = [view for views in cascades.values() for view in views]
        placed = self._pack(lights, fixed, {n: len(v) for n, v in cascades.items()})
        return ShadowPlan(
            lights=placed.structs,
            bounds=placed.bounds,
            culled=self._culled,
            views=fixed.views + pack_placed(moved, self.settings.resolution),
            layers=self._pool.first + self._pool.layers,
            unshadowed=shares.unshadowed,
            shapes=self._shapes,
            key=placed.key,
            from_emitters=fixed.from_emitters,
        )

    @property
    def _culled(self) -> bool:
        local = sum(light.kind != "directional" for light in self._lights)
        return self.settings.culling and local >= CULLED_FROM

    def _take_over(self, lights: Sequence[Light], emitters: Sequence[AreaLight]) -> None:
        """Look at lights that are not those of the last frame."""
        if not same_objects(emitters, self._emitters):
            self._emitters = list(emitters)
            self._fixed = None
        if same_objects(lights, self._lights):
            return
        self._lights = list(lights)
        self._reaches = [reach(light, self.settings.cutoff) for light in lights]
        self._spheres = light_bounds(lights, self._reaches)
        self._shapes = shapes_of(lights)
        self._fixed = self._packed = None

    def _fixed_views(self, lights: Sequence[Light], shares: Shares, bounds: Bounds) -> FixedViews:
        """Those that no camera moves, and a tile for each view."""
        key = (tuple(shares.sides), bounds[0].tobytes(), bounds[1].tobytes())
        if self._fixed is not None and self._fixed.key == key:
            return self._fixed
        resolution = self.settings.resolution
        last = self._of_emitters
        self._of_emitters = views_of_emitters(self._emitters, bounds, resolution, last)
        emitters, first = self._of_emitters.views, self._of_emitters.layers
        if shares.layers > self._pool.layers or first != self._pool.first:
            self._pool = TilePool(max(shares.layers, self._pool.layers), resolution, first)
        tiles = self._pool.assign(self._sides(lights, shares.sides))
        placed: list[PlacedView] = []
        first_view = []
        for number, (light, side) in enumerate(zip(lights, shares.sides, strict=True)):
            first_view.append(len(emitters.names) + len(placed) if side else -1)
            for k, view in enumerate(self._fit(number, light, bounds, side) if side else []):
                name = f"{number}.{light.kind}.{k}"
                placed.append(PlacedView(name, view, tiles[number, k]))
        self._packed = None
        self._fixed = FixedViews(
            key, len(emitters.names), first_view, emitters + pack_placed(placed, resolution)
        )
        return self._fixed

    def _sides(self, lights: Sequence[Light], sides: Sequence[int]) -> dict[Hashable, int]:
        """Of each tile that is needed, by the number of its light and of its view there."""
        more = {"directional": self.settings.cascades}
        return {
            (number, k): side
            for number, (light, side) in enumerate(zip(lights, sides, strict=True))
            if side
            for k in range(FACES[light.kind] + more.get(light.kind, 0))
        }

    def _fit(self, number: int, light: Light, bounds: Bounds, side: int) -> list[FittedView]:
        """Views of one light, fitted anew where the light or its share changed."""
        shape = (light.kind, light.range, light.outer_angle, side)
        place = (light.position.tobytes(), light.direction.tobytes())
        key = (shape, place, bounds[0].tobytes(), bounds[1].tobytes())
        if number not in self._fitted or self._fitted[number][0] != key:
            self._fitted[number] = key, _fit(light, bounds, side)
        return self._fitted[number][1]

    def _cascades(
        self, lights: Sequence[Light], fixed: FixedViews, bounds: Bounds, frustum: ViewFrustum
    ) -> dict[int, list[PlacedView]]:
        """By the number of the sun."""
        found = {}
        for number, first in enumerate(fixed.first_view):
            if lights[number].kind != "directional" or first < 0:
                continue
            coarsest = float(fixed.views.structs["texel"][first])
            views = _cascades(lights[number], bounds, frustum, self.settings, coarsest)
            found[number] = [
                PlacedView(f"{number}.cascade.{k}", view, self._pool.held[number, 1 + k])
                for k, view in enumerate(views)
            ]
        return found

    def _pack(
        self, lights: Sequence[Light], fixed: FixedViews, cascades: dict[int, int]
    ) -> PlacedLights:
        """cascades: how many by the number of the sun."""
        if self._packed is None or self._packed.cascades != cascades:
            spans = [(0, 0)] * len(lights)
            first = len(fixed.views.names)
            for number, count in cascades.items():
                spans[number] = first, count
                first += count
            ranges, spheres = self._reaches, self._spheres
            if not self._culled:
                ranges = [light.range for light in lights]
                spheres = light_bounds(lights, ranges)
            penumbras = self.settings.penumbras
            structs = pack_lights(lights, fixed.first_view, spans, ranges, penumbras)
            self._packed = PlacedLights(cascades, structs, spheres, _key(structs, fixed.views))
        return self._packed


def _key(lights: Array, fixed: PackedViews) -> Hashable:
    """Of the structs Light, but for what follows the camera, and of the fixed views."""
    fields = [name for name in lights.dtype.names or () if "cascade" not in name]
    blocks = b"".join(block.tobytes() for block in fixed.blocks)
    return lights[fields].tobytes(), blocks, fixed.structs["texel"].tobytes()


def _fit(light: Light, bounds: Bounds, side: int) -> list[FittedView]:
    if light.kind == "directional":
        return [shadow_fit.scene_view(light, bounds, side)]
    if light.kind == "spot":
        return [shadow_fit.spot_view(light, bounds, side)]
    return shadow_fit.point_views(light, bounds, side)


def _cascades(
    light: Light, bounds: Bounds, frustum: ViewFrustum, settings: ShadowSettings, coarsest: float
) -> list[FittedView]:
    """Those with smaller texels than `coarsest`, the whole scene's: others show no more."""
    views = shadow_fit.cascade_views(
        light,
        bounds,
        frustum,
        count=settings.cascades,
        reach=settings.reach or shadow_fit.open_reach(bounds, frustum.near),
        resolution=settings.resolution,
    )
    return [view for view in views if view.texel < coarsest]


def _frustum(camera: Camera, size: tuple[int, int], bounds: Bounds) -> ViewFrustum:
    tangent = math.tan(camera.fov_y / 2)
    matrix = camera.world_from_view
    near, far = clip_range(camera, bounds)
    return ViewFrustum(
        eye=matrix[:3, 3],
        forward=-matrix[:3, 2] / np.linalg.norm(matrix[:3, 2]),
        near=near,
        far=far,
        tangent=tangent,
        corner_tangent=math.hypot(tangent, tangent * size[0] / size[1]),
    )
