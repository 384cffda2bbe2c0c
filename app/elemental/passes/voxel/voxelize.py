"""Triangles to a queue of fragments: one rasterization an axis. [Mittring12 "Voxel Lighting
Pipeline"]"""

from __future__ import annotations

from elemental.core.layout import layouts, pack
from elemental.gpu.encode import Encoder
from elemental.gpu.graph import Graph
from elemental.gpu.refs import BufferHandle
from elemental.gpu.shaders import Raster
from elemental.gpu.state import RasterState
from elemental.passes.scene_gpu import GpuScene
from elemental.passes.scene_pack import ALL_SLOTS, Batch
from elemental.passes.voxel.octree import Survey
from elemental.scene.model import AlphaMode

VERT, FRAG = "voxel/voxelize.vert.glsl", "voxel/voxelize.frag.glsl"
VARIANTS = {
    mask: Raster(VERT, FRAG, defines={"MATERIAL_TEXTURES": mask}) for mask in (0, ALL_SLOTS)
}
BOTH_SIDES = RasterState(cull="none", depth_test="none", depth_write=False)
ALPHA_MODES: tuple[AlphaMode, ...] = ("opaque", "mask", "blend")


def voxelize(g: Graph, scene: GpuScene, octree: Survey) -> BufferHandle:
    """The fragment queue: VoxelFragment for each lattice line that crosses a triangle.

    Seen along each of the three axes, so that the surface separates its sides: no path of
    face-connected empty voxels crosses it. What the queue can't hold is counted, not written.
    """
    g.copy_buffer(octree.empty_state, octree.state)
    nbytes = octree.capacity.fragments * layouts().struct("VoxelFragment").itemsize
    fragments = g.buffer("voxel.fragments", nbytes)
    side = octree.grid.resolution
    for mask, shader in VARIANTS.items():
        batches = scene.batches(ALPHA_MODES, textured=mask != 0)
        if not batches:
            continue

        def draw(encoder: Encoder, batches: list[Batch] = batches, mask: int = mask) -> None:
            scene.draw(encoder, batches, texture_mask=mask, cull=False)

        for axis, name in enumerate("xyz"):
            g.raster(
                shader,
                f"voxelize.{name}{'.textured' if mask else ''}",
                size=(side, side),
                state=BOTH_SIDES,
                reads={"Instances": scene.instances, "Materials": scene.materials},
                writes={"State": octree.state, "Fragments": fragments},
                params={**octree.params, "Voxelize": pack(layouts().block("Voxelize"), axis=axis)},
                draw=draw,
            )
    return fragments
