"""Animations, skins and morph targets of glTF files: what they come to, and what is refused."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import shapes
from elemental.core import transforms
from elemental.core.errors import InputError
from elemental.scene.deform import posed
from elemental.scene.evaluate import evaluate
from elemental.scene.load import load_scene
from elemental.scene.model import Scene
from gltf_builder import GltfBuilder
from gpu.rig import vector

TRIANGLE = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)
UP = np.tile(np.array([0, 0, 1], np.float32), (3, 1))
HALF = math.sqrt(0.5)
QUARTER_Z = [0.0, 0.0, HALF, HALF]
TWO = [0.0, 2.0]
ALONG_X = [[0, 0, 0], [4, 0, 0]]


def places(scene: Scene, time_s: float) -> list[list[float]]:
    """Where the dynamic instances are, rounded."""
    pose = evaluate(scene, time_s)
    return np.round(pose.world_from_local[:, :3, 3].astype(float), 5).tolist()


def corners(scene: Scene, time_s: float, instance: int = 0) -> np.ndarray[Any, Any]:
    """World positions of a mesh's corners at a time."""
    still = posed(scene, time_s)
    placed = still.instances[instance]
    shape = still.meshes[placed.mesh]
    return transforms.transform_points(placed.world_from_local, shape.positions[shape.indices])


def moved_triangle() -> GltfBuilder:
    builder = GltfBuilder()
    builder.add(TRIANGLE, name="still")
    node = builder.add(TRIANGLE, name="mover", translation=[0, 7, 0])
    builder.animation((node, "translation", TWO, ALONG_X), name="slide")
    return builder


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


# Skins


def bent_strip(animated: bool = True) -> GltfBuilder:
    """A strip along y of which the upper end hangs on a joint at y = 1 that turns to -x."""
    builder = GltfBuilder()
    positions = np.array([[0, 0, 0], [1, 0, 0], [0, 2, 0], [1, 2, 0]], np.float32)
    indices = np.array([0, 1, 2, 2, 1, 3], np.uint16)
    primitive = builder.primitive(positions, indices, normals=np.tile(UP[:1], (4, 1)))
    joints = np.zeros((4, 4), np.uint8)
    joints[2:, 0] = 1
    builder.skinned(primitive, joints, np.tile([2.0, 0, 0, 0], (4, 1)))
    upper = builder.node(root=False, translation=[0, 1, 0])
    lower = builder.node(children=[upper])
    down = np.eye(4)
    down[1, 3] = -1
    skin = builder.skin([lower, upper], np.array([np.eye(4), down]))
    builder.node(mesh=builder.mesh(primitive), skin=skin, name="strip", translation=[50, 0, 0])
    if animated:
        builder.animation((upper, "rotation", TWO, [[0, 0, 0, 1], QUARTER_Z]))
    else:
        builder.root["nodes"][upper]["rotation"] = QUARTER_Z
    return builder


BENT = [[0, 0, 0], [1, 0, 0], [-1, 1, 0], [-1, 2, 0]]


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


# Morph targets


def morphing(animated: bool = True) -> GltfBuilder:
    builder = GltfBuilder()
    primitive = builder.primitive(TRIANGLE, normals=UP)
    lift, stretch = np.zeros((2, 3, 3))
    lift[:, 2] = 1
    stretch[1, 0] = 2
    builder.morphed(primitive, {"positions": lift}, {"positions": stretch})
    mesh = builder.mesh(primitive, weights=[0.5, 0.0])
    node = builder.node(mesh=mesh, translation=[0, 10, 0])
    if animated:
        builder.animation((node, "weights", TWO, [0.0, 0.0, 1.0, 3.0]))
    return builder


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


# Warnings and refusals


def test_pointers_are_one_warning(tmp_path: Path) -> None:
    builder = moved_triangle()
    builder.extend("KHR_animation_pointer")
    for channel in builder.root["animations"][0]["channels"]:
        channel["target"] = {"path": "pointer", "extensions": {"KHR_animation_pointer": {}}}
    builder.root["animations"][0]["channels"] *= 2
    scene = builder.load(tmp_path)
    reason = "animations: KHR_animation_pointer is not supported; what it moves stands"
    assert [w.partition(": ")[2] for w in scene.warnings] == [reason]
    assert scene.motion is None


