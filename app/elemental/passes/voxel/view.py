"""Pictures of the octree itself."""

from __future__ import annotations

from elemental.core.layout import Block, layouts, pack
from elemental.gpu.formats import RGBA8, RGBA16F
from elemental.gpu.graph import Graph
from elemental.gpu.refs import TextureHandle
from elemental.gpu.shaders import Compute
from elemental.passes.voxel.octree import Octree

VOXEL_VIEWS = {
    "voxels": "the octree's voxels at voxels.level, as voxels.side shows them, linear",
    "regions": "leaf level of each region, false colour: blue 5, violet 6, orange 7, yellow 8, "
    "white 9; every second region is darker",
    "occupancy": "nodes at voxels.level by how many of their eight voxels they hold, false colour",
    "pools": "how full the octree's pools are, five bars, from the top: fragments, tiles of eight "
    "nodes, bricks, leaf bricks, bricks above the finest level; dark: free, red: not all fitted "
    "(shot --report tells how many were dropped)",
}
"""Views of the octree -> help; "voxels" is linear, the others display codes."""

RAYS = {
    "all": None,
    "+x": (-1.0, 0.0, 0.0),
    "-x": (1.0, 0.0, 0.0),
    "+y": (0.0, -1.0, 0.0),
    "-y": (0.0, 1.0, 0.0),
    "+z": (0.0, 0.0, -1.0),
    "-z": (0.0, 0.0, 1.0),
}
"""Side of the voxels, by its outward normal -> the ray that looks at it; all: the eye's own."""

VOXELS = Compute("views/voxels.comp.glsl")
REGIONS = Compute("views/nodes.comp.glsl", defines={"REGIONS": 1})
NODES = Compute("views/nodes.comp.glsl")
POOLS = Compute("views/pools.comp.glsl")


def voxel_view(
    g: Graph, view: Block, octree: Octree, size: tuple[int, int], name: str, mip: int, side: str
) -> TextureHandle:
    """One of VOXEL_VIEWS; (H, W) RGBA16F linear for "voxels", RGBA8 display codes for the others.

    ``mip`` counts levels up from the finest; ``side`` is one of RAYS.
    """
    image = g.texture(f"view.{name}", size=size, format=RGBA16F if name == "voxels" else RGBA8)
    if name == "pools":
        g.compute(
            POOLS,
            "view.pools",
            reads={"State": octree.state},
            writes={"o_image": image},
            params={"View": view, **octree.params},
            threads=size,
        )
        return image
    ray = RAYS[side]
    level = octree.grid.leaf_level - (0 if name == "regions" else mip)
    looked_along = (0.0, 0.0, 0.0, 0.0) if ray is None else (*ray, 1.0)
    shown = pack(layouts().block("VoxelView"), level=max(level, 0), ray=looked_along)
    shader, reads = VOXELS, octree.tracing_reads()
    if name != "voxels":
        shader = REGIONS if name == "regions" else NODES
        reads = {"Nodes": octree.nodes, "Bricks": octree.bricks, "Regions": octree.regions}
    g.compute(
        shader,
        f"view.{name}",
        reads=reads,
        writes={"o_image": image},
        params={"View": view, **octree.params, "VoxelView": shown},
        threads=size,
    )
    return image
