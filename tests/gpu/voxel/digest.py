"""The bytes of a built and lit octree, to compare builds. As a program: prints them, hashed."""

from __future__ import annotations

import hashlib
from typing import Any

import numpy as np
import numpy.typing as npt

from elemental.core.layout import layouts
from elemental.gpu.device import Device
from gpu.voxel.scenes import jumble
from gpu.voxel.stage import Stage

Array = npt.NDArray[Any]


def contents(stage: Stage) -> dict[str, bytes]:
    """What each pool holds, but for what lies beyond its last brick."""
    counts, octree = stage.counts, stage.octree

    def used(name: str, bricks: int, brick_bytes: int) -> bytes:
        return bytes(getattr(octree, name).read(np.uint8, bricks * brick_bytes).tobytes())

    nodes = stage.own_grid.dense_nodes + 8 * counts.tiles
    brick_bytes = layouts().struct("Brick").itemsize
    attribute_bytes = layouts().struct("VoxelAttributes").itemsize
    return {
        "nodes": used("nodes", nodes, layouts().struct("Node").itemsize),
        "bricks": used("bricks", counts.bricks, brick_bytes),
        "attributes": used("attributes", counts.leaves, 8 * attribute_bytes),
        "radiance": used("radiance", counts.leaves, 8 * 4),
        "sides": octree.atlas.read().tobytes(),
        "leaf colors": octree.leaf_colors.read().tobytes(),
        "leaf normals": octree.leaf_normals.read().tobytes(),
    }


def digest(stage: Stage) -> str:
    """All of it as one word."""
    return hashlib.sha256(b"".join(contents(stage).values())).hexdigest()


if __name__ == "__main__":
    made = Device.headless()
    print(digest(Stage(made, jumble())))