def test_targets_of_colours_are_a_warning(tmp_path: Path) -> None:
    builder = morphing()
    target = builder.root["meshes"][0]["primitives"][0]["targets"][0]
    target["COLOR_0"] = target["POSITION"]
    warnings = builder.load(tmp_path).warnings
    assert [w.partition(": ")[2] for w in warnings] == [
        "meshes: morph targets of COLOR_0 are ignored"
    ]


def test_a_channel_without_a_node_is_ignored(tmp_path: Path) -> None:
    builder = moved_triangle()
    del builder.root["animations"][0]["channels"][0]["target"]["node"]
    assert builder.load(tmp_path).motion is None


def refusal(builder: GltfBuilder, folder: Path) -> str:
    path = builder.write(folder / "a.gltf")
    with pytest.raises(InputError) as caught:
        load_scene(path, default_lights=True)
    text = str(caught.value)
    assert "\n" not in text
    return text.removeprefix(f"{path}: ")


def animation(builder: GltfBuilder) -> Any:
    return builder.root["animations"][0]


def set_times(*times: float) -> Callable[[GltfBuilder], None]:
    def damage(builder: GltfBuilder) -> None:
        accessor = builder.accessor(np.array(times, np.float32))
        animation(builder)["samplers"][0]["input"] = accessor

    return damage


def set_values(values: object) -> Callable[[GltfBuilder], None]:
    def damage(builder: GltfBuilder) -> None:
        accessor = builder.accessor(np.array(values, np.float32))
        animation(builder)["samplers"][0]["output"] = accessor

    return damage


def edit(*path: Any, value: Any) -> Callable[[GltfBuilder], None]:
    """Set what lies behind keys and indices of the first animation."""

    def damage(builder: GltfBuilder) -> None:
        owner = animation(builder)
        for step in path[:-1]:
            owner = owner[step]
        owner[path[-1]] = value

    return damage


def twice(builder: GltfBuilder) -> None:
    animation(builder)["channels"] *= 2


def to_matrix(builder: GltfBuilder) -> None:
    del builder.root["nodes"][1]["translation"]
    builder.root["nodes"][1]["matrix"] = np.eye(4).reshape(-1).tolist()


SAMPLER, CHANNEL = ("samplers", 0), ("channels", 0)
IN, OUT = "animations[0].samplers[0].input", "animations[0].samplers[0].output"
TARGET = "animations[0].channels[0].target"


@pytest.mark.parametrize(
    ("damage", "reason"),
    [
        (edit("samplers", value=[]), "channels[0].sampler: 0 is out of range, there are 0 sa"),
        (edit(*CHANNEL, "sampler", value=3), "sampler: 3 is out of range, there are 1 samplers"),
        (edit(*CHANNEL, "target", value={}), f"{TARGET}: path is missing"),
        (edit(*CHANNEL, "target", "path", value="spin"), f"{TARGET}.path: expected one of transla"),
        (edit(*CHANNEL, "target", "node", value=9), f"{TARGET}.node: 9 is out of range, there are"),
        (edit(*CHANNEL, "target", "path", value="weights"), f"{TARGET}: node 1 has no morph targ"),
        (edit(*SAMPLER, "interpolation", value="SINE"), "interpolation: expected one of STEP"),
        (edit(*SAMPLER, "interpolation", value="CUBICSPLINE"),
         f"{OUT}: has 2 values, 2 keys of 3 need 6"),
        (set_times(0, np.nan), f"{IN}: time 1 is NaN or infinite"),
        (set_times(0, 0), f"{IN}: times do not increase at key 1"),
        (set_times(1, 0), f"{IN}: times do not increase at key 1"),
        (set_times(-1, 0), f"{IN}: time 0 is negative (-1)"),
        (set_times(0, 1, 2), f"{OUT}: has 2 values, 3 keys of 1 need 3"),
        (set_values([[0, 0, 0], [0, np.inf, 0]]), f"{OUT}: value 1 is NaN or infinite"),
        (set_values([[0, 0, 0, 1]] * 2), f"{OUT}: expected an accessor of 3 components"),
        (twice, "channels[1].target: the translation of node 1 is moved twice in one animation"),
        (to_matrix, f"{TARGET}: node 1 has a matrix, which can't be animated"),
        (set_values([[0, 0, 0], [3e38, 3e38, 3e38]]), "reaches beyond 1e+09 m"),
    ],
)  # fmt: skip
def test_broken_animations(
    damage: Callable[[GltfBuilder], None], reason: str, tmp_path: Path
) -> None:
    builder = moved_triangle()
    damage(builder)
    assert reason in refusal(builder, tmp_path)


