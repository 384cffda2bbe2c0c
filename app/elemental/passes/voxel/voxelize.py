"""Triangles to a queue of fragments: one rasterization an axis. [Mittring12 "Voxel Lighting
Pipeline"]"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

from elemental.core.layout import layouts, pack
from elemental.gpu.encode import Encoder
from elemental.gpu.graph import Graph
from elemental.gpu.refs import AnyBuffer, BufferHandle, Unordered
from elemental.gpu.shaders import Compute, Raster
from elemental.gpu.state import RasterState
from elemental.passes.material_pack import BASE_COLOR_SLOT, SLOTS, slot_mask
from elemental.passes.material_table import material_shader
from elemental.passes.scene_gpu import GpuScene
from elemental.passes.scene_pack import Batch
from elemental.passes.voxel.octree import Survey
from elemental.scene.model import AlphaMode

if TYPE_CHECKING:
    from elemental.passes.decal_voxels import DecalVoxels

VERT, FRAG = "voxel/voxelize.vert.glsl", "voxel/voxelize.frag.glsl"
SELECT = Compute("voxel/select_triangles.comp.glsl")
QUEUE = Compute("voxel/queue.comp.glsl")
COLOR_SLOTS = slot_mask(slot in ("base_color", "metallic_roughness", "emissive") for slot in SLOTS)
"""Textures that voxels are made of: they keep no roughness, and normals of their own."""
VARIANTS = {
    mask: Raster(VERT, FRAG, defines={"MATERIAL_TEXTURES": mask})
    for mask in (0, BASE_COLOR_SLOT, COLOR_SLOTS)
}
"""Of glTF's material, by MATERIAL_TEXTURES."""
BOTH_SIDES = RasterState(cull="none", depth_test="none", depth_write=False)
ALPHA_MODES: tuple[AlphaMode, ...] = ("opaque", "mask", "blend")


def select_triangles(g: Graph, scene: GpuScene, octree: Survey, dynamic: bool | None) -> None:
    """Fill the scene's lists with the triangles that may cover a lattice line, for each axis."""
    lists = scene.lists
    if not lists.selects:
        return
    first, count = lists.selection(dynamic)
    g.copy_buffer(lists.empty, lists.commands)
    selection = pack(layouts().block("TriangleSelection"), first_chunk=first, chunk_count=count)
    g.compute(
        SELECT,
        "voxelize.select",
        reads={
            "Chunks": lists.chunks,
            "Indices": scene.geometry.indices,
            "Positions": scene.geometry.positions,
            "Instances": scene.instances,
        },
        writes={"Commands": lists.commands, "Lists": lists.indices},
        params={**octree.params, "TriangleSelection": selection},
        threads=count * int(layouts().constant("TRIANGLE_GROUP")),
    )


def variant_of(batch: Batch) -> int:
    """MATERIAL_TEXTURES of the variant that a batch is drawn with."""
    return next(mask for mask in VARIANTS if not batch.texture_mask & COLOR_SLOTS & ~mask)


def variant_shader(batch: Batch) -> Raster:
    """The program that a batch is drawn with."""
    mask = variant_of(batch)
    return material_shader(VERT, FRAG, batch, texture_mask=mask, uv_transforms=True)


def voxelize(
    g: Graph, scene: GpuScene, octree: Survey, decals: DecalVoxels | None = None
) -> BufferHandle:
    """The fragment queue of the whole scene, coloured by decals, of this frame alone."""
    g.copy_buffer(octree.empty_state, octree.state)
    nbytes = octree.capacity.fragments * layouts().struct("VoxelFragment").itemsize
    fragments = g.buffer("voxel.fragments", nbytes)
    append_fragments(g, scene, octree, fragments)
    g.compute(
        QUEUE, "voxelize.queue", writes={"State": octree.state}, params=octree.params, groups=1
    )
    if decals is not None:
        decals.paint(g, octree, fragments, moving=False)
    return fragments


def append_fragments(
    g: Graph,
    scene: GpuScene,
    octree: Survey,
    fragments: AnyBuffer,
    dynamic: bool | None = None,
) -> None:
    """Append a VoxelFragment for each lattice line that crosses a triangle.

    Of what can, or can't, move; ``dynamic`` None: of all. Seen along each of the three axes, so
    that the surface separates its sides: no path of face-connected empty voxels crosses it. What
    the queue can't hold is counted, not written.
    """
    groups: dict[Raster, list[Batch]] = defaultdict(list)
    for batch in sorted(scene.batches(ALPHA_MODES, dynamic), key=variant_of):
        groups[variant_shader(batch)].append(batch)
    if not groups:
        return
    select_triangles(g, scene, octree, dynamic)
    side = octree.grid.resolution
    what = {None: "", True: "moving.", False: "still."}[dynamic]
    for shader, batches in groups.items():
        mask = variant_of(batches[0])
        definition = batches[0].definition
        material = "" if definition.is_standard else f".{definition.name}"
        for axis, name in enumerate("xyz"):

            def draw(
                encoder: Encoder, axis: int = axis, batches: list[Batch] = batches, mask: int = mask
            ) -> None:
                scene.draw_listed(encoder, batches, axis, texture_mask=mask)

            g.raster(
                shader,
                f"voxelize.{what}{name}.textures{mask}{material}",
                size=(side, side),
                state=BOTH_SIDES,
                reads=scene.materials.reads(),
                writes={
                    "State": Unordered(octree.state),  # counted by atomics; each has a place
                    "Fragments": Unordered(fragments),
                    **scene.materials.writes(batches),
                },
                params={
                    **octree.params,
                    **scene.params(),
                    "Voxelize": pack(layouts().block("Voxelize"), axis=axis),
                },
                draw=draw,
                uses=(scene.lists.commands, scene.lists.indices),
            )
