"""Transforms against closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest

from elemental.core import transforms

HALF = math.sqrt(0.5)


def test_rotation_is_for_column_vectors() -> None:
    quarter_about_z = transforms.rotation([0.0, 0.0, HALF, HALF])
    turned = transforms.transform_points(quarter_about_z, np.array([[1.0, 0.0, 0.0]]))
    np.testing.assert_allclose(turned, [[0.0, 1.0, 0.0]], atol=1e-7)


def test_compose_scales_then_rotates_then_translates() -> None:
    m = transforms.compose([10.0, 0.0, 0.0], [0.0, 0.0, HALF, HALF], [2.0, 3.0, 4.0])
    moved = transforms.transform_points(m, np.array([[1.0, 1.0, 1.0]]))
    np.testing.assert_allclose(moved, [[10.0 - 3.0, 2.0, 4.0]], atol=1e-6)
    assert m.dtype == np.float32
    assert m.flags.c_contiguous


def test_look_at_puts_the_target_on_minus_z() -> None:
    eye, target = np.array([1.0, 2.0, 3.0]), np.array([4.0, -2.0, 3.0])
    view_from_world = transforms.look_at(eye, target)
    points = transforms.transform_points(view_from_world, np.stack([eye, target]))
    np.testing.assert_allclose(points, [[0.0, 0.0, 0.0], [0.0, 0.0, -5.0]], atol=1e-6)
    assert np.linalg.det(view_from_world[:3, :3]) == pytest.approx(1.0)
    up = transforms.transform_vectors(view_from_world, np.array([[0.0, 1.0, 0.0]]))[0]
    assert up[1] > 0.0
    assert up[0] == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("direction", [(0.0, -1.0, 0.0), (0.0, 7.0, 0.0), (1e-6, -1.0, 0.0)])
def test_look_at_along_up_is_still_a_rotation(direction: tuple[float, float, float]) -> None:
    m = transforms.look_at([0.0, 0.0, 0.0], direction)
    np.testing.assert_allclose(m[:3, :3] @ m[:3, :3].T, np.eye(3), atol=1e-6)


def test_look_at_refuses_one_point() -> None:
    with pytest.raises(ValueError, match="coincide"):
        transforms.look_at([1, 2, 3], [1, 2, 3])


def test_perspective_maps_the_frustum_to_the_cube() -> None:
    fov_y, aspect, near, far = 1.0, 1.5, 0.5, 40.0
    clip_from_view = transforms.perspective(fov_y, aspect, near, far)
    top = math.tan(fov_y / 2)
    corners = [
        [near * top * aspect, near * top, -near],
        [-far * top * aspect, -far * top, -far],
    ]
    mapped = transforms.transform_points(clip_from_view, np.array(corners))
    np.testing.assert_allclose(mapped, [[1, 1, -1], [-1, -1, 1]], atol=1e-5)


def test_infinite_perspective_is_the_limit() -> None:
    limit = transforms.perspective(1.0, 1.5, 0.5)
    np.testing.assert_allclose(transforms.perspective(1.0, 1.5, 0.5, 1e9), limit, atol=1e-6)


def test_orthographic_maps_its_box_to_the_cube() -> None:
    clip_from_view = transforms.orthographic(-1, 3, 2, 4, 1, 11)
    mapped = transforms.transform_points(clip_from_view, np.array([[-1, 2, -1], [3, 4, -11]]))
    np.testing.assert_allclose(mapped, [[-1, -1, -1], [1, 1, 1]], atol=1e-6)


def test_normal_matrix_keeps_normals_perpendicular() -> None:
    m = transforms.compose([1, 2, 3], [0.1, 0.2, 0.3, 0.9], [1.0, 5.0, -0.2])
    normal, tangent = np.array([1.0, 2.0, 3.0]), np.array([3.0, 0.0, -1.0])
    moved = transforms.transform_vectors(m, tangent[None])[0]
    assert float(transforms.normal_matrix(m) @ normal @ moved) == pytest.approx(0.0, abs=1e-5)


def test_inverse() -> None:
    m = transforms.compose([1, 2, 3], [0.1, 0.2, 0.3, 0.9], [1.0, 5.0, -0.2])
    np.testing.assert_allclose(transforms.inverse(m) @ m, np.eye(4), atol=1e-5)
