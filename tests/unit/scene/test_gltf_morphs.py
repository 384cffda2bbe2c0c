"""Morph targets of glTF files."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from elemental.scene.deform import posed
from gltf_builder import GltfBuilder
from gpu.rig import vector
from unit.scene.gltf_motion import (
    TRIANGLE,
    TWO,
    UP,
    corners,
    morphing,
)


def test_weights_morph(tmp_path: Path) -> None:
    scene = morphing().load(tmp_path)
    expected = TRIANGLE + vector(0, 10, 0.5)
    expected[1, 0] += 3
    np.testing.assert_allclose(corners(scene, 1.0), expected, atol=1e-6)
    high = scene.bounds()[1]
    assert high[2] > 1.0
    assert high[0] > 7.0


def test_weights_at_rest_are_the_node_s_else_the_mesh_s(tmp_path: Path) -> None:
    scene = morphing(animated=False).load(tmp_path)
    assert [i.dynamic for i in scene.instances] == [False]
    np.testing.assert_allclose(corners(scene, 0.0), TRIANGLE + vector(0, 10, 0.5), atol=1e-6)
    builder = morphing(animated=False)
    builder.root["nodes"][0]["weights"] = [1.0, 0.0]
    scene = builder.load(tmp_path)
    np.testing.assert_allclose(corners(scene, 0.0), TRIANGLE + vector(0, 10, 1.0), atol=1e-6)


def test_flat_normals_follow_a_target_to_its_own(tmp_path: Path) -> None:
    """Without normals in the file each triangle is flat; a target folds one onto another axis."""
    builder = GltfBuilder()
    fold = np.zeros((3, 3))
    fold[2] = [0, -1, 1]  # the corner (0, 1, 0) to (0, 0, 1): the normal turns from +z to -y
    node = builder.node(
        mesh=builder.mesh(builder.morphed(builder.primitive(TRIANGLE), {"positions": fold}))
    )
    builder.animation((node, "weights", TWO, [0.0, 1.0]))
    still = posed(builder.load(tmp_path), np.nextafter(2.0, 0.0))
    shape = still.meshes[still.instances[0].mesh]
    np.testing.assert_allclose(shape.normals, np.tile([0, -1, 0], (3, 1)), atol=1e-6)


def test_vertices_that_tangents_split_keep_their_targets(tmp_path: Path) -> None:
    """Two triangles about a seam of mirrored texture coordinates share vertices in the file."""
    builder = GltfBuilder()
    positions = np.array([[-1, 0, 0], [0, -1, 0], [0, 1, 0], [1, 0, 0]], np.float32)
    indices = np.array([0, 1, 2, 2, 1, 3], np.uint16)
    uv = np.abs(positions[:, :2])
    uv[1, 1] = 2.0
    image = {"index": builder.texture(np.full((2, 2, 3), 128))}
    primitive = builder.primitive(
        positions, indices, normals=np.tile(UP[:1], (4, 1)), uv0=uv,
        material=builder.material(normalTexture=image),
    )  # fmt: skip
    builder.morphed(primitive, {"positions": positions})
    builder.skinned(primitive, np.zeros((4, 4)), np.tile([1.0, 0, 0, 0], (4, 1)))
    joint = builder.node()
    node = builder.node(mesh=builder.mesh(primitive), skin=builder.skin([joint]))
    builder.animation((node, "weights", TWO, [0.0, 1.0]))
    scene = builder.load(tmp_path)
    shape = scene.meshes[0]
    assert len(shape.positions) == 6
    assert shape.morphs is not None
    assert shape.influences is not None
    assert len(shape.influences.joints) == 6
    np.testing.assert_array_equal(shape.morphs.positions[0], shape.positions)


def test_a_triangle_that_a_target_opens_is_kept(tmp_path: Path) -> None:
    builder = GltfBuilder()
    closed = np.zeros((3, 3), np.float32)
    closed[1, 0] = 1.0
    opening = np.zeros((3, 3))
    opening[2, 1] = 1.0
    node = builder.node(
        mesh=builder.mesh(builder.morphed(builder.primitive(closed), {"positions": opening}))
    )
    builder.animation((node, "weights", TWO, [0.0, 1.0]))
    assert builder.load(tmp_path).triangle_count == 1
