"""The block View: clip planes that a depth buffer can tell apart, matrices that can be inverted."""

from __future__ import annotations

import numpy as np
import pytest

from elemental.core import transforms
from elemental.passes.camera_view import LARGEST_RANGE, clip_range, pack_view
from elemental.scene.model import Camera

LOW, HIGH = np.full(3, -1.0, np.float32), np.full(3, 1.0, np.float32)
BOUNDS = (LOW, HIGH)


def camera(near: float, far: float | None, distance: float = 4.0) -> Camera:
    view_from_world = transforms.look_at((0, 0, distance), (0, 0, 0))
    return Camera("test", transforms.inverse(view_from_world), 0.7, near, far)


def test_planes_are_the_cameras_or_just_hold_the_scene() -> None:
    assert clip_range(camera(0.1, 20.0), BOUNDS) == (0.1, 20.0)
    near, far = clip_range(camera(0.1, None), BOUNDS)
    assert (near, far) == (0.1, pytest.approx(5.0 * 1.01))


@pytest.mark.parametrize("far", [None, 1e30, 5.5])
def test_planes_too_far_apart_are_brought_to_the_scene(far: float | None) -> None:
    near, end = clip_range(camera(1e-30, far), BOUNDS)
    assert end == pytest.approx(5.0 * 1.01)
    assert near == pytest.approx(end / LARGEST_RANGE)


def test_matrices_invert_far_from_the_origin() -> None:
    seen = camera(1e-4, 100.0, distance=5000.0)  # its clip matrix is singular in 32 bits
    view = pack_view(seen, (32, 18), BOUNDS)
    world_from_clip = view["world_from_clip"].reshape(4, 4).T.astype(np.float64)
    clip_from_view = transforms.perspective(seen.fov_y, 32 / 18, seen.near, 100.0)
    point_vs = np.array([1.0, 2.0, -10.0, 1.0])
    point = world_from_clip @ clip_from_view.astype(np.float64) @ point_vs
    np.testing.assert_allclose(point[:3] / point[3], [1.0, 2.0, 4990.0], rtol=1e-2)
