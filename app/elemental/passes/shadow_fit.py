"""Where each light's shadow maps look: matrices by light, scene bounds and camera. No GL here."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from elemental.core import transforms
from elemental.passes.camera_view import box_corners
from elemental.scene.model import FloatArray, Light

RIM_TEXELS = 4
"""Texels at a map's rim that a receiver's filter and offset need, SHADOW_CASCADE_MARGIN."""
SPLIT_BLEND = 0.8
"""Weight of the logarithmic against the even split of the view's depth [Zhang06 "Parallel-Split
Shadow Maps"]."""
NEAR_OVER_FAR = 2e-3
"""Near plane of a spot or point light's view as a part of its reach [inferred]."""
DEPTH_BIAS = 2e-6
"""Rounding of a depth computed twice, in units of the depth buffer: some 32 float32 steps at 1."""
NEAR_OVER_SIZE = 0.02
"""Of an area light's size, which its near plane is at most: a scene may reach 1000 times as far."""
EMITTER_BIAS = 5e-7
"""`DEPTH_BIAS` of area lights: eight steps. At 0.02 of their size it stays below 0.4 texels of 256
a side, which their filter allows, up to 120 times the size away."""
LEAST_NEAR_OVER_FAR = 20.0 * EMITTER_BIAS
"""Nearer, the bias would push the far plane beyond infinity."""
NEARS_REACHED = 4000.0
"""Where no reach is set, cascades end so many near planes away: four diagonals of a scene that is
seen whole (`FRAMING_NEAR`), 300 m seen from 7 m away in one of 10 km (`EYE_NEAR`) [inferred]."""
STABLE_STEPS = 4.0
"""Cascades keep their size until it changes by 2^(1/4), so that a moving camera does not make the
shadow's edge crawl [inferred]."""

POINT_FACES = (
    ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0)),
    ((-1.0, 0.0, 0.0), (0.0, 1.0, 0.0)),
    ((0.0, 1.0, 0.0), (0.0, 0.0, 1.0)),
    ((0.0, -1.0, 0.0), (0.0, 0.0, 1.0)),
    ((0.0, 0.0, 1.0), (0.0, 1.0, 0.0)),
    ((0.0, 0.0, -1.0), (0.0, 1.0, 0.0)),
)
"""(direction, up) of a point light's views, in the order of `cube_face` in glsl/lib/shadow.glsl."""

Bounds = tuple[FloatArray, FloatArray]


@dataclass(frozen=True)
class Cut:
    """What casts no shadow: all at `heights` (lowest, highest) m over a plane (unit normal, offset)
    and all in a ball (centre, radius)."""

    plane: tuple[float, ...] = (0.0, 0.0, 0.0, 0.0)
    heights: tuple[float, float] = (1.0, 1.0)
    ball: tuple[float, ...] = (0.0, 0.0, 0.0, 0.0)


SEES_ALL = Cut()


@dataclass(frozen=True)
class FittedView:
    """One shadow view: clip_from_world (4, 4), the width of a texel at a clip w of 1, in m, the
    near and the far plane in m, what it does not see, and the rounding of its depths."""

    clip_from_world: FloatArray
    texel: float
    depth_range: tuple[float, float]
    cut: Cut = SEES_ALL
    depth_bias: float = DEPTH_BIAS


@dataclass(frozen=True)
class ViewFrustum:
    """What cascades need of the camera: eye (3,), forward (3,) unit, near and far in m, and the
    tangents of the half angles to the picture's upper rim and to its corner."""

    eye: FloatArray
    forward: FloatArray
    near: float
    far: float
    tangent: float
    corner_tangent: float


def scene_view(light: Light, bounds: Bounds, resolution: int) -> FittedView:
    """A directional light's view of the whole scene; it depends on nothing else."""
    view_from_world = _light_rotation(light)
    corners = transforms.transform_points(view_from_world, box_corners(*bounds))
    low, high = corners.min(axis=0), corners.max(axis=0)
    center = (low + high) / 2
    half = np.maximum((high - low)[:2].max() / 2, 1e-6) / rim_scale(resolution)
    return _ortho(view_from_world, center[:2], float(half), corners[:, 2], resolution)


def cascade_views(
    light: Light,
    bounds: Bounds,
    frustum: ViewFrustum,
    *,
    count: int,
    reach: float,
    resolution: int,
) -> list[FittedView]:
    """`count` views along the camera's, the nearest first, that reach `reach` m.

    Each bounds a slice of the frustum by a sphere, so turning the camera does not resize it, and
    moves by whole texels. [Zhang06], [Valient07 "Stable Rendering of Cascaded Shadow Maps"]
    """
    view_from_world = _light_rotation(light)
    corners = transforms.transform_points(view_from_world, box_corners(*bounds))
    views = []
    for near, far in _splits(frustum.near, min(frustum.far, reach), count):
        center_ws, radius = _slice_sphere(frustum, near, far)
        radius = 2.0 ** (math.ceil(math.log2(radius) * STABLE_STEPS) / STABLE_STEPS)
        half = radius / rim_scale(resolution)
        texel = 2.0 * half / resolution
        center = transforms.transform_points(view_from_world, center_ws[None])[0, :2]
        snapped = np.floor(center / texel) * texel
        views.append(_ortho(view_from_world, snapped, half, corners[:, 2], resolution))
    return views


