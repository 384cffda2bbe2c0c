"""Skinning, morphing and the boxes around what bends, against closed forms and brute force."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from elemental.core import transforms
from elemental.scene.boxes import MeshBoxes
from elemental.scene.deform import deformed
from elemental.scene.model import Mesh
from elemental.scene.motion import Influences, Morphs
from gpu.rig import IDENTITY, at, mesh, vector
from shapes import sphere

Array = npt.NDArray[Any]
QUARTER_Z = [0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5)]


def ball(seed: int = 0, joints: int = 3, targets: int = 2) -> Mesh:
    """A sphere of which each vertex hangs on random joints and moves with random targets."""
    rng = np.random.default_rng(seed)
    made = mesh(sphere(rings=6), smooth=True)
    count = len(made.positions)
    weights = rng.random((count, 4)) * (rng.random((count, 4)) < 0.6)
    weights[:, 0] += 0.1
    weights /= weights.sum(axis=1, keepdims=True)
    influences = Influences(
        rng.integers(0, joints, (count, 4)).astype(np.int32), weights.astype(np.float32)
    )
    deltas = rng.normal(0, 0.2, (3, targets, count, 3)).astype(np.float32)
    return replace(made, influences=influences, morphs=Morphs(*deltas))


def placements(seed: int, count: int) -> Array:
    rng = np.random.default_rng(seed)
    return np.array(
        [
            transforms.compose(rng.normal(0, 2, 3), rng.normal(0, 1, 4), rng.uniform(0.5, 2.0, 3))
            for _ in range(count)
        ],
        np.float32,
    )


def held_by(joint: int, count: int) -> Influences:
    weights = np.tile(np.array([1, 0, 0, 0], np.float32), (count, 1))
    return Influences(np.full((count, 4), joint, np.int32), weights)


def test_a_vertex_of_one_joint_goes_where_the_joint_goes() -> None:
    plain = mesh(sphere(rings=4), smooth=True)
    bound = replace(plain, influences=held_by(1, len(plain.positions)))
    joints = placements(3, 2)
    got = deformed(bound, joints, None)
    expected = transforms.transform_points(joints[1], plain.positions)
    np.testing.assert_allclose(got.positions, expected, atol=1e-5)
    normals = plain.normals @ transforms.normal_matrix(joints[1]).T
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    np.testing.assert_allclose(got.normals, normals, atol=1e-5)
    tangents = transforms.transform_vectors(joints[1], plain.tangents[:, :3])
    tangents /= np.linalg.norm(tangents, axis=1, keepdims=True)
    np.testing.assert_allclose(got.tangents[:, :3], tangents, atol=1e-5)
    assert got.influences is got.morphs is None


def test_half_of_each_joint_is_half_way_between_them() -> None:
    plain = mesh(sphere(rings=4), smooth=True)
    count = len(plain.positions)
    halves = Influences(
        np.tile(np.array([0, 1], np.int32), (count, 1)), np.full((count, 2), 0.5, np.float32)
    )
    got = deformed(replace(plain, influences=halves), np.array([at(0, 0, 0), at(2, 4, 6)]), None)
    np.testing.assert_allclose(got.positions, plain.positions + vector(1, 2, 3), atol=1e-6)
    np.testing.assert_allclose(got.normals, plain.normals, atol=1e-6)


def test_a_mirrored_joint_keeps_normals_outside() -> None:
    plain = mesh(sphere(rings=4), smooth=True)
    bound = replace(plain, influences=held_by(0, len(plain.positions)))
    mirror = np.diag([-1.0, 2.0, 1.0, 1.0])[None]
    got = deformed(bound, mirror, None)
    assert ((got.normals * got.positions).sum(axis=1) > 0.0).all()


def test_morph_targets_add_up_before_the_skin() -> None:
    body = ball()
    morphs, weights = body.morphs, np.array([0.25, -1.5], np.float32)
    assert morphs is not None
    got = deformed(body, None, weights)
    expected = body.positions + 0.25 * morphs.positions[0] - 1.5 * morphs.positions[1]
    np.testing.assert_allclose(got.positions, expected, atol=1e-6)
    normals = body.normals + 0.25 * morphs.normals[0] - 1.5 * morphs.normals[1]
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    np.testing.assert_allclose(got.normals, normals, atol=1e-6)
    quarter = transforms.compose([0, 0, 0], QUARTER_Z, [1, 1, 1])
    turned = deformed(body, np.array([quarter] * 3), weights)
    np.testing.assert_allclose(turned.positions, expected @ quarter[:3, :3].T, atol=1e-5)


@pytest.mark.parametrize("bends", [False, True])
def test_boxes_hold_what_moves_and_hardly_more(bends: bool) -> None:
    body = ball() if bends else mesh(sphere(rings=6), smooth=True)
    boxes = MeshBoxes(body)
    for seed in range(20):
        rng = np.random.default_rng(seed)
        worlds = placements(seed, 2)
        joints = placements(seed + 50, 6).reshape(2, 3, 4, 4) if bends else None
        weights = rng.normal(0, 1, (2, 2)).astype(np.float32) if bends else None
        low, high = boxes.around(worlds, joints, weights)
        points = []
        for s in range(2):
            shape = deformed(
                body, None if joints is None else joints[s], None if weights is None else weights[s]
            )
            placed = IDENTITY if bends else worlds[s]
            points.append(transforms.transform_points(placed, shape.positions))
        reached = np.concatenate(points)
        assert (reached.min(axis=0) >= low - 1e-5).all()
        assert (reached.max(axis=0) <= high + 1e-5).all()
        # A ball turned in its box: at most sqrt(3) too large; joints and targets add their own.
        assert ((high - low) <= np.ptp(reached, axis=0) * (6.0 if bends else 1.9)).all()
