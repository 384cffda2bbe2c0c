"""A picture of the octree itself."""

from __future__ import annotations

from elemental.core.layout import Block, layouts, pack
from elemental.gpu.formats import RGBA16F
from elemental.gpu.graph import Graph
from elemental.gpu.refs import TextureHandle
from elemental.gpu.shaders import Compute
from elemental.passes.voxel.octree import Octree

VOXELS = Compute("views/voxels.comp.glsl")


def voxel_view(
    g: Graph, view: Block, octree: Octree, size: tuple[int, int], mip: int
) -> TextureHandle:
    """Voxels as flat cubes of their radiance towards the eye, (H, W) RGBA16F linear.

    ``mip`` counts levels up from the finest.
    """
    image = g.texture("view.voxels", size=size, format=RGBA16F)
    level = max(octree.grid.leaf_level - mip, 0)
    g.compute(
        VOXELS,
        "view.voxels",
        reads=octree.tracing_reads(),
        writes={"o_image": image},
        params={
            "View": view,
            **octree.params,
            "VoxelView": pack(layouts().block("VoxelView"), level=level),
        },
        threads=size,
    )
    return image