def test_a_rotation_of_length_0(tmp_path: Path) -> None:
    builder = GltfBuilder()
    node = builder.add(TRIANGLE)
    builder.animation((node, "rotation", TWO, [[0, 0, 0, 1], [0, 0, 0, 0]]))
    assert refusal(builder, tmp_path) == f"{OUT}: key 1 is a quaternion of length 0"


def skin_of(builder: GltfBuilder) -> Any:
    return builder.root["skins"][0]


def few_matrices(builder: GltfBuilder) -> None:
    skin_of(builder)["inverseBindMatrices"] = builder.accessor(np.eye(4, dtype="f4").reshape(1, 16))


def broken_matrices(builder: GltfBuilder) -> None:
    matrices = np.full((2, 16), np.nan, np.float32)
    skin_of(builder)["inverseBindMatrices"] = builder.accessor(matrices)


def joint_elsewhere(builder: GltfBuilder) -> None:
    skin_of(builder)["joints"][1] = builder.node(root=False)


def one_joint(builder: GltfBuilder) -> None:
    skin_of(builder)["joints"].pop()


def attribute(name: str, values: Any) -> Callable[[GltfBuilder], None]:
    def damage(builder: GltfBuilder) -> None:
        attributes = builder.root["meshes"][0]["primitives"][0]["attributes"]
        attributes[name] = builder.accessor(np.asarray(values))

    return damage


def no_weights(builder: GltfBuilder) -> None:
    del builder.root["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"]


@pytest.mark.parametrize(
    ("damage", "reason"),
    [
        (lambda b: skin_of(b).update(joints=[]), "skins[0]: has no joints"),
        (lambda b: skin_of(b).update(joints=[0, 77]), "skins[0].joints[1]: 77 is out of range"),
        (joint_elsewhere, "skins[0].joints[1]: node 3 is not in the scene"),
        (few_matrices, "skins[0].inverseBindMatrices: has 1 matrices for 2 joints"),
        (broken_matrices, "skins[0].inverseBindMatrices: a matrix is NaN or infinite"),
        (one_joint, "meshes[0]: JOINTS: joint 1 is out of range, skins[0] has 1"),
        (no_weights, "attributes: WEIGHTS_0 is missing"),
        (attribute("WEIGHTS_0", np.full((4, 4), np.nan, np.float32)), "vertex 0 is negative, NaN"),
        (attribute("WEIGHTS_0", np.full((4, 4), -1, np.float32)), "vertex 0 is negative, NaN"),
        (attribute("JOINTS_0", np.zeros((3, 4), np.uint8)), "JOINTS_0: has 3 vertices, POSITION 4"),
        (
            lambda b: b.root["nodes"][2].update(skin=4),
            "nodes[2].skin: 4 is out of range, there are",
        ),
    ],
)
def test_broken_skins(damage: Callable[[GltfBuilder], object], reason: str, tmp_path: Path) -> None:
    builder = bent_strip()
    damage(builder)
    assert reason in refusal(builder, tmp_path)


def second_primitive(builder: GltfBuilder) -> None:
    builder.root["meshes"][0]["primitives"].append(builder.primitive(TRIANGLE))


def target_of(values: Any) -> Callable[[GltfBuilder], None]:
    def damage(builder: GltfBuilder) -> None:
        target = builder.root["meshes"][0]["primitives"][0]["targets"][0]
        target["POSITION"] = builder.accessor(np.asarray(values, np.float32))

    return damage


@pytest.mark.parametrize(
    ("damage", "reason"),
    [
        (second_primitive, "meshes[0]: its primitives differ in their number of morph targets"),
        (target_of(np.zeros((4, 3))), "targets[0].POSITION: has 4 vertices, POSITION 3"),
        (target_of(np.full((3, 3), np.inf)), "targets[0].POSITION: vertex 0 is NaN or infinite"),
        (
            lambda b: b.root["meshes"][0].update(weights=[1]),
            "meshes[0].weights: expected 2 numbers",
        ),
        (set_values([[0.0], [1.0]]), f"{OUT}: has 2 values, 2 keys of 2 need 4"),
    ],
)
def test_broken_morph_targets(
    damage: Callable[[GltfBuilder], object], reason: str, tmp_path: Path
) -> None:
    builder = morphing()
    damage(builder)
    assert reason in refusal(builder, tmp_path)
