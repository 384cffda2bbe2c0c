"""The camera of a frame as the uniform block View."""

from __future__ import annotations

import math

import numpy as np

from elemental.core import transforms
from elemental.core.layout import Block, layouts, pack
from elemental.scene.model import Camera, FloatArray

FAR_MARGIN = 1.01
"""How much farther than the scene's farthest corner an open far plane lies."""
LARGEST_RANGE = 1e6
"""far / near that still leaves a 24 bit depth buffer something to tell apart [inferred]."""


_HIGH = np.indices((2, 2, 2)).reshape(3, 8).T.astype(bool)
"""(8, 3) which of a box's two ends each of its corners has."""


def box_corners(low: FloatArray, high: FloatArray) -> FloatArray:
    """(8, 3) float32 corners of the box low..high."""
    return np.where(_HIGH, high, low).astype(np.float32)


def clip_range(camera: Camera, bounds: tuple[FloatArray, FloatArray]) -> tuple[float, float]:
    """(near, far) in m: the camera's planes, the far one just behind the scene where it has none.

    Where they are too far apart to tell depths, they are brought to what holds the scene.
    """
    if camera.far is not None and camera.far <= LARGEST_RANGE * camera.near:
        return camera.near, camera.far
    view_from_world = transforms.inverse(camera.world_from_view)
    corners = transforms.transform_points(view_from_world, box_corners(*bounds))
    farthest = float(-corners[:, 2].min()) * FAR_MARGIN
    far = min(max(farthest, 10.0 * camera.near), camera.far or math.inf)
    return max(camera.near, far / LARGEST_RANGE), far


def pack_view(
    camera: Camera,
    size: tuple[int, int],
    bounds: tuple[FloatArray, FloatArray],
    *,
    exposure: float = 1.0,
    time_s: float = 0.0,
    frame: int = 0,
    indirect: tuple[float, float, float] = (1.0, 1.0, 1.0),
    subsurface_reach: float = 0.03,
) -> Block:
    """The block View of glsl/shared/view.glsl. size: (width, height) px; exposure: a factor;
    indirect: factors on the indirect light that surfaces receive; subsurface_reach: m."""
    width, height = size
    near, far = clip_range(camera, bounds)
    view_from_world = transforms.inverse(camera.world_from_view)
    clip_from_view = transforms.perspective(camera.fov_y, width / height, near, far)
    return pack(
        layouts().block("View"),
        clip_from_world=clip_from_view @ view_from_world,
        world_from_clip=camera.world_from_view @ np.linalg.inv(clip_from_view.astype(np.float64)),
        view_from_world=view_from_world,
        world_from_view=camera.world_from_view,
        viewport_px=(width, height, 1.0 / width, 1.0 / height),
        eye_ws=camera.world_from_view[:3, 3],
        exposure=exposure,
        near=near,
        far=far,
        time_s=time_s,
        frame=frame,
        indirect=indirect,
        subsurface_reach=subsurface_reach,
    )
