"""Geometry of glTF files: modes, attributes, accessors, what is generated and what is dropped."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import shapes
from elemental.scene.gltf.meshes import triangles_of
from elemental.scene.model import Mesh
from gltf_builder import GltfBuilder

TRIANGLE = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)
UP = np.tile(np.array([0, 0, 1], np.float32), (3, 1))


def only_mesh(builder: GltfBuilder, folder: Path, name: str = "scene.glb") -> Mesh:
    scene = builder.load(folder, name)
    assert len(scene.meshes) == 1
    return scene.meshes[0]


@pytest.mark.parametrize("name", ["scene.glb", "scene.gltf"])
def test_indexed_mesh_with_every_attribute(name: str, tmp_path: Path) -> None:
    builder = GltfBuilder()
    positions, indices = shapes.quad()
    uv0 = positions[:, ::2].copy()
    uv1 = uv0 * 0.5
    normals = np.tile(np.array([0, 2, 0], np.float32), (4, 1))
    tangents = np.tile(np.array([2, 0, 0, -1], np.float32), (4, 1))
    colors = np.array([[255, 128, 0, 64]] * 4, np.uint8)
    builder.add(
        positions, indices.astype(np.uint8), name="floor",
        normals=normals, tangents=tangents, uv0=uv0, uv1=uv1, colors=colors,
    )  # fmt: skip
    mesh = only_mesh(builder, tmp_path, name)
    np.testing.assert_array_equal(mesh.positions, positions)
    np.testing.assert_array_equal(mesh.indices, indices)
    np.testing.assert_array_equal(mesh.normals, [[0, 1, 0]] * 4)
    np.testing.assert_array_equal(mesh.tangents, [[1, 0, 0, -1]] * 4)
    np.testing.assert_array_equal(mesh.uv0, uv0)
    np.testing.assert_array_equal(mesh.uv1, uv1)
    np.testing.assert_array_equal(mesh.colors, colors)
    assert mesh.indices.dtype == np.uint32
    assert {a.dtype for a in (mesh.positions, mesh.normals, mesh.tangents)} == {np.dtype("f4")}


def test_what_is_missing_is_neutral(tmp_path: Path) -> None:
    builder = GltfBuilder()
    builder.add(TRIANGLE)
    scene = builder.load(tmp_path)
    mesh = scene.meshes[0]
    np.testing.assert_array_equal(mesh.indices, [0, 1, 2])
    np.testing.assert_array_equal(mesh.normals, UP)
    np.testing.assert_array_equal(mesh.colors, np.full((3, 4), 255))
    np.testing.assert_array_equal(mesh.uv0, np.zeros((3, 2)))
    np.testing.assert_allclose((mesh.tangents[:, :3] * mesh.normals).sum(axis=1), 0, atol=1e-7)
    material = scene.materials[mesh.material]
    assert (material.name, material.metallic, material.roughness) == ("default", 1.0, 1.0)


@pytest.mark.parametrize(
    ("mode", "corners"),
    [
        ("strip", [[0, 1, 2], [1, 3, 2], [2, 3, 4], [3, 5, 4]]),
        ("fan", [[1, 2, 0], [2, 3, 0], [3, 4, 0], [4, 5, 0]]),
    ],
)
def test_strips_and_fans(mode: str, corners: list[list[int]]) -> None:
    np.testing.assert_array_equal(triangles_of(mode, np.arange(6)).reshape(-1, 3), corners)
    assert len(triangles_of(mode, np.arange(2))) == 0


def test_strip_keeps_its_facing(tmp_path: Path) -> None:
    x, y = np.repeat(np.arange(4.0), 2), np.tile([0.0, 1.0], 4)
    builder = GltfBuilder()
    # Corners alternate below and above; the first triangle is counter-clockwise seen from -z.
    builder.add(np.stack([x, y, 0 * x], axis=1), mode=5)
    mesh = only_mesh(builder, tmp_path)
    assert mesh.triangle_count == 6
    np.testing.assert_array_equal(mesh.normals, np.tile([0, 0, -1], (18, 1)))


def test_points_and_lines_are_one_warning(tmp_path: Path) -> None:
    builder = GltfBuilder()
    for mode in (0, 1, 2, 3):
        builder.add(TRIANGLE, mode=mode)
    builder.add(TRIANGLE)
    scene = builder.load(tmp_path)
    assert scene.triangle_count == 1
    assert scene.warnings == [f"{tmp_path / 'scene.glb'}: meshes: points and lines are not drawn"]


def test_missing_normals_are_flat(tmp_path: Path) -> None:
    positions = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], np.float32)
    builder = GltfBuilder()
    builder.add(positions, np.array([0, 1, 2, 0, 2, 3], np.uint16), tangents=np.ones((4, 4)))
    mesh = only_mesh(builder, tmp_path)
    assert len(mesh.positions) == 6
    np.testing.assert_array_equal(mesh.normals, [[0, 0, 1]] * 3 + [[1, 0, 0]] * 3)
    np.testing.assert_array_equal(mesh.positions[mesh.indices], positions[[0, 1, 2, 0, 2, 3]])
    # Tangents are ignored where normals are missing.
    np.testing.assert_allclose((mesh.tangents[:, :3] * mesh.normals).sum(axis=1), 0, atol=1e-7)


def test_broken_normals_become_area_weighted(tmp_path: Path) -> None:
    positions, indices = shapes.sphere(2.0, rings=12)
    normals = positions / 2.0
    normals[::3] = 0.0
    normals[1::3] = np.nan
    builder = GltfBuilder()
    builder.add(positions, indices, normals=normals)
    mesh = only_mesh(builder, tmp_path)
    np.testing.assert_allclose(np.linalg.norm(mesh.normals, axis=1), 1.0, atol=1e-6)
    assert (mesh.normals * mesh.positions / 2.0).sum(axis=1).min() > 0.97


def test_zero_area_triangles_are_dropped_with_a_note(tmp_path: Path) -> None:
    positions = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [2, 0, 0], [5, 5, 5]], np.float32)
    builder = GltfBuilder()
    builder.add(
        positions,
        np.array([0, 1, 2, 0, 1, 3, 0, 0, 1, 4, 4, 4], np.uint16),
        normals=UP[[0, 0, 0, 0, 0]],
    )
    scene = builder.load(tmp_path)
    assert scene.triangle_count == 1
    file = tmp_path / "scene.glb"
    assert scene.notes == [f"{file}: 3 triangles without area are dropped"]
    # Vertices that no triangle uses leave with them, so that they don't widen the bounds.
    assert len(scene.meshes[0].positions) == 3
    np.testing.assert_array_equal(scene.bounds()[1], [1, 1, 0])


@pytest.mark.parametrize("size", [1e-6, 1e-3, 1.0, 1e4, 1e6])
def test_area_is_judged_by_proportion(size: float, tmp_path: Path) -> None:
    builder = GltfBuilder()
    builder.add(*[shapes.sphere(size)[0], shapes.sphere(size)[1]])
    scene = builder.load(tmp_path)
    assert scene.triangle_count == len(shapes.sphere(size)[1]) // 3
    assert scene.notes == []


def test_vertex_colors_of_each_type(tmp_path: Path) -> None:
    for colors in (
        np.full((3, 4), 0.5, np.float32),
        np.full((3, 3), 32768, np.uint16),
        np.full((3, 4), 128, np.uint8),
    ):
        builder = GltfBuilder()
        builder.add(TRIANGLE, colors=colors)
        mesh = only_mesh(builder, tmp_path)
        assert (mesh.colors[:, :3] == 128).all()
        assert mesh.colors[0, 3] == (255 if colors.shape[1] == 3 else 128)


def test_interleaved_buffer_view(tmp_path: Path) -> None:
    builder = GltfBuilder()
    interleaved = np.zeros(3, [("p", "<f4", 3), ("n", "<f4", 3), ("pad", "u1", 4)])
    interleaved["p"], interleaved["n"] = TRIANGLE, UP
    view = builder.view(interleaved.tobytes(), byteStride=28)
    common = {"bufferView": view, "componentType": 5126, "count": 3, "type": "VEC3"}
    position = builder.append("accessors", common)
    normal = builder.append("accessors", {**common, "byteOffset": 12})
    attributes = {"POSITION": position, "NORMAL": normal}
    builder.node(mesh=builder.mesh({"attributes": attributes}))
    mesh = only_mesh(builder, tmp_path)
    np.testing.assert_array_equal(mesh.positions, TRIANGLE)
    np.testing.assert_array_equal(mesh.normals, UP)


@pytest.mark.parametrize("backed", [True, False])
def test_sparse_accessor(backed: bool, tmp_path: Path) -> None:
    builder = GltfBuilder()
    primitive = builder.primitive(TRIANGLE)
    accessor = builder.root["accessors"][0]
    if not backed:
        del accessor["bufferView"]
    accessor["sparse"] = {
        "count": 2,
        "indices": {"bufferView": builder.view(b"\1\2"), "componentType": 5121},
        "values": {"bufferView": builder.view(np.array([[3, 0, 0], [0, 4, 0]], "f4").tobytes())},
    }
    builder.node(mesh=builder.mesh(primitive))
    mesh = only_mesh(builder, tmp_path)
    np.testing.assert_array_equal(mesh.positions, [[0, 0, 0], [3, 0, 0], [0, 4, 0]])


@pytest.mark.parametrize(
    ("dtype", "normalized", "scale"),
    [
        (np.int8, True, 127.0), (np.uint8, True, 255.0),
        (np.int16, True, 32767.0), (np.uint16, True, 65535.0),
        (np.int8, False, 1.0), (np.uint16, False, 1.0),
    ],
)  # fmt: skip
def test_mesh_quantization(dtype: Any, normalized: bool, scale: float, tmp_path: Path) -> None:
    stored = np.array([[0, 0, 0, 0], [100, 0, 0, 0], [0, 60, 0, 0]], dtype)
    builder = GltfBuilder()
    builder.extend("KHR_mesh_quantization", required=True)
    stride = stored.itemsize * 4
    view = builder.view(stored.tobytes(), byteStride=stride)
    code = {"i1": 5120, "u1": 5121, "i2": 5122, "u2": 5123}[stored.dtype.str[1:]]
    accessor = {"bufferView": view, "componentType": code, "count": 3, "type": "VEC3"}
    position = builder.append("accessors", {**accessor, "normalized": normalized})
    builder.node(mesh=builder.mesh({"attributes": {"POSITION": position}}))
    mesh = only_mesh(builder, tmp_path)
    np.testing.assert_allclose(mesh.positions, stored[:, :3] / scale, rtol=1e-6)


def test_signed_normalized_integers_stop_at_minus_1(tmp_path: Path) -> None:
    builder = GltfBuilder()
    builder.add(TRIANGLE, normals=np.array([[-128, 0, 0]] * 3, np.int8))
    np.testing.assert_array_equal(only_mesh(builder, tmp_path).normals, [[-1, 0, 0]] * 3)


def test_primitives_of_one_mesh_and_instances_of_one_mesh(tmp_path: Path) -> None:
    builder = GltfBuilder()
    red, green = builder.material(name="red"), builder.material(name="green")
    first = builder.primitive(TRIANGLE, material=red)
    second = builder.primitive(TRIANGLE + 1, material=green)
    mesh = builder.mesh(first, second, name="pair")
    builder.node(mesh=mesh, name="here")
    builder.node(mesh=mesh, name="there", translation=[5, 0, 0])
    scene = builder.load(tmp_path)
    assert [m.name for m in scene.meshes] == ["pair.0", "pair.1"]
    assert [m.material for m in scene.meshes] == [red, green]
    assert [(i.name, i.mesh) for i in scene.instances] == [
        ("here", 0), ("here", 1), ("there", 0), ("there", 1),
    ]  # fmt: skip
    assert scene.triangle_count == 4


def test_trailing_indices_are_a_warning(tmp_path: Path) -> None:
    builder = GltfBuilder()
    builder.add(TRIANGLE, np.array([0, 1, 2, 0], np.uint16))
    scene = builder.load(tmp_path)
    assert scene.triangle_count == 1
    assert "no multiple of 3" in scene.warnings[0]


def test_loading_twice_gives_the_same_arrays(tmp_path: Path) -> None:
    builder = GltfBuilder()
    texture = builder.texture(np.zeros((2, 2, 3)))
    material = builder.material(normalTexture={"index": texture})
    positions, indices = shapes.sphere()
    builder.add(positions, indices, normals=positions, uv0=positions[:, :2], material=material)
    first, second = (only_mesh(builder, tmp_path) for _ in range(2))
    for name in ("positions", "normals", "tangents", "uv0", "uv1", "colors", "indices"):
        assert getattr(first, name).tobytes() == getattr(second, name).tobytes()
