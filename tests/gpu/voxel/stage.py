"""A scene's octree, built and lit as a frame does it, with every pool open to the test."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from typing import Any

import numpy as np
import numpy.typing as npt

from elemental.core.layout import layouts
from elemental.gpu.device import Device
from elemental.gpu.graph import Graph
from elemental.gpu.refs import BufferHandle
from elemental.passes.area_lights import pack_area_lights
from elemental.passes.scene_gpu import GpuScene
from elemental.passes.shadow import ShadowMaps, update_shadows
from elemental.passes.shadow_plan import ShadowSettings
from elemental.passes.sky import Sky
from elemental.passes.voxel import sizing
from elemental.passes.voxel.build import build
from elemental.passes.voxel.grid import Grid
from elemental.passes.voxel.light import compress, filter_levels, light_voxels
from elemental.passes.voxel.lighting import VoxelLighting
from elemental.passes.voxel.octree import Capacity, Counts, Octree
from elemental.passes.voxel.voxelize import voxelize
from elemental.scene.model import Scene
from gpu.rig import camera, vector

Array = npt.NDArray[Any]
BUDGET = 1 << 30
SHADOWS = ShadowSettings(512)
# Voxels look at the maps that no camera moves; any camera will do.
CAMERA = camera(vector(0, 0, 5), vector(0, 0, 0))


class Lit:
    """A scene on the device with its shadow maps and its sky."""

    def __init__(self, device: Device, scene: Scene) -> None:
        self.device = device
        self.scene = scene
        self.gpu = GpuScene(device, scene)
        self.shadows = ShadowMaps(device, SHADOWS)
        self.sky = Sky(device)

    def begin(self) -> Graph:
        """A new frame in which shadows and sky are up to date."""
        g = self.device.begin_frame()
        self.illuminate(g)
        return g

    def illuminate(self, g: Graph) -> None:
        self.sky.update(g, self.scene.environment)
        update_shadows(g, self.shadows, self.gpu, self.scene.lights, camera=CAMERA, size=(64, 64))

    @property
    def light_key(self) -> Hashable:
        return self.shadows.lamp_key, self.sky.key

    def grid(self, resolution: int) -> Grid:
        return Grid.fit(self.gpu.bounds, resolution)

    def count(self, grid: Grid) -> Counts:
        """What a build asks for."""
        return sizing.count(self.device, self.gpu, grid, sizing.projected_area(self.scene))

    def lighting(
        self, resolution: int, capacity: Capacity | None = None, budget: int = BUDGET
    ) -> VoxelLighting:
        """The octree as the renderer keeps it."""
        return VoxelLighting(
            self.device,
            self.gpu,
            self.grid(resolution),
            area_m2=sizing.projected_area(self.scene),
            max_emission=sizing.max_emission(self.scene),
            budget_bytes=budget,
            capacity=capacity,
        )

    def release(self) -> None:
        self.gpu.release()
        self.shadows.release()
        self.sky.release()


class Stage(Lit):
    """An octree that was built from a scene and lit by it.

    `fragments` (F,) is the queue; `sided` (I, 8, 6, 4) the filtered HDR values of the bricks above
    the finest level by [brick, voxel, side].

    ``prepare`` sees the octree before anything is written to it; ``make_graph`` makes the frame.
    """

    def __init__(
        self,
        device: Device,
        scene: Scene,
        resolution: int = 64,
        *,
        grid: Grid | None = None,
        capacity: Capacity | None = None,
        bounces: int = 1,
        prepare: Callable[[Octree], None] | None = None,
        make_graph: Callable[[Device], Graph] | None = None,
    ) -> None:
        super().__init__(device, scene)
        self.own_grid = grid or self.grid(resolution)
        if capacity is None:
            capacity = sizing.capacity_for(self.count(self.own_grid), BUDGET)
        emission = sizing.max_emission(scene)
        self.octree = Octree(device, self.own_grid, capacity, emission)
        if prepare is not None:
            prepare(self.octree)
        self.transients: dict[str, Array] = {}
        self._build(make_graph)
        if bounces:
            self.light(bounces)

    def _build(self, make_graph: Callable[[Device], Graph] | None) -> None:
        g = self.device.begin_frame()
        if make_graph is not None:
            g = make_graph(self.device)
        queue = voxelize(g, self.gpu, self.octree)
        as_filled = g.buffer("queue as filled", queue.nbytes)  # building links the fragments
        g.copy_buffer(queue, as_filled)
        build(g, self.octree, queue)
        buffers = {r.name: r for r in g.handles if isinstance(r, BufferHandle)}
        for handle in buffers.values():
            g.keep(handle)
        g.execute()
        for name, handle in buffers.items():
            assert handle.physical is not None
            self.transients[name] = handle.physical.read(np.uint32, handle.nbytes // 4).copy()
        fragments = self.transients["queue as filled"].view(layouts().struct("VoxelFragment"))
        self.fragments: Array = fragments[: self.counts.fragments]

    def light(self, bounces: int = 1) -> None:
        """Light, filter and compress anew."""
        g = self.begin()
        for bounce in range(bounces):
            light_voxels(
                g, self.octree, self.shadows, self.sky, pack_area_lights([]), gather=bounce > 0
            )
            sided = filter_levels(g, self.octree)
            compress(g, self.octree, sided)
        g.keep(sided)
        g.execute()
        assert sided.physical is not None
        values = sided.physical.read(np.float16, sided.nbytes // 2)
        self.sided = values.reshape(-1, 8, 7, 4).astype(np.float64)

    @property
    def counts(self) -> Counts:
        return Counts.from_state(self.octree.state.read().tobytes())

    @property
    def state(self) -> Array:
        """The OctreeState."""
        return np.asarray(self.octree.state.read(layouts().struct("OctreeState"), 1)[0])

    @property
    def fragment_points(self) -> Array:
        """(F, 3) int64 finest lattice points of the fragments, from the scene's corner."""
        code = self.fragments["position"].astype(np.int64)
        return np.stack([code & 1023, code >> 10 & 1023, code >> 20 & 1023], axis=-1)

    def world(self, points: npt.ArrayLike, mip: int = 0) -> Array:
        """World positions of points of the cube's lattice, ``mip`` levels above the finest."""
        spacing = self.own_grid.voxel_m * 2**mip
        return np.asarray(self.own_grid.origin + np.asarray(points, np.float64) * spacing)

    def lattice(self, p_ws: npt.ArrayLike) -> Array:
        """The way back: coordinates on the cube's finest lattice."""
        offset = np.asarray(p_ws, np.float64) - self.own_grid.origin
        return np.asarray(offset / self.own_grid.voxel_m)

    def release(self) -> None:
        self.octree.release()
        super().release()


MakeStage = Callable[..., Stage]
"""Stage without its device; the fixture `stage`."""
