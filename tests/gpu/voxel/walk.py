"""Scenes that move at random, and what an octree holds of them by cell, whatever the slots."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from elemental.core.layout import layouts
from elemental.gpu.device import Device
from elemental.gpu.resources import Texture
from elemental.passes.area_lights import pack_area_lights
from elemental.passes.voxel.lighting import VoxelLighting
from elemental.passes.voxel.octree import LEAF_TEXELS, SIDED_TEXELS, Octree
from elemental.scene.evaluate import Pose
from elemental.scene.model import Scene
from gpu.rig import at, scene, sun, vector
from gpu.voxel.pools import ABSENT, Pools
from gpu.voxel.scenes import colored, glowing, part, turned
from gpu.voxel.stage import Lit
from shapes import box, quad, sphere

Array = npt.NDArray[Any]
REACH = 0.75
"""How far from the middle of the scene the moving bodies stay, m."""


def world(bodies: int, seed: int = 1) -> Scene:
    """A floor, a wall and a pillar that stand; ``bodies`` that can move, some glowing, under
    a sun, a lamp and a spot."""
    rng = np.random.default_rng(seed)
    shapes = (box((0.25, 0.2, 0.3)), sphere(0.16, rings=6), quad(0.4), box((0.5, 0.03, 0.1)))
    moving = [part(shapes[i % 4], int(rng.integers(3)), at(0, 0, 0)) for i in range(bodies)]
    made = scene(
        part(quad(2.0), 0, at(0, -0.9, 0)),
        part(box((2.0, 0.05, 0.4)), 1, turned(vector(1, 0.2, 0), 0.4, to=(0, -0.2, -0.7))),
        part(box((0.2, 1.2, 0.2)), 0, at(0.4, -0.3, 0.1)),
        *moving,
        materials=[colored(0.8, 0.8, 0.8), colored(0.9, 0.2, 0.1), glowing(3.0, 2.0, 0.5)],
        lights=[sun(vector(-0.4, -1.0, -0.3))],
    )
    lamp = replace(made.lights[0], kind="point", position=vector(-0.5, 0.6, 0.4), intensity=2.0)
    spot = replace(lamp, kind="spot", position=vector(0.5, 0.9, 0.5), outer_angle=0.6)
    made.lights += [lamp, spot]
    for instance in made.instances[3:]:
        instance.dynamic = True
    made.extent = vector(-1, -1, -1), vector(1, 1, 1)
    return made


@dataclass
class Walk:
    """Poses of the dynamic instances of a scene, each after the other at random."""

    scene: Scene
    rng: np.random.Generator
    share: float = 1.0
    """Of the bodies that change in a step."""

    def __post_init__(self) -> None:
        self.numbers = np.array([n for n, i in enumerate(self.scene.instances) if i.dynamic])
        count = len(self.numbers)
        self.world = np.stack([self._placed() for _ in range(count)])
        self.visible = self.rng.random(count) < 0.8

    def _placed(self) -> Array:
        """Anywhere, turned and scaled at random."""
        turn = turned(self.rng.normal(size=3), float(self.rng.uniform(0, 3)))
        turn[:3, :3] *= self.rng.uniform(0.4, 1.3, 3).astype(np.float32)
        turn[:3, 3] = self.rng.uniform(-REACH, REACH, 3)
        return turn

    def step(self) -> Pose:
        for k in np.flatnonzero(self.rng.random(len(self.numbers)) < self.share):
            what = self.rng.integers(5)
            if what == 0:
                self.world[k] = self._placed()
            elif what == 1:
                self.visible[k] ^= True
            elif what == 2:
                self.world[k] = self.world[k] @ turned(self.rng.normal(size=3), 0.3)
            elif what == 3:
                moved = self.world[k][:3, 3] + self.rng.normal(0, 0.08, 3)
                self.world[k][:3, 3] = np.clip(moved, -REACH, REACH)
        return self.pose()

    def pose(self) -> Pose:
        return Pose(
            self.numbers, self.world.copy(), self.visible.copy(), {}, {}, self.scene.lights, []
        )


def still(scene: Scene, pose: Pose) -> Scene:
    """The scene with everything where a pose has it, and nothing that can move."""
    instances = [replace(instance, dynamic=False) for instance in scene.instances]
    hidden = []
    for number, matrix, visible in zip(
        pose.instances, pose.world_from_local, pose.visible, strict=True
    ):
        instances[number].world_from_local = matrix
        if not visible:
            hidden.append(number)
    kept = [instance for n, instance in enumerate(instances) if n not in hidden]
    return replace(scene, instances=kept, extent=scene.extent)


def update(lit: Lit, voxels: VoxelLighting, bounces: int = 1, spread: bool = False) -> list[str]:
    """A frame of the octree alone. Returns the names of its passes."""
    g = lit.device.begin_frame()
    lit.gpu.deform(g)
    lit.illuminate(g)
    voxels.update(g, lit.shadows, lit.sky, pack_area_lights([]), lit.light_key, bounces, spread)
    names = [node.name for node in g.passes]
    g.execute()
    return names


def show(
    device: Device,
    lit: Lit,
    voxels: VoxelLighting,
    pose: Pose,
    bounces: int = 1,
    spread: bool = False,
) -> list[str]:
    """The frame of a pose; the names of its passes."""
    lit.gpu.update(pose)
    names = update(lit, voxels, bounces, spread)
    device.finish()
    return names


@dataclass
class Held:
    """What an octree holds, sorted by level and cell.

    cell (B, 4): level and cell; points (B,); is_leaf (B,); scale (B,); attributes (B, 8, 3) and
    radiance (B, 8, 2) words, zeros where a point is empty; texels (B, 27, 6, 4) of the bricks above
    the finest level, (B, 27, 8) of those of the finest, as [interior, finest].
    """

    cell: Array
    points: Array
    is_leaf: Array
    scale: Array
    attributes: Array
    radiance: Array
    texels: tuple[Array, Array]


def held(octree: Octree) -> Held:
    """All that a reader of the octree can reach."""
    pools = Pools.of(octree, octree.capacity.tiles, octree.capacity.bricks)
    grid, state = octree.grid, octree.state.read(layouts().struct("OctreeState"), 1)[0]
    bricks = np.concatenate([brick[brick != ABSENT] for brick in pools.brick])
    at_level = [np.argwhere(brick != ABSENT) for brick in pools.brick]
    found = np.concatenate([np.insert(cells, 0, n, axis=1) for n, cells in enumerate(at_level)])
    np.testing.assert_array_equal(pools.cell[bricks], found[:, 1:])
    np.testing.assert_array_equal(pools.level[bricks], found[:, 0])
    assert len(np.unique(bricks)) == len(bricks)
    leaf = pools.is_leaf[bricks]
    words = layouts().struct("VoxelAttributes").itemsize // 4
    attributes = octree.attributes.read(np.uint32).reshape(-1, 8, words)
    radiance = octree.radiance.read(np.uint32).reshape(-1, 8, 1)
    slots = np.where(leaf, bricks - int(state["first_leaf_brick"]), 0)
    occupied = (pools.points[bricks, None] >> np.arange(8) & 1).astype(bool) & leaf[:, None]
    finest = found[:, 0] == grid.leaf_level
    leaf_slots = bricks[finest] - int(state["first_finest_brick"])
    colors = _texels(octree.leaf_colors, leaf_slots, LEAF_TEXELS)
    normals = _texels(octree.leaf_normals, leaf_slots, LEAF_TEXELS)
    sided = _texels(octree.atlas, bricks[~finest], SIDED_TEXELS)
    return Held(
        cell=found,
        points=pools.points[bricks],
        is_leaf=leaf,
        scale=pools.scale[bricks],
        attributes=attributes[slots] * occupied[..., None],
        radiance=radiance[slots] * occupied[..., None],
        texels=(sided, np.concatenate([colors.view(np.int8), normals.view(np.int8)], axis=-1)),
    )


def _texels(atlas: Texture, slots: Array, brick: tuple[int, int, int]) -> Array:
    """(N, 27 or 189, 4) texels of bricks."""
    texels = atlas.read()
    width, height, depth = brick
    a_row = texels.shape[2] // width
    x, y, z = slots % a_row, slots // a_row % a_row, slots // (a_row * a_row)
    k, j, i = np.indices((depth, height, width)).reshape(3, -1)
    return np.asarray(
        texels[(z * depth)[:, None] + k, (y * height)[:, None] + j, (x * width)[:, None] + i]
    )


def assert_same(got: Held, wanted: Held) -> None:
    """Equal to the bit."""
    for name in ("cell", "points", "is_leaf", "attributes", "radiance", "scale"):
        np.testing.assert_array_equal(getattr(got, name), getattr(wanted, name), name)
    for one, other, name in zip(got.texels, wanted.texels, ("sides", "leaves"), strict=True):
        np.testing.assert_array_equal(one, other, name)
