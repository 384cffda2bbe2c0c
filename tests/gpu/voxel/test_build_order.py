# GI-02 GI-05
"""A build depends on the scene alone: not on the order of fragments or of threads."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from elemental.core.layout import layouts
from elemental.gpu.device import Device
from elemental.passes.voxel.build import build
from elemental.passes.voxel.grid import Grid
from elemental.scene.model import Scene
from gpu.rig import at, scene, vector
from gpu.voxel.digest import contents, digest
from gpu.voxel.pools import SIDE_BITS, Pools, rgb9e5_values, sides_met, united_sides
from gpu.voxel.scenes import colored, glowing, jumble, part
from gpu.voxel.stage import MakeStage, Stage
from shapes import box, quad

Array = npt.NDArray[Any]
ROOT = Path(__file__).parents[3]


def test_two_builds_are_equal_to_the_bit(stage: MakeStage, jumbled: Stage) -> None:
    assert contents(stage(jumble())) == contents(jumbled)


def test_a_build_does_not_depend_on_the_number_of_threads(device: Device, jumbled: Stage) -> None:
    """llvmpipe with one thread runs everything in order."""
    path = os.pathsep.join(str(ROOT / name) for name in ("app", "tests"))
    result = subprocess.run(
        [sys.executable, "-m", "gpu.voxel.digest"],
        env=os.environ | {"PYTHONPATH": path, "LP_NUM_THREADS": "1"},
        capture_output=True,
        text=True,
        timeout=100,
        check=True,
    )
    assert result.stdout.strip() == digest(jumbled)


def test_the_order_of_fragments_does_not_matter(device: Device, stage: MakeStage) -> None:
    made = stage(jumble())
    expected = contents(made)
    shuffled = np.random.default_rng(7).permutation(made.fragments)
    assert not np.array_equal(shuffled, made.fragments)
    queue = device.buffer("shuffled", shuffled)
    g = device.begin_frame()
    build(g, made.octree, queue)
    g.execute()
    made.light()
    assert contents(made) == expected
    queue.release()


def snorm8(codes: Array) -> Array:
    """(N, 3) of the three lower bytes."""
    return np.maximum(codes.view(np.int8).reshape(-1, 4)[:, :3] / 127.0, -1.0)


def averages(keys: Array, values: Array, weights: Array | None = None) -> Array:
    """Mean of ``values`` (F, k) over equal ``keys`` (F,), by ascending key."""
    _, place = np.unique(keys, return_inverse=True)
    weight = np.ones(len(keys)) if weights is None else weights
    sums = [np.bincount(place, column * weight) for column in values.T.astype(np.float64)]
    return np.stack(sums, axis=-1) / np.maximum(np.bincount(place, weight), 1e-30)[:, None]


def test_a_build_keeps_nothing_of_the_one_before(device: Device, stage: MakeStage) -> None:
    """A second build of fewer fragments, in the same pools, is what a first one would be."""
    made, fresh = stage(jumble()), stage(jumble(), bounces=0)
    half = made.fragments[::2].copy()
    for one in (made, fresh):
        queue = device.buffer("half", half)
        state = one.state.copy()
        state["fragment_count"] = len(half)
        state["fragments"]["x"] = -(-len(half) // 128)
        one.octree.state.write(state)
        if one is fresh:
            for pool in ("nodes", "bricks", "attributes", "radiance"):
                buffer = getattr(one.octree, pool)
                buffer.write(bytes(buffer.nbytes))
        g = device.begin_frame()
        build(g, one.octree, queue)
        g.execute()
        one.light()
        queue.release()
    assert made.counts == fresh.counts
    assert contents(made) == contents(fresh)


def count_bits(sides: Array) -> Array:
    """How many sides are met."""
    return np.asarray((sides[..., None] >> SIDE_BITS & 1).sum(axis=-1))


def lamp_on_a_ceiling() -> Scene:
    """A lamp a third of a voxel beside a ceiling: fragments of both share voxels."""
    ceiling, lamp = part(quad(2.0), 0, at(0, 0.01, 0)), part(quad(0.7), 1, at(0, 0.02, 0))
    return scene(ceiling, lamp, materials=[colored(0.9, 0.6, 0.3), glowing(5.0, 3.0, 1.0)])


def pool_of_light() -> Scene:
    """A glowing square in a dark frame, two voxels high: fragments of both share voxels."""
    bars = [box((0.06, 0.06, 0.76)), box((0.06, 0.06, 0.76)), box((0.7, 0.06, 0.06))]
    places = [at(-0.38, 0, 0), at(0.38, 0, 0), at(0, 0, 0.38)]
    frame = [part(bar, 0, place) for bar, place in zip(bars, places, strict=True)]
    glow = part(quad(0.7), 1, at(0, 0.01, 0))
    return scene(*frame, glow, materials=[colored(0.5, 0.5, 0.5), glowing(5.0, 3.0, 1.0)])


@pytest.mark.parametrize("world", [jumble, lamp_on_a_ceiling, pool_of_light])
def test_attributes_average_all_fragments_of_a_voxel(
    stage: MakeStage, world: Callable[[], Scene]
) -> None:
    """Albedo, opacity and normal over all; emitted light over the fragments that emit, spread over
    the sides of all."""
    jumbled = stage(world(), grid=Grid.fit((vector(-1, -1, -1), vector(1, 1, 1)), 64))
    fragments, pools, grid = jumbled.fragments, Pools.read(jumbled), jumbled.own_grid
    points = jumbled.fragment_points + grid.resolution // 2
    brick = pools.brick_at(points >> 1, grid.leaf_level)
    first = int(jumbled.state["level_first"][grid.leaf_level])
    slots = (brick - first) * 8 + (points & 1) @ np.array([1, 2, 4])
    struct = layouts().struct("VoxelAttributes")
    held = jumbled.octree.attributes.read(struct, jumbled.counts.leaves * 8)[np.unique(slots)]
    assert np.bincount(slots).max() >= 2
    met = sides_met(jumbled)
    np.testing.assert_array_equal(met, united_sides(fragments, slots, met.shape))

    albedo = averages(slots, fragments["albedo"].copy().view(np.uint8).reshape(-1, 4))
    got = held["albedo"].copy().view(np.uint8).reshape(-1, 4)
    assert np.abs(got - albedo).max() <= 0.5 + 1e-3

    normals = snorm8(fragments["normal"].copy())
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    # Each is rounded to 1/127 before it is added, and the mean once more.
    got = snorm8(held["normal"].copy())
    assert np.abs(got - averages(slots, normals)).max() <= 1.01 / 127

    emitted = rgb9e5_values(fragments["emissive"])
    emits = (emitted.max(axis=1) > 0).astype(float)
    wanted = averages(slots, emitted, emits)
    glows = emits > 0
    glowing_sides = united_sides(fragments[glows], slots[glows], met.shape)
    share = count_bits(glowing_sides) / np.maximum(count_bits(met), 1)
    wanted *= share.ravel()[np.unique(slots), None]
    got = rgb9e5_values(held["emissive"])
    brightest = emitted.max()
    bound = wanted.max(axis=1, keepdims=True) / 512 + brightest / 65535
    assert (np.abs(got - wanted) <= bound).all()
    assert got.max() > 0.99 * brightest


@pytest.mark.parametrize("world", [lamp_on_a_ceiling, pool_of_light])
def test_leaves_have_the_power_of_what_they_hold(
    stage: MakeStage, world: Callable[[], Scene]
) -> None:
    """Radiance by the sides that show it, a voxel's face each: the lamp's area, once, wherever it
    shares voxels with what is dark. [docs/gi.md "Bricks"]"""
    made = stage(world(), grid=Grid.fit((vector(-1, -1, -1), vector(1, 1, 1)), 64))
    sides = count_bits(sides_met(made)).ravel()
    held = made.octree.attributes.read(layouts().struct("VoxelAttributes"), sides.size)
    power = (rgb9e5_values(held["emissive"]) * sides[:, None]).sum(axis=0)
    area = 0.7**2 / made.own_grid.voxel_m**2
    np.testing.assert_allclose(power / area, [5.0, 3.0, 1.0], rtol=0.05)
