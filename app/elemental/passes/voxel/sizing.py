"""How large the octree's pools have to be: counted by the GPU before they are made."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from elemental.core.layout import layouts
from elemental.gpu.device import Device
from elemental.gpu.resources import Buffer
from elemental.passes.scene_gpu import GpuScene
from elemental.passes.voxel.build import find_nodes
from elemental.passes.voxel.grid import MAX_LEVEL, Grid, octal_sum
from elemental.passes.voxel.octree import (
    LEAF_TEXELS,
    SIDED_BYTES_A_BRICK,
    SIDED_TEXELS,
    Atlas,
    Capacity,
    Counts,
    Survey,
)
from elemental.passes.voxel.voxelize import voxelize
from elemental.scene.area_lights import AreaLight
from elemental.scene.model import Scene

UNBOUNDED = 0xFFFFFFFF
STORAGE_BLOCK_BYTES = 1 << 27
"""Of a storage block, where no driver is asked: what GL 4.5 promises (table 23.64)."""
BRICKS_MAX = int(layouts().constant("NODE_BRICK_MASK")) - 1
"""What a node can name."""
TILES_MAX = (int(layouts().constant("BRICK_NODE_MASK")) >> 3) - octal_sum(MAX_LEVEL - 2) // 8
"""Of eight nodes, beside the dense ones, what a brick can name."""
FRAGMENT_SLACK = 1.1
"""Over the expected count of fragments, whose standard deviation is far smaller."""
MOTION_SLACKS = (1.3, 1.1)
"""Room for what moves: a turned body covers more voxels than one along the axes [inferred: a cube
up to sqrt(3) times as many, and most of a scene stands still]. Where the budget can't hold the
first, the second: leaves that are there come before room for some that may come."""
GAIN_MIN = 1 / 16
"""Least share of the bricks asked for that new pools must add where they still can't hold all
[inferred: more than what moves from frame to frame, less than one sees]."""


def storage_max(storage_bytes: int) -> Capacity:
    """The most that pools can hold where a storage block has so many bytes, whatever the budget.

    Dispatches are folded and reach further.
    """
    return Capacity(
        fragments=storage_bytes // int(layouts().struct("VoxelFragment").itemsize),
        tiles=min(TILES_MAX, storage_bytes // (8 * int(layouts().struct("Node").itemsize))),
        bricks=min(BRICKS_MAX, storage_bytes // int(layouts().struct("Brick").itemsize)),
        leaves=min(
            Atlas.most(LEAF_TEXELS),
            storage_bytes // (8 * int(layouts().struct("VoxelAttributes").itemsize)),
        ),
        interior=min(Atlas.most(SIDED_TEXELS), storage_bytes // SIDED_BYTES_A_BRICK),
    )


def projected_area(scene: Scene) -> float:
    """Sum of the areas, m^2, that all triangles cover as seen along x, y and z.

    Divided by the squared lattice spacing it is the expected number of voxel fragments.
    """
    total = 0.0
    areas: dict[int, np.ndarray[tuple[int, ...], np.dtype[np.float64]]] = {}
    for instance in scene.instances:
        if instance.mesh not in areas:
            mesh = scene.meshes[instance.mesh]
            corners = mesh.positions[mesh.indices.reshape(-1, 3)].astype(np.float64)
            areas[instance.mesh] = np.cross(
                corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
            )
        linear = instance.world_from_local[:3, :3].astype(np.float64)
        # Cross products transform by the cofactor matrix, det(M) M^-T.
        cofactor = np.stack([np.cross(linear[(i + 1) % 3], linear[(i + 2) % 3]) for i in range(3)])
        total += float(np.abs(areas[instance.mesh] @ cofactor.T).sum()) * 0.5
    return total


def max_emission(scene: Scene, area_lights: Sequence[AreaLight] = ()) -> float:
    """The largest radiance that voxels emit: not that of ``area_lights``."""
    elsewhere = {light.instance for light in area_lights}
    used = {i.mesh for n, i in enumerate(scene.instances) if n not in elsewhere}
    materials = [scene.materials[scene.meshes[mesh].material] for mesh in used]
    glowing = [decal for decal in scene.decals if "emission" in decal.channels]
    materials += [scene.materials[decal.material] for decal in glowing]
    return max([0.0, *(material.emission_max for material in materials)])


def count(device: Device, scene: GpuScene, grid: Grid, area_m2: float) -> Counts:
    """What a build of the scene asks for. Renders a graph of its own and waits for it.

    Done once when a scene or a grid is new; the frames themselves never wait.
    """
    most = storage_max(device.storage_limit).fragments
    expected = area_m2 / grid.voxel_m**2 * FRAGMENT_SLACK + 4 * grid.resolution
    fragments = int(min(max(expected, 1024.0), most))
    while True:
        unbounded = Capacity(fragments, UNBOUNDED, UNBOUNDED, UNBOUNDED, UNBOUNDED // 2)
        survey = Survey(device, grid, unbounded, 0.0)
        g = device.begin_frame()
        scene.deform(g)
        find_nodes(g, survey, voxelize(g, scene, survey))
        g.execute()
        counts = Counts.from_state(survey.state.read().tobytes())
        survey.release()
        asked = counts.fragments + counts.fragments_dropped
        if counts.fragments_dropped == 0 or fragments == most:
            return replace(counts, fragments=asked, fragments_dropped=0)
        fragments = min(asked, most)


def count_again(octree: Survey, grid: Grid, fragments: Buffer) -> Counts:
    """What another grid on the same lattice asks for, by the fragments of an octree's last build.

    Renders a graph of its own and waits for it.
    """
    device = octree.device
    unbounded = Capacity(octree.capacity.fragments, UNBOUNDED, UNBOUNDED, UNBOUNDED, UNBOUNDED // 2)
    survey = Survey(device, grid, unbounded, 0.0)
    g = device.begin_frame()
    g.copy_buffer(octree.state, survey.state)
    find_nodes(g, survey, fragments)
    g.execute()
    counts = Counts.from_state(survey.state.read().tobytes())
    survey.release()
    return counts


def with_slack(counts: Counts, slack: float) -> Counts:
    """Counts as if the scene asked for ``slack`` times as much. What was dropped was asked for."""

    def more(count: int) -> int:
        return int(count * slack) + 1

    leaves, interior = more(counts.leaves_asked), more(counts.interior_asked)
    both = counts.leaves_asked + counts.interior_asked - counts.bricks - counts.bricks_dropped
    return replace(
        counts,
        fragments=more(counts.fragments + counts.fragments_dropped),
        fragments_dropped=0,
        tiles=more(counts.tiles + counts.tiles_dropped),
        tiles_dropped=0,
        bricks=leaves + interior - int(both * slack),
        bricks_dropped=0,
        leaves_asked=leaves,
        interior_asked=interior,
    )


def capacity_for(
    counts: Counts,
    budget_bytes: int,
    keeps_slots: bool = False,
    storage_bytes: int = STORAGE_BLOCK_BYTES,
) -> Capacity:
    """Pools for these counts; where the budget or a storage block can't hold them all, fewer
    leaves, and where they can't hold the others either, fewer of those."""
    most = storage_max(storage_bytes)
    wanted = Capacity(
        fragments=min(max(counts.fragments + counts.fragments_dropped, 1), most.fragments),
        tiles=min(max(counts.tiles + counts.tiles_dropped, 1), most.tiles),
        bricks=max(counts.bricks + counts.bricks_dropped, 1),
        leaves=max(counts.leaves_asked, 1),
        interior=max(counts.interior_asked, 1),
    )

    def excess(capacity: Capacity, **one: int) -> int:
        """How many of what `one` is a single one of have to go."""
        alone = replace(capacity, **one).nbytes(keeps_slots)
        none = replace(capacity, **dict.fromkeys(one, 0)).nbytes(keeps_slots)
        return max(0, -(-(capacity.nbytes(keeps_slots) - budget_bytes) // (alone - none)))

    cut = max(excess(wanted, bricks=1, leaves=1), wanted.leaves - most.leaves)
    cut = max(cut, wanted.bricks - most.bricks)
    cut = max(min(cut, wanted.leaves - 1, wanted.bricks - 1), 0)
    wanted = replace(wanted, bricks=wanted.bricks - cut, leaves=wanted.leaves - cut)
    cut = max(excess(wanted, bricks=1, interior=1), wanted.interior - most.interior)
    cut = max(min(cut, wanted.interior - 1, wanted.bricks - 1), 0)
    return replace(wanted, bricks=wanted.bricks - cut, interior=wanted.interior - cut)


def capacity_in_motion(
    counts: Counts, budget_bytes: int, storage_bytes: int = STORAGE_BLOCK_BYTES
) -> Capacity:
    """Pools for a scene that moves and asked for this much: with room for more."""
    for slack in MOTION_SLACKS:
        wanted = capacity_for(with_slack(counts, slack), 1 << 62, True, storage_bytes)
        if wanted.nbytes(keeps_slots=True) <= budget_bytes:
            return wanted
    return capacity_for(with_slack(counts, MOTION_SLACKS[-1]), budget_bytes, True, storage_bytes)


def bricks_kept(capacity: Capacity, counts: Counts, one_leaf_level: bool, slots: bool) -> int:
    """How many of the bricks that were asked for pools of a capacity hold, by the rules of
    `scan_groups.comp` but for tiles; ``slots``: bricks keep theirs."""
    every, leaves = counts.bricks + counts.bricks_dropped, counts.leaves_asked
    above_leaves, above_finest = every - leaves, counts.interior_asked
    finest_room = max(capacity.bricks - capacity.interior, 0)
    kept = min(every, capacity.bricks, above_leaves + capacity.leaves)
    kept = min(kept, min(above_finest, capacity.interior) + finest_room)
    if above_finest > capacity.interior:
        kept = min(kept, capacity.interior)
    if slots:
        coarse, mixed, finest, _ = capacity.slots(one_leaf_level)
        kept = min(kept, above_finest + finest)
        if above_finest - above_leaves > mixed:
            kept = min(kept, above_leaves + mixed)
        if above_leaves > coarse:
            kept = min(kept, coarse)
    return kept


def holds_all(capacity: Capacity, counts: Counts, one_leaf_level: bool, slots: bool) -> bool:
    """Whether pools of a capacity hold everything that was asked for."""
    return (
        capacity.fragments >= counts.fragments + counts.fragments_dropped
        and capacity.tiles >= counts.tiles + counts.tiles_dropped
        and bricks_kept(capacity, counts, one_leaf_level, slots)
        == counts.bricks + counts.bricks_dropped
    )


def is_worth_it(
    candidate: Capacity, held: Capacity, counts: Counts, one_leaf_level: bool, slots: bool
) -> bool:
    """Whether what was asked for finds so much more room in other pools that they should be made.

    They cost a whole build. As things move in pools that a budget limits, each frame asks for
    others that would hold a few bricks more or fewer: those wait until they are GAIN_MIN more.
    """
    fragments = counts.fragments + counts.fragments_dropped
    if held.fragments < min(fragments, candidate.fragments):
        return True
    tiles = counts.tiles + counts.tiles_dropped
    if held.tiles < min(tiles, candidate.tiles):
        return True
    now = bricks_kept(held, counts, one_leaf_level, slots)
    then = bricks_kept(candidate, counts, one_leaf_level, slots)
    every = counts.bricks + counts.bricks_dropped
    return then > now and (then == every or then - now >= every * GAIN_MIN)
