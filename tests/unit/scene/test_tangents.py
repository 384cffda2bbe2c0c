"""Generated tangents: closed forms, mirrored mappings, split vertices."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import shapes
from elemental.scene.model import Mesh
from elemental.scene.tangents import any_tangents
from gltf_builder import Array, GltfBuilder

FLAT_NORMAL_MAP = np.full((2, 2, 3), (128, 128, 255), np.uint8)


def with_normal_map(folder: Path, positions: Array, indices: Array, **attributes: Array) -> Mesh:
    builder = GltfBuilder()
    uv_set = 1 if "uv1" in attributes else 0
    slot = {"index": builder.texture(FLAT_NORMAL_MAP), "texCoord": uv_set}
    material = builder.material(normalTexture=slot)
    builder.add(positions, indices, material=material, **attributes)
    return builder.load(folder).meshes[0]


@pytest.mark.parametrize("uv_name", ["uv0", "uv1"])
def test_quad(uv_name: str, tmp_path: Path) -> None:
    positions, indices = shapes.quad()
    normals = np.tile(np.array([0, 1, 0], np.float32), (4, 1))
    # u along x, v along +z: seen from above, v points down the picture, as glTF's textures have it.
    uv = positions[:, ::2] + 0.5
    mesh = with_normal_map(tmp_path, positions, indices, normals=normals, **{uv_name: uv})
    np.testing.assert_allclose(mesh.tangents, [[1, 0, 0, 1]] * 4, atol=1e-7)
    bitangent = np.cross(mesh.normals, mesh.tangents[:, :3]) * mesh.tangents[:, 3:]
    # +y of a normal map is up in the picture: towards smaller v.
    np.testing.assert_allclose(bitangent, [[0, 0, -1]] * 4, atol=1e-7)


def test_mirrored_mapping_splits_the_seam(tmp_path: Path) -> None:
    x = np.array([-1, 0, 1, -1, 0, 1], np.float32)
    z = np.array([1, 1, 1, -1, -1, -1], np.float32)
    positions = np.stack([x, 0 * x, z], axis=1)
    indices = np.array([0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4], np.uint16)
    normals = np.tile(np.array([0, 1, 0], np.float32), (6, 1))
    uv = np.stack([np.abs(x), z], axis=1)
    mesh = with_normal_map(tmp_path, positions, indices, normals=normals, uv0=uv)
    assert len(mesh.positions) == 8
    assert mesh.triangle_count == 4
    for triangle in mesh.indices.reshape(-1, 3):
        left = mesh.positions[triangle, 0].min() < 0
        expected = [-1, 0, 0, -1] if left else [1, 0, 0, 1]
        np.testing.assert_allclose(mesh.tangents[triangle], [expected] * 3, atol=1e-6)
    np.testing.assert_array_equal(mesh.positions[mesh.indices], positions[indices])


def test_sphere_tangents_follow_the_parallels(tmp_path: Path) -> None:
    positions, indices = shapes.sphere(1.0, rings=32)
    columns = 65
    i, j = np.divmod(np.arange(len(positions)), columns)
    uv = np.stack([j / 64, i / 32], axis=1).astype(np.float32)
    mesh = with_normal_map(tmp_path, positions, indices, normals=positions, uv0=uv)
    east = np.cross([0.0, 1.0, 0.0], mesh.positions)
    away_from_poles = np.abs(mesh.positions[:, 1]) < 0.95
    east = east[away_from_poles] / np.linalg.norm(east[away_from_poles], axis=1, keepdims=True)
    # A vertex on the seam sees triangles on one side only: half a segment of 64 off.
    half_segment = np.pi / 64
    cosine = (east * mesh.tangents[away_from_poles, :3]).sum(axis=1)
    assert cosine.min() > np.cos(half_segment)
    assert (mesh.tangents[:, 3] == 1.0).all()


def test_shared_vertices_share_a_frame(tmp_path: Path) -> None:
    positions, indices = shapes.quad()
    normals = np.tile(np.array([0, 1, 0], np.float32), (4, 1))
    uv = positions[:, ::2] + np.array([0.0, 0.3], np.float32) * positions[:, :1] ** 2
    indexed = with_normal_map(tmp_path, positions, indices, normals=normals, uv0=uv)
    loose = with_normal_map(
        tmp_path, positions[indices], np.arange(6, dtype=np.uint16),
        normals=normals[indices], uv0=uv[indices],
    )  # fmt: skip
    np.testing.assert_array_equal(loose.tangents, indexed.tangents[indexed.indices])


def test_without_texture_area_any_frame_will_do(tmp_path: Path) -> None:
    positions, indices = shapes.quad()
    uv = np.zeros((4, 2), np.float32)
    mesh = with_normal_map(tmp_path, positions, indices, uv0=uv)
    np.testing.assert_allclose(np.linalg.norm(mesh.tangents[:, :3], axis=1), 1.0, atol=1e-6)
    assert (mesh.tangents[:, 3] == 1.0).all()


def test_broken_tangents_are_replaced(tmp_path: Path) -> None:
    positions, indices = shapes.quad()
    normals = np.tile(np.array([0, 1, 0], np.float32), (4, 1))
    tangents = np.array([[1, 0, 0, 1], [0, 0, 0, 1], [np.nan, 0, 0, -1], [3, 0, 0, 0.2]], "f4")
    mesh = with_normal_map(tmp_path, positions, indices, normals=normals, tangents=tangents)
    np.testing.assert_allclose(np.linalg.norm(mesh.tangents[:, :3], axis=1), 1.0, atol=1e-6)
    np.testing.assert_allclose(mesh.tangents[:, 1], 0.0, atol=1e-6)
    assert set(mesh.tangents[:, 3]) <= {-1.0, 1.0}


def test_any_tangents_are_perpendicular_units() -> None:
    normals = np.random.default_rng(3).standard_normal((1000, 3))
    normals[:6] = np.concatenate([np.eye(3), -np.eye(3)])
    normals = (normals / np.linalg.norm(normals, axis=1, keepdims=True)).astype(np.float32)
    tangents = any_tangents(normals)
    np.testing.assert_allclose((tangents[:, :3] * normals).sum(axis=1), 0.0, atol=1e-6)
    np.testing.assert_allclose(np.linalg.norm(tangents[:, :3], axis=1), 1.0, atol=1e-6)
