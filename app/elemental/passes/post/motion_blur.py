"""Motion blur of the camera's and of moving meshes' motion since the frame before. [McGuire12]

Meshes that bend move with their place, not with their joints: the vertices of the frame before are
not kept.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from elemental.core.layout import Block, layouts, pack
from elemental.gpu.encode import Encoder
from elemental.gpu.formats import RG16F, RGBA16F
from elemental.gpu.graph import Graph
from elemental.gpu.refs import AnyTexture, TextureHandle
from elemental.gpu.shaders import Raster
from elemental.gpu.state import RasterState
from elemental.passes.post.scale import TRIANGLE
from elemental.passes.scene_gpu import GpuScene
from elemental.passes.scene_pack import SOLID
from elemental.passes.view_draws import CAMERA as SEEN

CAMERA = Raster(TRIANGLE, "post/motion_camera.frag.glsl")
OBJECTS = Raster("post/motion_objects.vert.glsl", "post/motion_objects.frag.glsl")
LONGEST = [
    Raster(TRIANGLE, "post/motion_longest.frag.glsl", defines={"AXIS": axis}) for axis in (0, 1)
]
"""Along a tile's row, and down its column."""
BLUR = Raster(TRIANGLE, "post/motion_blur.frag.glsl")
VISIBLE = RasterState(depth_test="equal", depth_write=False, color_mask=(True, True, False, False))
"""What the G-buffer shows; the depth along the view stays."""


def motion_blur(
    g: Graph,
    view: Block,
    before: Block | None,
    picture: TextureHandle,
    depth: AnyTexture,
    s: Mapping[str, Any],
    scene: GpuScene | None = None,
) -> TextureHandle:
    """Radiance (H, W) RGBA16F with the streaks of what moved since the view ``before``.

    ``scene``: whose moving instances have streaks of their own. ``picture`` itself where it is
    off, where there is no frame before, and where nothing can have moved.
    """
    if before is None or s["motion_blur.amount"] == 0.0 or s["motion_blur.max"] == 0.0:
        return picture
    moves = scene is not None and bool(scene.batches(SOLID, dynamic=True))
    if not moves and np.array_equal(view["clip_from_world"], before["clip_from_world"]):
        return picture
    block = _block(before, s, picture.width)
    motion = g.texture("motion", size=picture.size, format=RGBA16F)
    params = {"View": view, "Motion": block}
    g.raster(CAMERA, color=motion, reads={"u_depth": depth}, params=params)
    if scene is not None and moves:
        moving = scene

        def draw(enc: Encoder) -> None:
            moving.draw_positions(enc, SOLID, dynamic=True, seen_by=SEEN)

        g.raster(
            OBJECTS,
            color=motion,
            depth=depth,
            reads={"u_instances": scene.instances},
            params=params,
            state=VISIBLE,
            draw=draw,
            uses=scene.uses(SEEN),
        )
    return _blur(g, picture, motion, block)


def _blur(g: Graph, picture: TextureHandle, motion: TextureHandle, block: Block) -> TextureHandle:
    longest = longest_streaks(g, motion, block)
    blurred = g.texture("motion_blur", like=picture)
    g.raster(
        BLUR,
        color=blurred,
        reads={"u_picture": picture, "u_motion_px": motion, "u_longest": longest},
        params={"Motion": block},
    )
    return blurred


def longest_streaks(g: Graph, motion: AnyTexture, block: Block) -> AnyTexture:
    """Of each tile of ``motion`` (H, W), the streak that is longest: one texel a tile, RG16F."""
    tile, (width, height) = int(block["tile"]), motion.size[:2]
    columns, rows = -(-width // tile), -(-height // tile)
    longest = motion
    rows_first = ((1, "longest_rows", (width, rows)), (0, "longest", (columns, rows)))
    for axis, name, size in rows_first:  # threads side by side read so
        along, longest = longest, g.texture(f"motion.{name}", size=size, format=RG16F)
        g.raster(
            LONGEST[axis],
            f"post/motion_longest.{'xy'[axis]}",
            color=longest,
            reads={"u_motion_px": along},
            params={"Motion": block},
        )
    return longest


def _block(before: Block, s: Mapping[str, Any], width: int) -> Block:
    most_px = 0.5 * s["motion_blur.max"] / 100.0 * width
    return pack(
        layouts().block("Motion"),
        prev_clip_from_world=np.asarray(before["clip_from_world"]).T,
        shutter=s["motion_blur.amount"],
        most_px=most_px,
        tile=max(math.ceil(most_px), 1),
    )
