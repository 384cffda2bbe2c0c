"""The octree's pools as NumPy arrays, found by walking the nodes as the layout says."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from elemental.core.layout import layouts
from elemental.passes.voxel.grid import octal_sum
from elemental.passes.voxel.octree import Octree
from glsl.harness import run_glsl
from gpu.voxel.stage import Stage

Array = npt.NDArray[Any]
ABSENT = -1


def constant(name: str) -> int:
    return int(layouts().constant(name))


def cell_grid(side: int) -> Array:
    """(side^3, 3) coordinates of a cube of cells, x slowest."""
    return np.indices((side,) * 3).reshape(3, -1).T


def morton(cells: Array) -> Array:
    """(N,) Morton codes of (N, 3), x in the lowest bit."""
    cells = np.asarray(cells, np.int64)
    code = np.zeros(cells.shape[:-1], np.int64)
    for bit in range(10):
        for axis in range(3):
            code |= (cells[..., axis] >> bit & 1) << (3 * bit + axis)
    return code


@dataclass
class Pools:
    """What the nodes and bricks say.

    ``node[level]``, ``brick[level]`` (2^level,)*3 int64 by [x, y, z]: index of the node that stands
    for exactly this cell and of its brick, or ABSENT. Of brick b: ``cell[b]`` (3,), ``level[b]``,
    ``is_leaf[b]``, ``scale[b]``, its HDR multiplier, and ``points[b]``, which of its own eight
    points hold anything, a bit each.
    """

    node: list[Array]
    brick: list[Array]
    child_word: Array
    cell: Array
    level: Array
    is_leaf: Array
    node_of_brick: Array
    points: Array
    scale: Array

    @classmethod
    def read(cls, stage: Stage) -> Pools:
        return cls.of(stage.octree, stage.counts.tiles, stage.counts.bricks)

    @classmethod
    def of(cls, octree: Octree, tiles: int, bricks: int) -> Pools:
        """The first so many tiles and bricks of an octree."""
        grid = octree.grid
        nodes = octree.nodes.read(layouts().struct("Node"), grid.dense_nodes + 8 * tiles)
        child = nodes["child"].astype(np.int64)
        brick_word = nodes["brick"].astype(np.int64)
        brick_of = (brick_word & constant("NODE_BRICK_MASK")) - 1
        node: list[Array] = []
        brick: list[Array] = []
        for level in range(grid.leaf_level + 1):
            side = 1 << level
            cells = cell_grid(side)
            index = np.full(len(cells), ABSENT)
            if level <= grid.top_level:
                index = octal_sum(level) + morton(cells)
            else:
                parent = node[-1][tuple((cells >> 1).T)]
                has_tile = (parent != ABSENT) & (brick_of[parent] != ABSENT)
                has_tile &= (child[parent] != 0) & (child[parent] != constant("NODE_HOLLOW"))
                tile = child[parent] - 1
                octant = (cells & 1) @ np.array([1, 2, 4])
                index = np.where(has_tile, grid.dense_nodes + 8 * tile + octant, ABSENT)
            node.append(index.reshape((side,) * 3))
            brick.append(np.where(index != ABSENT, brick_of[index], ABSENT).reshape((side,) * 3))
        placed = octree.bricks.read(layouts().struct("Brick"), bricks)
        cell = placed["cell"].astype(np.int64)
        owner = placed["node"].astype(np.int64) & constant("BRICK_NODE_MASK")
        word = brick_word[np.minimum(owner, len(nodes) - 1)]
        exponent = (word >> constant("NODE_SCALE_SHIFT")) - constant("NODE_SCALE_BIAS")
        return cls(
            node=node,
            brick=brick,
            child_word=child,
            cell=np.stack([cell & 511, cell >> 9 & 511, cell >> 18 & 511], axis=-1),
            level=cell >> 27 & 15,
            is_leaf=(cell & constant("BRICK_LEAF")) != 0,
            node_of_brick=owner,
            points=placed["node"].astype(np.int64) >> constant("BRICK_POINTS_SHIFT"),
            scale=np.exp2(exponent.astype(np.float64)),
        )

    def brick_at(self, cells: Array, level: int) -> Array:
        """(N,) bricks of cells (N, 3) of one level, ABSENT outside the cube too."""
        side = 1 << level
        inside = np.all((cells >= 0) & (cells < side), axis=-1, keepdims=True)
        x, y, z = np.where(inside, cells, 0).T
        return np.where(inside[:, 0], self.brick[level][x, y, z], ABSENT)


def read_sided(stage: Stage) -> Array:
    """(I, 3, 3, 3, 28) uint8 codes of the bricks above the finest level by [z, y, x, channel].

    Channels, for each of six sides: colour times cover, cover; then opacity along x, y and z, 0.
    """
    body = """
        int b = index / 189, stack = (index / 27) % 7, i = index % 27;
        ivec3 texel = ivec3(i % 3, (i / 3) % 3, i / 9 + 3 * stack);
        result = texelFetch(u_brick_atlas, brick_texel(uint(b)) + texel, 0) * 255.0;
    """
    bricks = stage.counts.interior
    codes = _run(stage, body, bricks * 189).reshape(bricks, 7, 3, 3, 3, 4)
    return np.moveaxis(codes, 1, 4).reshape(bricks, 3, 3, 3, 28).astype(np.uint8)


def read_leaves(stage: Stage) -> Array:
    """(L, 3, 3, 3, 7) int16 codes of the finest level's bricks by [z, y, x, channel].

    Channels: premultiplied colour, opacity (0..255); normal times opacity (-127..127).
    """
    body = """
        int i = index % 27;
        ivec3 at = leaf_texel(uint(index / 27)) + ivec3(i % 3, (i / 3) % 3, i / 9);
        result = {};
    """
    bricks = stage.counts.bricks - stage.counts.interior
    if bricks == 0:
        return np.zeros((0, 3, 3, 3, 7), np.int16)
    parts = [
        _run(stage, body.format(value), bricks * 27)
        for value in (
            "texelFetch(u_leaf_colors, at, 0) * 255.0",
            "texelFetch(u_leaf_normals, at, 0) * 127.0",
        )
    ]
    codes = np.concatenate([parts[0], parts[1][:, :3]], axis=1)
    return codes.reshape(bricks, 3, 3, 3, 7).astype(np.int16)


def _run(stage: Stage, body: str, count: int) -> Array:
    values = run_glsl(
        stage.device,
        ["lib/svo_lookup.glsl"],
        body,
        output="vec4",
        count=count,
        reads=stage.octree.tracing_reads(),
        params=stage.octree.params,
    )
    return np.asarray(np.rint(values))


SIDE_BITS = np.arange(6)
"""Of a leaf's sides +x -x +y -y +z -z (lib/packing.glsl)."""


