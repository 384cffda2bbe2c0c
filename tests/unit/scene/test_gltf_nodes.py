"""What nodes place: transforms, mirroring, lights, cameras."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import shapes
from elemental.core import transforms
from elemental.scene.model import Scene
from gltf_builder import GltfBuilder

HALF = math.sqrt(0.5)
QUARTER_ABOUT_X = [HALF, 0.0, 0.0, HALF]
"""Takes +y to +z, and -z to +y."""
QUARTER_ABOUT_Z = [0.0, 0.0, HALF, HALF]
TRIANGLE = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)


def world_triangle(scene: Scene, instance: int = 0) -> np.ndarray:
    placed = scene.instances[instance]
    mesh = scene.meshes[placed.mesh]
    return transforms.transform_points(placed.world_from_local, mesh.positions[mesh.indices])


def test_translation_rotation_scale(tmp_path: Path) -> None:
    builder = GltfBuilder()
    builder.add(TRIANGLE, translation=[10, 0, 0], rotation=QUARTER_ABOUT_Z, scale=[2, 3, 1])
    corners = world_triangle(builder.load(tmp_path))
    np.testing.assert_allclose(corners, [[10, 0, 0], [10, 2, 0], [7, 0, 0]], atol=1e-6)


def test_matrix_is_column_major(tmp_path: Path) -> None:
    m = transforms.compose([1, 2, 3], [0.1, 0.2, 0.3, 0.9], [1.0, 5.0, 2.0])
    builder = GltfBuilder()
    builder.add(TRIANGLE, matrix=m.T.reshape(-1).tolist())
    np.testing.assert_allclose(builder.load(tmp_path).instances[0].world_from_local, m, atol=1e-6)


def test_children_follow_their_parents(tmp_path: Path) -> None:
    builder = GltfBuilder()
    leaf = builder.add(TRIANGLE, root=False, translation=[1, 0, 0])
    middle = builder.node(root=False, children=[leaf], rotation=QUARTER_ABOUT_Z)
    builder.node(children=[middle], translation=[0, 0, 5], scale=[2, 2, 2])
    corners = world_triangle(builder.load(tmp_path))
    np.testing.assert_allclose(corners, [[0, 2, 5], [0, 4, 5], [-2, 2, 5]], atol=1e-6)


def test_mirrored_instance_faces_outward_still(tmp_path: Path) -> None:
    positions, indices = shapes.box()
    tangents = np.tile(np.array([1, 0, 0, 1], np.float32), (len(positions), 1))
    builder = GltfBuilder()
    primitive = builder.primitive(positions, indices, normals=positions, tangents=tangents)
    mesh = builder.mesh(primitive, name="box")
    for scale in ([1, 1, 1], [-1, 1, 1], [2, 1, -1], [-1, 1, -1], [-1, -1, -1]):
        builder.node(mesh=mesh, scale=scale)
    scene = builder.load(tmp_path)
    assert [instance.mesh for instance in scene.instances] == [0, 1, 1, 0, 1]
    assert [mesh.name for mesh in scene.meshes] == ["box", "box (mirrored)"]
    for i in range(5):
        a, b, c = world_triangle(scene, i).astype(np.float64).reshape(-1, 3, 3).transpose(1, 0, 2)
        volume = (a * np.cross(b, c)).sum() / 6
        assert volume == pytest.approx(2.0 if i == 2 else 1.0)
    # The bitangent's image is the image's bitangent, on either hand.
    for instance in scene.instances[:2]:
        m, mesh_ = instance.world_from_local, scene.meshes[instance.mesh]
        n, t = mesh_.normals[0], mesh_.tangents[0]
        image = m[:3, :3] @ np.cross(positions[0] / np.linalg.norm(positions[0]), [1, 0, 0])
        moved_n = transforms.normal_matrix(m) @ n
        np.testing.assert_allclose(np.cross(moved_n, m[:3, :3] @ t[:3]) * t[3], image, atol=1e-6)


def test_only_the_default_scene_is_placed(tmp_path: Path) -> None:
    builder = GltfBuilder()
    builder.add(TRIANGLE, name="in the other")
    builder.root["scenes"].append({"nodes": [builder.add(TRIANGLE, root=False, name="chosen")]})
    builder.root["scene"] = 1
    assert [i.name for i in builder.load(tmp_path).instances] == ["chosen"]


def test_without_scenes_every_root_is_placed(tmp_path: Path) -> None:
    builder = GltfBuilder()
    child = builder.add(TRIANGLE, root=False, name="child")
    builder.node(children=[child])
    builder.add(TRIANGLE, name="other")
    del builder.root["scenes"], builder.root["scene"]
    assert [i.name for i in builder.load(tmp_path).instances] == ["child", "other"]


@pytest.mark.parametrize("rotation", [[0, 0, 0, 1], [0.5, 0.5, 0.5, 0.5], [0.6, 0, 0, 0.8]])
def test_a_scale_of_0_on_one_axis_leaves_a_sheet(rotation: list[float], tmp_path: Path) -> None:
    """A ball becomes a disc of two faces; so does it below a mirroring parent."""
    builder = GltfBuilder()
    disc = builder.add(*shapes.sphere(), scale=[2, 2, 0], translation=[5, 0, 0], root=False)
    builder.node(children=[disc], rotation=rotation, scale=[-1, 1, 1])
    builder.add(TRIANGLE)
    scene = builder.load(tmp_path)
    assert "1 meshes are drawn flat, whose nodes have a scale of 0" in scene.notes[-1]
    sheet = next(i for i in scene.instances if scene.meshes[i.mesh].name.endswith("(flat)"))
    mesh, world = scene.meshes[sheet.mesh], sheet.world_from_local
    turned = transforms.compose((0, 0, 0), rotation, (-1, 1, 1))
    np.testing.assert_allclose(world[:3, 3], turned[:3, :3] @ (5, 0, 0), atol=1e-5)
    a, b, c = mesh.positions[mesh.indices].reshape(-1, 3, 3).astype(float).transpose(1, 0, 2)
    doubled = np.cross(b - a, c - a)
    along = turned[:3, 2]
    assert np.abs(doubled @ along).sum() / 2 == pytest.approx(2 * 4 * math.pi, rel=0.03)
    assert np.abs(doubled.sum(axis=0)).max() < 1e-3  # as much of it faces either way
    shown = np.linalg.norm(doubled, axis=1) > 1e-5
    facing = (mesh.normals[mesh.indices].reshape(-1, 3, 3)[shown] @ along).mean(axis=1)
    np.testing.assert_allclose(facing, np.sign(doubled[shown] @ along), atol=1e-3)


def test_an_invisible_node_hides_all_below_but_cameras(tmp_path: Path) -> None:
    builder = GltfBuilder()
    hidden, shown = ({"KHR_node_visibility": {"visible": seen}} for seen in (False, True))
    below = builder.add(TRIANGLE, root=False, name="below", extensions=shown)
    lamp = builder.light("point", {"intensity": 3.0}, root=False)
    eye = builder.camera(root=False)
    builder.node(children=[below, lamp, eye], extensions=hidden)
    builder.add(TRIANGLE, name="seen", extensions=shown)
    builder.extend("KHR_node_visibility", required=True)
    scene = builder.load(tmp_path)
    assert [instance.name for instance in scene.instances] == ["seen"]
    assert scene.lights == []
    assert len(scene.cameras) == 1
    assert scene.warnings == []
    assert "1 meshes are left out, whose nodes are invisible" in scene.notes[0]


@pytest.mark.parametrize("scale", [[0, 0, 0], [1, 0, 0], [1e-20, 1, 1]])
def test_flattening_scale_leaves_the_mesh_out(scale: list[float], tmp_path: Path) -> None:
    builder = GltfBuilder()
    builder.add(TRIANGLE, scale=scale)
    builder.add(TRIANGLE)
    scene = builder.load(tmp_path)
    assert len(scene.instances) == 1
    assert "1 meshes are left out, whose scale of 0 leaves no area" in scene.notes[0]


def test_lights(tmp_path: Path) -> None:
    builder = GltfBuilder()
    builder.add(TRIANGLE)
    builder.light("directional", {"intensity": 5.0, "color": [1, 0.5, 0]}, name="sun")
    lamp = {"intensity": 7.0, "range": 9.0}
    builder.light("point", lamp, translation=[1, 2, 3], scale=[4, 4, 4], name="lamp")
    cone = {"spot": {"innerConeAngle": 0.2, "outerConeAngle": 0.5}}
    builder.light("spot", cone, rotation=QUARTER_ABOUT_X, scale=[3, 3, 3], name="spot")
    sun, lamp_, spot = builder.load(tmp_path).lights
    assert (sun.name, sun.kind, sun.intensity) == ("sun", "directional", 5.0)
    np.testing.assert_array_equal(sun.color, np.array([1, 0.5, 0], np.float32))
    np.testing.assert_array_equal(sun.direction, [0, 0, -1])
    assert math.isinf(sun.range)
    assert (lamp_.kind, lamp_.intensity, lamp_.range) == ("point", 7.0, 9.0)
    np.testing.assert_array_equal(lamp_.position, [1, 2, 3])
    np.testing.assert_allclose(spot.direction, [0, 1, 0], atol=1e-6)
    assert (spot.inner_angle, spot.outer_angle) == (0.2, 0.5)
    assert all(light.casts_shadow for light in (sun, lamp_, spot))


def test_light_defaults(tmp_path: Path) -> None:
    builder = GltfBuilder()
    builder.add(TRIANGLE)
    builder.light("spot")
    spot = builder.load(tmp_path).lights[0]
    assert (spot.intensity, spot.inner_angle, spot.outer_angle) == (1.0, 0.0, math.pi / 4)
    np.testing.assert_array_equal(spot.color, [1, 1, 1])


def test_camera(tmp_path: Path) -> None:
    builder = GltfBuilder()
    builder.add(TRIANGLE)
    builder.camera(
        0.7, 0.25, name="cam", translation=[1, 2, 3], rotation=QUARTER_ABOUT_Z, scale=[2, 2, 5]
    )
    builder.camera(name="cam")
    scene = builder.load(tmp_path)
    camera, second = scene.cameras
    assert (camera.name, second.name) == ("cam", "cam.2")
    assert (camera.fov_y, camera.near, camera.far, camera.aspect) == (0.7, 0.25, None, None)
    expected = transforms.compose([1, 2, 3], QUARTER_ABOUT_Z, [1, 1, 1])
    np.testing.assert_allclose(camera.world_from_view, expected, atol=1e-6)
    assert scene.default_camera(1.0) is camera


def test_orthographic_camera_is_a_warning(tmp_path: Path) -> None:
    builder = GltfBuilder()
    builder.add(TRIANGLE)
    lens = {"xmag": 1, "ymag": 1, "znear": 0.1, "zfar": 10}
    camera = builder.append("cameras", {"type": "orthographic", "orthographic": lens})
    builder.node(camera=camera)
    scene = builder.load(tmp_path)
    assert scene.cameras == []
    assert "cameras[0]: orthographic cameras are not supported" in scene.warnings[0]


@pytest.mark.parametrize("aspect", [0.5, 1.0, 3.0])
@pytest.mark.parametrize("size", [(1, 1, 1), (100, 1, 100), (1, 50, 2), (1e-3, 1e-3, 1e-3)])
def test_default_camera_sees_everything(
    size: tuple[float, float, float], aspect: float, tmp_path: Path
) -> None:
    builder = GltfBuilder()
    positions, indices = shapes.box(size)
    builder.add(positions, indices, translation=[7, 8, 9])
    camera = builder.load(tmp_path).default_camera(aspect)
    clip_from_view = transforms.perspective(camera.fov_y, aspect, camera.near)
    clip_from_world = clip_from_view @ transforms.inverse(camera.world_from_view)
    clip = transforms.transform_points(clip_from_world, positions + np.array([7, 8, 9]))
    reach = np.abs(clip[:, :2]).max()
    assert 0.85 < reach < 1.0
    assert clip[:, 2].min() > -1.0
