"""Shadow views in their tiles, as shaders and the passes that draw them take them. No GL here."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from elemental.core.layout import Block, layouts, pack, pack_array
from elemental.passes.emitter_views import emitter_views, side_of_maps
from elemental.passes.scene_pack import Array
from elemental.passes.shadow_fit import DEPTH_BIAS, Bounds, FittedView
from elemental.passes.shadow_tiles import Tile
from elemental.scene.area_lights import AreaLight


@dataclass(frozen=True)
class PlacedView:
    """A view by its name, in its tile."""

    name: str
    fitted: FittedView
    tile: Tile


@dataclass(frozen=True)
class FixedViews:
    """Views that no camera moves, `from_emitters` of area lights first. first_view by light, -1
    without one; packed (V,) of the struct ShadowView; blocks ShadowPass, names and tiles by view.
    They hold while `key` does."""

    key: Hashable
    from_emitters: int
    first_view: list[int]
    packed: Array
    blocks: list[Block]
    names: list[str]
    tiles: list[Tile]


class EmitterViews(NamedTuple):
    """Views of area lights, all of one `side` in texels, `in_layer` of them side by side in one.
    names and fitted by the tile's key."""

    side: int
    in_layer: int
    names: dict[Hashable, str]
    fitted: dict[Hashable, FittedView]

    @property
    def layers(self) -> int:
        """That hold their tiles and nothing else."""
        return -(-len(self.names) // self.in_layer)

    @property
    def sides(self) -> dict[Hashable, int]:
        """Texels of each tile's side by its key."""
        return dict.fromkeys(self.names, self.side)

    def placed(self, tiles: dict[Hashable, Tile]) -> list[PlacedView]:
        """In the order of glsl/lib/area_map.glsl."""
        return [PlacedView(name, self.fitted[key], tiles[key]) for key, name in self.names.items()]


def views_of_emitters(
    emitters: Sequence[AreaLight], bounds: Bounds, resolution: int
) -> EmitterViews:
    """resolution: texels a side of the other lights' maps."""
    side = side_of_maps(resolution)
    names: dict[Hashable, str] = {}
    fitted: dict[Hashable, FittedView] = {}
    for number, emitter in enumerate(emitters):
        for k, view in enumerate(emitter_views(emitter, bounds, side)):
            key = ("emitter", number, k)
            names[key], fitted[key] = f"emitter.{number}.{k}", view
    return EmitterViews(side, (resolution // side) ** 2, names, fitted)


def shadow_pass(view: PlacedView) -> Block:
    """The block ShadowPass of a view's draws."""
    cut = view.fitted.cut
    return pack(
        layouts().block("ShadowPass"),
        clip_from_world=view.fitted.clip_from_world,
        cut_plane=cut.plane,
        cut_ball=cut.ball,
        cut_heights_m=cut.heights,
    )


def pack_views(placed: Sequence[PlacedView], resolution: int) -> Array:
    """(V,) of the GLSL struct ShadowView. resolution: texels a side of a layer."""
    matrices = [view.fitted.clip_from_world for view in placed]
    tiles = np.array([view.tile for view in placed], np.float32).reshape(-1, 4)
    return pack_array(
        layouts().struct("ShadowView"),
        len(placed),
        clip_from_world=np.array(matrices).reshape(-1, 4, 4),
        texel=[view.fitted.texel for view in placed],
        depth_range_m=np.array([view.fitted.depth_range for view in placed]).reshape(-1, 2),
        depth_bias=[DEPTH_BIAS] * len(placed),
        layer=tiles[:, 0],
        scale=tiles[:, 3] / resolution,
        offset_uv=tiles[:, 1:3] / resolution,
    )
