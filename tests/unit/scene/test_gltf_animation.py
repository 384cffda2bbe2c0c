"""Animations of glTF files: what moves, how, and for how long."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import shapes
from elemental.core.errors import InputError
from elemental.scene.evaluate import evaluate
from elemental.scene.load import load_scene
from gltf_builder import GltfBuilder
from unit.scene.gltf_motion import (
    ALONG_X,
    HALF,
    QUARTER_Z,
    TRIANGLE,
    TWO,
    corners,
    moved_triangle,
    places,
)


def test_a_node_moves_and_the_others_stand(tmp_path: Path) -> None:
    scene = moved_triangle().load(tmp_path)
    assert [(i.name, i.dynamic) for i in scene.instances] == [("still", False), ("mover", True)]
    assert scene.animations == ["slide"]
    assert [places(scene, t) for t in (0.0, 0.5, 1.5, 2.5)] == [
        [[0, 0, 0]], [[1, 0, 0]], [[3, 0, 0]], [[1, 0, 0]],
    ]  # fmt: skip
    np.testing.assert_array_equal(scene.instances[1].world_from_local, np.eye(4))
    assert scene.warnings == []


def test_children_lights_and_cameras_ride_along(tmp_path: Path) -> None:
    builder = GltfBuilder()
    child = builder.add(TRIANGLE, root=False, translation=[0, 1, 0])
    lamp = builder.light("point", root=False, translation=[0, 0, 2], name="lamp")
    eye = builder.camera(root=False, name="eye")
    cart = builder.node(children=[child, lamp, eye], translation=[0, 0, 0])
    builder.node(children=[cart], root=True, translation=[0, 0, 10])
    builder.root["scenes"][0]["nodes"].remove(cart)
    builder.animation((cart, "rotation", TWO, [[0, 0, 0, 1], QUARTER_Z]))
    scene = builder.load(tmp_path)
    pose = evaluate(scene, np.nextafter(2.0, 0.0))
    np.testing.assert_allclose(pose.world_from_local[0][:3, 3], [-1, 0, 10], atol=1e-6)
    np.testing.assert_allclose(pose.lights[0].position, [0, 0, 12], atol=1e-6)
    np.testing.assert_allclose(pose.cameras[0].world_from_view[:3, 0], [0, 1, 0], atol=1e-6)


@pytest.mark.parametrize(
    ("interpolation", "values", "expected"),
    [
        ("STEP", [[0, 0, 0], [4, 0, 0]], 0.0),
        ("LINEAR", [[0, 0, 0], [4, 0, 0]], 1.0),
        ("CUBICSPLINE", [[9, 9, 9], [0, 0, 0], [0, 0, 0], [0, 0, 0], [4, 0, 0], [9, 9, 9]], 0.625),
    ],
)
def test_interpolations(
    interpolation: str, values: list[list[float]], expected: float, tmp_path: Path
) -> None:
    """At a quarter of the way; the cubic with flat ends is 4 (3 s^2 - 2 s^3)."""
    builder = GltfBuilder()
    node = builder.add(TRIANGLE)
    builder.animation((node, "translation", TWO, values), interpolation=interpolation)
    assert places(builder.load(tmp_path), 0.5) == [[expected, 0, 0]]


def test_quantized_rotations(tmp_path: Path) -> None:
    builder = GltfBuilder()
    node = builder.add(TRIANGLE)
    builder.animation((node, "rotation", TWO, [[0, 0, 0, 1], QUARTER_Z]))
    keys = np.array([[0, 0, 0, 1], [0, 0, HALF, HALF]]) * 32767
    quantized = builder.accessor(np.round(keys).astype(np.int16), normalized=True)
    builder.root["animations"][0]["samplers"][0]["output"] = quantized
    np.testing.assert_allclose(
        evaluate(builder.load(tmp_path), 1.9999999).world_from_local[0][:3, 0], [0, 1, 0], atol=1e-4
    )


def test_all_animations_play_each_at_its_length_or_one_of_them(tmp_path: Path) -> None:
    builder = GltfBuilder()
    first, second = builder.add(TRIANGLE), builder.add(TRIANGLE)
    builder.animation((first, "translation", TWO, ALONG_X), name="long")
    builder.animation((second, "translation", [0.0, 1.0], ALONG_X), name="short")
    path = builder.write(tmp_path / "two.glb")
    both = load_scene(path, default_lights=False)
    assert places(both, 1.25) == [[2.5, 0, 0], [1, 0, 0]]
    one = load_scene(path, default_lights=False, animation="short")
    assert [i.dynamic for i in one.instances] == [False, True]
    assert places(one, 1.25) == [[1, 0, 0]]
    none = load_scene(path, default_lights=False, animation="none")
    assert none.motion is none.extent is None
    with pytest.raises(InputError, match="no animation is named 'walk'; known: long, short"):
        load_scene(path, default_lights=False, animation="walk")


def test_tracks_that_hold_still_leave_things_static(tmp_path: Path) -> None:
    """Exporters write tracks for every node; the value counts, also where it is not the rest's."""
    builder = GltfBuilder()
    node = builder.add(TRIANGLE, translation=[9, 9, 9])
    flat = [[0, 0, 0], [5, 0, 0], [0, 0, 0]] * 2
    builder.animation((node, "translation", TWO, flat), interpolation="CUBICSPLINE")
    scene = builder.load(tmp_path)
    assert scene.motion is None
    np.testing.assert_array_equal(scene.instances[0].world_from_local[:3, 3], [5, 0, 0])