def sides_met(stage: Stage) -> Array:
    """(S, 8) uint32 bits of the sides that lattice lines meet in each leaf, by slot and voxel."""
    words = stage.octree.attributes.read(layouts().struct("VoxelAttributes"))
    words = words[: stage.counts.leaves * 8]
    sides = words["normal"] >> constant("SIDES_MET_SHIFT") & constant("SIDES_MET_MASK")
    return np.asarray(sides).reshape(-1, 8)


def united_sides(fragments: Array, slots: Array, shape: tuple[int, ...]) -> Array:
    """The same from the queue: ``slots`` (F,) says the voxel of each fragment, in ``shape``."""
    met = np.zeros(int(np.prod(shape)), np.uint32)
    sides = fragments["normal"] >> constant("SIDES_MET_SHIFT") & constant("SIDES_MET_MASK")
    np.bitwise_or.at(met, slots, sides)
    return met.reshape(shape)


def leaf_covers(stage: Stage) -> tuple[Array, Array]:
    """(S, 8, 6) 1 where a side is met, (S, 8, 3) where one of an axis is."""
    sides = (sides_met(stage)[..., None] >> SIDE_BITS & 1).astype(np.float64)
    return sides, sides.reshape(*sides.shape[:2], 3, 2).max(axis=-1)


def rgb9e5_values(words: Array) -> Array:
    """(..., 3) colours of RGB9E5 codes [EXT_texture_shared_exponent]."""
    words = np.asarray(words, np.uint32)[..., None]
    scale = np.exp2((words >> 27).astype(np.float64) - 24.0)
    return np.asarray((words >> np.array([0, 9, 18], np.uint32) & 511) * scale)


def leaf_values(stage: Stage) -> tuple[Array, Array]:
    """(S, 8, 4) premultiplied radiance and opacity, (S, 8, 3) mean normals, by slot and voxel.

    Slots count the bricks of the levels that may hold leaves.
    """
    leaves = stage.counts.leaves
    radiance = rgb9e5_values(stage.octree.radiance.read(np.uint32, leaves * 8))
    words = stage.octree.attributes.read(layouts().struct("VoxelAttributes"), leaves * 8)
    normal = words["normal"].copy().view(np.int8).reshape(leaves, 8, 4)[..., :3] / 127.0
    opacity = (words["albedo"].reshape(leaves, 8, 1) >> 24) / 255.0
    values = np.concatenate([radiance.reshape(leaves, 8, 3) * opacity, opacity], axis=-1)
    return values, np.maximum(normal, -1.0)


def sided_values(stage: Stage, pools: Pools) -> Array:
    """(I, 8, 7, 4) HDR values of every brick above the finest level by [brick, voxel, stack].

    Leaves of coarser regions derive theirs from radiance and normal.
    """
    values = stage.sided[: stage.counts.interior].copy()
    leaves = np.flatnonzero(pools.is_leaf[: len(values)])
    if len(leaves) == 0:
        return values
    first = stage.state["level_first"][stage.own_grid.coarsest_leaf]
    voxels = ((leaves - first)[:, None] * 8 + np.arange(8)).ravel()
    for axis in range(3):
        for k, side in enumerate(("plus", "minus")):
            got = run_glsl(
                stage.device,
                ["lib/voxel.glsl"],
                f"leaf_sides(v).{side}[{axis}]",
                {"v": voxels.astype(np.uint32)},
                "vec4",
                reads=stage.octree.voxel_reads(),
                params=stage.octree.params,
            )
            values[leaves, :, 2 * axis + k] = got.reshape(-1, 8, 4)
    values[leaves, :, 6] = 0.0
    opacity = (leaf_values(stage)[0][..., 3:] * leaf_covers(stage)[1])[leaves - first]
    values[leaves, :, 6, :3] = opacity
    return values
