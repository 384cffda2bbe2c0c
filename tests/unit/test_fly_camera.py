"""The fly camera: where keys and mouse take it."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from elemental.core import transforms
from elemental.scene.model import Camera
from elemental.ui.fly_camera import LEAST_NEAR, MAX_PITCH, SPEED_PER_NOTCH, SPEED_RANGE, FlyCamera


def camera_at(eye: tuple[float, float, float], target: tuple[float, float, float]) -> Camera:
    view_from_world = transforms.look_at(eye, target)
    return Camera("c", transforms.inverse(view_from_world), math.radians(45), 0.1, 100.0)


def standing() -> FlyCamera:
    """At the origin, looking along -z, 1 m/s in a scene of 10 m."""
    return FlyCamera.at(camera_at((0, 0, 0), (0, 0, -1)), 10.0)


COORDINATE = st.floats(-100, 100)


@given(st.tuples(COORDINATE, COORDINATE, COORDINATE), st.floats(-3, 3), st.floats(-1.5, 1.5))
def test_it_stands_where_the_camera_stood(
    eye: tuple[float, float, float], yaw: float, pitch: float
) -> None:
    fly = FlyCamera(np.array(eye), yaw, pitch, 1.0, 10.0, camera_at((0, 0, 0), (0, 0, -1)))
    taken = FlyCamera.at(fly.camera(), 10.0)
    np.testing.assert_allclose(taken.position, eye, atol=1e-4)
    np.testing.assert_allclose(taken.axes(), fly.axes(), atol=2e-4)
    np.testing.assert_allclose(taken.camera().world_from_view, fly.camera().world_from_view,
                               atol=1e-3)  # fmt: skip


def test_who_flies_slowly_sees_what_is_near() -> None:
    fly = standing()
    assert fly.camera().near == 0.1
    fly.scroll(5.0)
    assert fly.camera().near == 0.1  # flying fast hides nothing
    fly.scroll(-9.0)
    assert fly.camera().near == pytest.approx(0.1 * SPEED_PER_NOTCH**-4)
    fly.scroll(-1e3)
    assert fly.camera().near == pytest.approx(0.1 * LEAST_NEAR)  # at the slowest


@pytest.mark.parametrize("y", [1.0, -1.0])
def test_a_camera_that_looks_along_y_keeps_its_image_upright(y: float) -> None:
    camera = camera_at((0, 0, 0), (0, y, 0))
    fly = FlyCamera.at(camera, 10.0)
    assert fly.pitch == pytest.approx(y * MAX_PITCH)
    up = camera.world_from_view[:3, 1]
    assert float(fly.axes()[1] @ up) > 0.99


@pytest.mark.parametrize(
    ("move", "place"),
    [
        ((1, 0, 0), (1, 0, 0)),
        ((0, 1, 0), (0, 1, 0)),
        ((0, 0, 1), (0, 0, -1)),
        ((1, 0, 1), (math.sqrt(0.5), 0, -math.sqrt(0.5))),
        ((0, 0, -1), (0, 0, 1)),
        ((0, 0, 0), (0, 0, 0)),
    ],
)
def test_a_second_of_flight(move: tuple[int, int, int], place: tuple[float, ...]) -> None:
    fly = standing()
    fly.fly(*move, seconds=1.0)
    np.testing.assert_allclose(fly.position, place, atol=1e-9)


@given(st.floats(0.001, 1.0), st.integers(1, 20))
def test_the_way_does_not_depend_on_the_frame_rate(seconds: float, frames: int) -> None:
    whole, parts = standing(), standing()
    whole.fly(1, 0, 1, seconds)
    for _ in range(frames):
        parts.fly(1, 0, 1, seconds / frames)
    np.testing.assert_allclose(whole.position, parts.position, atol=1e-9)


def test_the_mouse_turns_right_and_down() -> None:
    fly = standing()
    fly.look(100, 50)
    forward = fly.axes()[2]
    assert forward[0] > 0.2
    assert forward[1] < -0.1


@given(st.lists(st.tuples(st.floats(-1e4, 1e4), st.floats(-1e4, 1e4)), max_size=20))
def test_no_way_of_the_mouse_breaks_the_axes(ways: list[tuple[float, float]]) -> None:
    fly = standing()
    for right, down in ways:
        fly.look(right, down)
    axes = fly.axes()
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-9)
    assert axes[1][1] > 0  # never upside down
    assert np.isfinite(fly.camera().world_from_view).all()


@given(st.lists(st.floats(-1e6, 1e6), max_size=10))
def test_the_wheel_keeps_the_speed_in_range(notches: list[float]) -> None:
    fly = standing()
    for notch in notches:
        fly.scroll(notch)
    assert 10 * SPEED_RANGE[0] <= fly.speed <= 10 * SPEED_RANGE[1]
    faster = fly.speed
    fly.scroll(1.0)
    assert fly.speed >= faster
