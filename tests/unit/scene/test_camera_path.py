"""Cameras that move along a path."""

from __future__ import annotations

import numpy as np
import pytest

from elemental.scene.camera_path import camera_at
from elemental.scene.model import CameraPath

TIMES = np.array([0.0, 1.0, 3.0, 4.0])


def path(eyes: np.ndarray, loop: bool = False) -> CameraPath:
    targets = eyes + np.array([0, 0, -1])
    return CameraPath(TIMES, eyes.astype("f4"), targets.astype("f4"), 0.8, 0.1, loop)


def eye(moving: CameraPath, t: float) -> np.ndarray:
    return camera_at(moving, t).world_from_view[:3, 3]


def test_keys_are_met_and_straight_motion_is_even() -> None:
    line = path(TIMES[:, None] * np.array([2.0, 0.0, 1.0]))
    for t in (0.0, 0.3, 1.0, 2.2, 3.0, 3.9, 4.0):
        np.testing.assert_allclose(eye(line, t), [2 * t, 0, t], atol=1e-5)
    camera = camera_at(line, 0.5)
    assert (camera.fov_y, camera.near) == (0.8, 0.1)
    np.testing.assert_allclose(camera.world_from_view[:3, :3], np.eye(3), atol=1e-5)


def test_the_camera_rests_at_the_ends() -> None:
    line = path(TIMES[:, None] * np.array([1.0, 0.0, 0.0]))
    np.testing.assert_allclose(eye(line, -5.0), [0, 0, 0], atol=1e-6)
    np.testing.assert_allclose(eye(line, 50.0), [4, 0, 0], atol=1e-6)


def test_motion_has_no_kinks() -> None:
    bent = np.array([[0, 0, 0], [1, 2, 0], [3, 1, 1], [0, 0, 0]], float)
    for loop in (False, True):
        moving = path(bent, loop)
        for t in (1.0, 3.0, *([4.0] if loop else [])):
            h = 1e-3
            before = (eye(moving, t) - eye(moving, t - h)) / h
            after = (eye(moving, t + h) - eye(moving, t)) / h
            np.testing.assert_allclose(before, after, atol=2e-2)


def test_a_loop_repeats() -> None:
    bent = np.array([[0, 0, 0], [1, 2, 0], [3, 1, 1], [0, 0, 0]], float)
    moving = path(bent, loop=True)
    for t in (0.2, 1.7, 3.5):
        assert eye(moving, t) == pytest.approx(eye(moving, t + 8.0), abs=1e-5)