def test_tangents_alone_move_a_cubic_track(tmp_path: Path) -> None:
    """Equal values and slopes of 4 a second at both ends: 4 (s^3 - 2 s^2 + s) + 4 (s^3 - s^2) at
    half of a second is 0, at a quarter 3/8."""
    builder = GltfBuilder()
    node = builder.add(TRIANGLE)
    keys = [[4, 0, 0], [0, 0, 0], [4, 0, 0]] * 2
    builder.animation((node, "translation", [0, 1], keys), interpolation="CUBICSPLINE")
    assert places(builder.load(tmp_path), 0.25) == [[0.375, 0, 0]]


def test_what_is_held_still_beside_a_motion_is_no_track(tmp_path: Path) -> None:
    builder = moved_triangle()
    still = (1, "rotation", TWO, [QUARTER_Z, QUARTER_Z])
    builder.animation((1, "translation", TWO, ALONG_X), still)
    del builder.root["animations"][0]
    scene = builder.load(tmp_path)
    assert scene.motion is not None
    assert [track.path for track in scene.motion.tracks] == ["translation"]
    np.testing.assert_allclose(
        evaluate(scene, 0.0).world_from_local[0][:3, 0], [0, 1, 0], atol=1e-6
    )


def test_what_starts_at_scale_0_appears(tmp_path: Path) -> None:
    builder = GltfBuilder()
    builder.add(TRIANGLE)
    node = builder.add(TRIANGLE, name="late", scale=[0, 0, 0])
    builder.animation((node, "scale", [0, 1, 2], [[0, 0, 0], [0, 0, 0], [1, 1, 1]]))
    never = builder.add(TRIANGLE, name="never", scale=[0, 0, 0])
    builder.animation((never, "translation", TWO, ALONG_X))
    scene = builder.load(tmp_path)
    assert [i.name for i in scene.instances] == ["mesh0", "late"]
    assert [evaluate(scene, t).visible.tolist() for t in (0.0, 0.9, 1.5)] == [
        [False], [False], [True],
    ]  # fmt: skip
    assert np.linalg.det(scene.instances[-1].world_from_local) > 0
    assert "1 meshes are left out, which never show" in scene.notes[0]


def test_what_moves_mirrored_faces_outward(tmp_path: Path) -> None:
    builder = GltfBuilder()
    positions, indices = shapes.box()
    mesh = builder.mesh(builder.primitive(positions, indices), name="box")
    for number, z in enumerate((-1, 1)):
        node = builder.node(mesh=mesh, scale=[1, 1, z])
        builder.animation((node, "translation", TWO, ALONG_X), name=str(number))
    turned = builder.node(mesh=mesh, name="turned")
    builder.animation((turned, "scale", TWO, [[1, 1, 1], [1, 1, -1]]))
    scene = builder.load(tmp_path)
    for number in range(2):
        a, b, c = corners(scene, 1.0, number).astype(float).reshape(-1, 3, 3).transpose(1, 0, 2)
        assert ((a - c[0]) * np.cross(b - c[0], c - c[0])).sum() / 6 == pytest.approx(1.0)
    reason = "turned: is mirrored for a part of its motion, where its back faces show"
    assert [w.partition(": ")[2] for w in scene.warnings] == [reason]


def test_bounds_hold_the_whole_way(tmp_path: Path) -> None:
    builder = GltfBuilder()
    spoke = builder.add(TRIANGLE, root=False, translation=[5, 0, 0])
    hub = builder.node(children=[spoke])
    thirds = [[0, 0, math.sin(a), math.cos(a)] for a in np.linspace(0, math.pi, 4)]
    builder.animation((hub, "rotation", [0, 1, 2, 3], thirds))
    scene = builder.load(tmp_path)
    low, high = scene.bounds()
    for t in np.linspace(0, 3, 50):
        points = corners(scene, float(t))
        assert ((points >= low) & (points <= high)).all()
    # The triangle's box is 5 to 6 along the spoke, 0 to 1 across it.
    assert (np.abs([low[:2], high[:2]]) <= math.hypot(6, 1) * 1.03).all()
