"""How large the octree's pools have to be: counted by the GPU before they are made."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from elemental.gpu.device import Device
from elemental.gpu.resources import Buffer
from elemental.passes.scene_gpu import GpuScene
from elemental.passes.voxel.build import find_nodes
from elemental.passes.voxel.grid import Grid
from elemental.passes.voxel.octree import Capacity, Counts, Survey
from elemental.passes.voxel.voxelize import voxelize
from elemental.scene.area_lights import AreaLight
from elemental.scene.model import Scene

UNBOUNDED = 0xFFFFFFFF
FRAGMENTS_MAX = 65535 * 128
"""Work groups a dimension times FRAGMENT_GROUP: what one indirect dispatch reaches."""
FRAGMENT_SLACK = 1.1
"""Over the expected count of fragments, whose standard deviation is far smaller."""
MOTION_SLACK = 1.3
"""Room for what moves: a turned body covers more voxels than one along the axes [inferred: a cube
up to sqrt(3) times as many, and most of a scene stands still]."""
BRICKS_MAX = 1 << 20
"""Bricks that the largest atlas holds, rounded down."""


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
    """The largest radiance that voxels emit: not that of ``area_lights``.

    An unlit material shows its base colour.
    """
    elsewhere = {light.instance for light in area_lights}
    used = {i.mesh for n, i in enumerate(scene.instances) if n not in elsewhere}
    materials = [scene.materials[scene.meshes[mesh].material] for mesh in used]
    emitted = [float(m.emissive.max()) for m in materials]
    unlit = [float(m.base_color[:3].max()) for m in materials if m.unlit]
    return max([0.0, *emitted, *unlit])


def count(device: Device, scene: GpuScene, grid: Grid, area_m2: float) -> Counts:
    """What a build of the scene asks for. Renders a graph of its own and waits for it.

    Done once when a scene or a grid is new; the frames themselves never wait.
    """
    expected = area_m2 / grid.voxel_m**2 * FRAGMENT_SLACK + 4 * grid.resolution
    fragments = int(min(max(expected, 1024.0), FRAGMENTS_MAX))
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
        if counts.fragments_dropped == 0 or fragments == FRAGMENTS_MAX:
            return replace(counts, fragments=asked, fragments_dropped=0)
        fragments = min(asked, FRAGMENTS_MAX)


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


def with_slack(counts: Counts) -> Counts:
    """Counts as of a scene that MOTION_SLACK times as much may have to hold, as things move."""

    def more(count: int) -> int:
        return int(count * MOTION_SLACK) + 1

    return replace(
        counts,
        fragments=more(counts.fragments),
        tiles=more(counts.tiles),
        bricks=more(counts.bricks),
        leaves_asked=more(counts.leaves_asked),
        interior_asked=more(counts.interior_asked),
    )


def capacity_for(counts: Counts, budget_bytes: int, keeps_slots: bool = False) -> Capacity:
    """Pools for these counts; fewer leaves where the budget or the atlas can't hold them all."""
    wanted = Capacity(
        fragments=min(max(counts.fragments + counts.fragments_dropped, 1), FRAGMENTS_MAX),
        tiles=max(counts.tiles + counts.tiles_dropped, 1),
        bricks=max(counts.bricks + counts.bricks_dropped, 1),
        leaves=max(counts.leaves_asked, 1),
        interior=max(counts.interior_asked, 1),
    )
    excess = max(0, wanted.nbytes(keeps_slots) - budget_bytes)
    one, none = (replace(wanted, bricks=n, leaves=n).nbytes(keeps_slots) for n in (1, 0))
    a_leaf = one - none
    cut = min(max(-(-excess // a_leaf), wanted.bricks - BRICKS_MAX), wanted.leaves - 1)
    cut = max(cut, 0)
    return replace(wanted, bricks=wanted.bricks - cut, leaves=wanted.leaves - cut)