def open_reach(bounds: Bounds, near: float) -> float:
    """How far in m cascades go where no reach is set: the scene's diagonal, but in a large scene
    seen from close by only as far as near things keep fine shadows."""
    return min(float(np.linalg.norm(bounds[1] - bounds[0])), NEARS_REACHED * near)


def spot_view(light: Light, bounds: Bounds, resolution: int) -> FittedView:
    """A spot light's view: its outer cone, widened by the rim."""
    tangent = math.tan(min(light.outer_angle, math.radians(85.0))) / rim_scale(resolution)
    position = light.position.astype(np.float64)  # far away, a step of 1 m is none in 32 bits
    rotation = transforms.look_at(position, position + light.direction)
    return _perspective(position, light.range, rotation, tangent, bounds, resolution)


def point_views(light: Light, bounds: Bounds, resolution: int) -> list[FittedView]:
    """A point light's six views, each a right angle widened by the rim."""
    tangent = 1.0 / rim_scale(resolution)
    position = light.position.astype(np.float64)
    return [
        _perspective(
            position,
            light.range,
            transforms.look_at(position, position + np.array(direction), up),
            tangent,
            bounds,
            resolution,
        )
        for direction, up in POINT_FACES
    ]


def rim_scale(resolution: int) -> float:
    """Share of a map's width that is left inside the rim."""
    return 1.0 - 2.0 * RIM_TEXELS / resolution


def _light_rotation(light: Light) -> FloatArray:
    return _rotation(*light.direction.tolist())


@lru_cache(maxsize=64)
def _rotation(x: float, y: float, z: float) -> FloatArray:
    """view_from_world along a direction: a sun's is asked for in each frame."""
    found = transforms.look_at((0.0, 0.0, 0.0), (x, y, z))
    found.flags.writeable = False
    return found


def _ortho(
    view_from_world: FloatArray,
    center: FloatArray,
    half: float,
    depths: FloatArray,
    resolution: int,
) -> FittedView:
    """A square box about `center` that holds every caster; `depths`: the scene's z there."""
    near, far = -float(depths.max()), -float(depths.min())
    slack = 1e-3 * max(far - near, half)
    x, y = float(center[0]), float(center[1])
    depth_range = near - slack, far + slack
    clip_from_view = transforms.orthographic(x - half, x + half, y - half, y + half, *depth_range)
    return FittedView(clip_from_view @ view_from_world, 2.0 * half / resolution, depth_range)


def emitter_view(
    position: npt.NDArray[np.float64],
    size_m: float,
    view_from_world: FloatArray,
    bounds: Bounds,
    resolution: int,
    cut: Cut,
) -> FittedView:
    """A right angle widened by the rim, from a position (3,) on an area light of a size."""
    far = _far(position, math.inf, bounds)
    near = min(NEAR_OVER_FAR * far, max(NEAR_OVER_SIZE * size_m, LEAST_NEAR_OVER_FAR * far))
    tangent = 1.0 / rim_scale(resolution)
    made = _square(view_from_world, tangent, (near, far), resolution)
    return replace(made, cut=cut, depth_bias=EMITTER_BIAS)


def _perspective(
    position: npt.NDArray[np.float64],
    range_m: float,
    view_from_world: FloatArray,
    tangent: float,
    bounds: Bounds,
    resolution: int,
) -> FittedView:
    """That of a square picture from a position (3,), as far as the scene or the range goes."""
    far = _far(position, range_m, bounds)
    return _square(view_from_world, tangent, (NEAR_OVER_FAR * far, far), resolution)


def _far(position: npt.NDArray[np.float64], range_m: float, bounds: Bounds) -> float:
    corners = box_corners(*bounds)
    farthest = float(np.linalg.norm(corners - position, axis=1).max())
    return max(min(range_m, farthest) * 1.001, 1e-6)


def _square(
    view_from_world: FloatArray, tangent: float, depth_range: tuple[float, float], resolution: int
) -> FittedView:
    """tangent: of half the angle that it spans."""
    clip_from_view = transforms.perspective(2.0 * math.atan(tangent), 1.0, *depth_range)
    return FittedView(clip_from_view @ view_from_world, 2.0 * tangent / resolution, depth_range)


def _splits(near: float, far: float, count: int) -> Sequence[tuple[float, float]]:
    """Depth ranges of `count` slices between near and far, in m."""
    far = max(far, near * 1.001)
    steps = np.arange(count + 1) / count
    logarithmic = near * (far / near) ** steps
    even = near + (far - near) * steps
    edges = SPLIT_BLEND * logarithmic + (1.0 - SPLIT_BLEND) * even
    return [(float(a), float(b)) for a, b in pairwise(edges)]


def _slice_sphere(frustum: ViewFrustum, near: float, far: float) -> tuple[FloatArray, float]:
    """(centre (3,), radius) of the smallest sphere on the axis around a slice of the frustum."""
    squared = frustum.corner_tangent**2
    depth = min((near + far) * (1.0 + squared) / 2.0, far)
    radius = math.hypot(far - depth, far * frustum.corner_tangent)
    return frustum.eye + frustum.forward * np.float32(depth), radius
