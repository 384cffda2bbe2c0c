"""Skinned meshes of glTF files: where their joints place them."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from gltf_builder import GltfBuilder
from unit.scene.gltf_motion import (
    BENT,
    TRIANGLE,
    TWO,
    UP,
    bent_strip,
    corners,
)


def test_joints_place_a_skinned_mesh_and_its_node_does_not(tmp_path: Path) -> None:
    scene = bent_strip().load(tmp_path)
    assert (scene.instances[0].dynamic, scene.instances[0].skin) == (True, 0)
    flat = [[0, 0, 0], [1, 0, 0], [0, 2, 0], [1, 2, 0]]
    order = [0, 1, 2, 2, 1, 3]
    np.testing.assert_allclose(corners(scene, 0.0), np.array(flat)[order], atol=1e-6)
    end = float(np.nextafter(2.0, 0.0))
    np.testing.assert_allclose(corners(scene, end), np.array(BENT)[order], atol=1e-6)
    low, high = scene.bounds()
    assert low[0] < -1.0
    assert high[0] < 3.0


def test_a_skin_that_never_moves_is_placed_for_good(tmp_path: Path) -> None:
    scene = bent_strip(animated=False).load(tmp_path)
    assert scene.motion is None
    assert [i.dynamic for i in scene.instances] == [False]
    assert len(scene.meshes) == 1
    assert scene.meshes[0].influences is None
    got = scene.meshes[0].positions
    np.testing.assert_allclose(got, BENT, atol=1e-6)


def test_eight_joints_a_vertex(tmp_path: Path) -> None:
    builder = GltfBuilder()
    primitive = builder.primitive(TRIANGLE, normals=UP)
    builder.skinned(primitive, np.tile([0, 1, 2, 3], (3, 1)), np.full((3, 4), 0.125))
    builder.skinned(primitive, np.tile([4, 5, 6, 7], (3, 1)), np.full((3, 4), 0.125), number=1)
    joints = [builder.node(translation=[k, 0, 0]) for k in range(8)]
    builder.node(mesh=builder.mesh(primitive), skin=builder.skin(joints))
    builder.animation((joints[7], "translation", TWO, [[7, 0, 0], [15, 0, 0]]))
    scene = builder.load(tmp_path)
    np.testing.assert_allclose(corners(scene, 1.0)[:, 0] - TRIANGLE[:, 0], 4.0, atol=1e-6)


def test_a_vertex_without_weights_hangs_on_its_first_joint(tmp_path: Path) -> None:
    builder = bent_strip()
    attributes = builder.root["meshes"][0]["primitives"][0]["attributes"]
    attributes["WEIGHTS_0"] = builder.accessor(np.zeros((4, 4), np.float32))
    scene = builder.load(tmp_path)
    np.testing.assert_allclose(corners(scene, 1.9999999)[-1], BENT[3], atol=1e-5)


def test_a_skin_without_joints_in_its_mesh_is_a_warning(tmp_path: Path) -> None:
    builder = GltfBuilder()
    joint = builder.node()
    builder.add(TRIANGLE, skin=builder.skin([joint]))
    scene = builder.load(tmp_path)
    assert "has a skin, but its mesh no JOINTS_0" in scene.warnings[0]
    assert len(scene.instances) == 1
