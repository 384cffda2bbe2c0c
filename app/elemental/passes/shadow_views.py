"""Shadow views in their tiles, as shaders and the passes that draw them take them. No GL here."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from elemental.core.layout import Block, layouts, pack, pack_array
from elemental.passes.emitter_views import emitter_views, side_of_maps
from elemental.passes.scene_pack import Array
from elemental.passes.shadow_fit import Bounds, FittedView
from elemental.passes.shadow_tiles import Tile
from elemental.scene.area_lights import AreaLight


@dataclass(frozen=True)
class PlacedView:
    """A view by its name, in its tile."""

    name: str
    fitted: FittedView
    tile: Tile


@dataclass(frozen=True)
class PackedViews:
    """structs (V,) of ShadowView; blocks ShadowPass, names and tiles by view; shown: what its map
    shows of a scene, by view; two are the same where their bytes are."""

    structs: Array
    blocks: list[Block]
    names: list[str]
    tiles: list[Tile]
    shown: list[bytes]

    def __add__(self, more: PackedViews) -> PackedViews:
        return PackedViews(
            np.concatenate([self.structs, more.structs]),
            self.blocks + more.blocks,
            self.names + more.names,
            self.tiles + more.tiles,
            self.shown + more.shown,
        )


@dataclass(frozen=True)
class FixedViews:
    """Views that no camera moves, `from_emitters` of area lights first. first_view by light, -1
    without one. They hold while `key` does."""

    key: Hashable
    from_emitters: int
    first_view: list[int]
    views: PackedViews


class EmitterViews(NamedTuple):
    """Views of area lights in the order of glsl/lib/area_map.glsl, and the layers from the first on
    that hold their tiles and nothing else: so no other light moves theirs. They hold while `key`
    does, whatever the lights' radiance."""

    key: Hashable
    layers: int
    views: PackedViews


def views_of_emitters(
    emitters: Sequence[AreaLight], bounds: Bounds, resolution: int, last: EmitterViews | None
) -> EmitterViews:
    """resolution: texels a side of the other lights' maps. ``last``: returned where it holds."""
    key = (tuple(map(_shape, emitters)), bounds[0].tobytes(), bounds[1].tobytes())
    if last is not None and last.key == key:
        return last
    side = side_of_maps(resolution)
    row = resolution // side
    placed: list[PlacedView] = []
    for number, emitter in enumerate(emitters):
        for k, view in enumerate(emitter_views(emitter, bounds, side)):
            layer, within = divmod(len(placed), row * row)
            tile = Tile(layer, within % row * side, within // row * side, side)
            placed.append(PlacedView(f"emitter.{number}.{k}", view, tile))
    return EmitterViews(key, -(-len(placed) // row**2), pack_placed(placed, resolution))


def pack_placed(placed: Sequence[PlacedView], resolution: int) -> PackedViews:
    """resolution: texels a side of a layer."""
    structs = _pack(placed, resolution)
    blocks = [_shadow_pass(view) for view in placed]
    shown = [
        struct.tobytes() + block.tobytes() for struct, block in zip(structs, blocks, strict=True)
    ]
    return PackedViews(
        structs, blocks, [view.name for view in placed], [view.tile for view in placed], shown
    )


def _shape(light: AreaLight) -> Hashable:
    """What an area light's views depend on."""
    edges = light.edge_u.tobytes(), light.edge_v.tobytes()
    return light.corner.tobytes(), *edges, light.both_sides, light.is_ball


def _shadow_pass(view: PlacedView) -> Block:
    """The block ShadowPass of a view's draws."""
    cut = view.fitted.cut
    return pack(
        layouts().block("ShadowPass"),
        clip_from_world=view.fitted.clip_from_world,
        cut_plane=cut.plane,
        cut_ball=cut.ball,
        cut_heights_m=cut.heights,
    )


def _pack(placed: Sequence[PlacedView], resolution: int) -> Array:
    """(V,) of the GLSL struct ShadowView."""
    matrices = [view.fitted.clip_from_world for view in placed]
    tiles = np.array([view.tile for view in placed], np.float32).reshape(-1, 4)
    return pack_array(
        layouts().struct("ShadowView"),
        len(placed),
        clip_from_world=np.array(matrices).reshape(-1, 4, 4),
        texel=[view.fitted.texel for view in placed],
        depth_range_m=np.array([view.fitted.depth_range for view in placed]).reshape(-1, 2),
        depth_bias=[view.fitted.depth_bias for view in placed],
        layer=tiles[:, 0],
        scale=tiles[:, 3] / resolution,
        offset_uv=tiles[:, 1:3] / resolution,
    )
