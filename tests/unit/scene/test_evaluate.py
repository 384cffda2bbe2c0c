"""Tracks, node trees and boxes against closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from elemental.core import transforms
from elemental.scene.evaluate import composed, evaluate, sample, slerp
from elemental.scene.model import Camera, Instance, Light, Scene
from elemental.scene.motion import F64, Interpolation, Path, Rig, RigBuilder, Tracks
from gpu.rig import IDENTITY, mesh, scene, vector
from shapes import box

FUZZ = settings(max_examples=60, deadline=None, database=None, derandomize=True)
UNIT_Z = np.array([0.0, 0.0, 1.0])


def about(axis: F64, angle: float) -> F64:
    return np.append(np.sin(angle / 2) * axis, math.cos(angle / 2))


def tracks(
    values: object,
    times: object = (0.0, 1.0, 3.0),
    path: Path = "translation",
    interpolation: Interpolation = "linear",
    node: int = 0,
    loop: bool = True,
) -> Tracks:
    keys, t = np.array(values, np.float64), np.array(times, np.float64)
    return Tracks(path, np.array([node]), t, keys[None], interpolation, float(t[-1]), loop)


POINTS = [[0.0, 0, 0], [2.0, 4, 0], [2.0, 0, 8]]


@pytest.mark.parametrize(
    ("interpolation", "time_s", "expected"),
    [
        ("linear", 0.0, [0, 0, 0]),
        ("linear", 0.25, [0.5, 1, 0]),
        ("linear", 1.0, [2, 4, 0]),
        ("linear", 2.5, [2, 1, 6]),
        ("linear", 3.25, [0.5, 1, 0]),  # starts over
        ("linear", -0.5, [2, 1, 6]),
        ("step", 0.99, [0, 0, 0]),
        ("step", 1.0, [2, 4, 0]),
        ("step", 2.999, [2, 4, 0]),
    ],
)
def test_points_between_keys(
    interpolation: Interpolation, time_s: float, expected: list[float]
) -> None:
    got = sample(tracks(POINTS, interpolation=interpolation), time_s)
    np.testing.assert_allclose(got, [expected], atol=1e-12)


def test_before_the_first_key_and_after_the_last_one_values_are_held() -> None:
    held = tracks(POINTS, (1.0, 2.0, 3.0), loop=False)
    np.testing.assert_array_equal(sample(held, 0.0), [POINTS[0]])
    np.testing.assert_array_equal(sample(held, 50.0), [POINTS[2]])
    # A loop's beginning is 0, not its first key.
    late = tracks(POINTS, (1.0, 2.0, 3.0))
    np.testing.assert_array_equal(sample(late, 3.5), [POINTS[0]])


def test_a_cubic_track_is_the_parabola_whose_slopes_it_has() -> None:
    times = np.array([0.0, 0.5, 2.0])
    keys = [[[2 * t] * 3, [t * t] * 3, [2 * t] * 3] for t in times]
    for t in np.linspace(0.0, 1.999, 23):
        got = sample(tracks(keys, times, interpolation="cubic"), float(t))
        np.testing.assert_allclose(got, [[t * t] * 3], atol=1e-12)


def test_a_cubic_turn_through_0_takes_the_nearer_key() -> None:
    """From q to -q without tangents the curve has no direction half way; glTF allows that."""
    turn = np.array([0.0, 0.6, 0.0, 0.8])
    keys = [[np.zeros(4), turn, np.zeros(4)], [np.zeros(4), -turn, np.zeros(4)]]
    made = tracks(keys, (0.0, 1.0), "rotation", interpolation="cubic")
    for t in (0.0, 0.25, 0.5, 0.75):
        matrix = composed(np.zeros((1, 3)), sample(made, t), np.ones((1, 3)))
        wanted = composed(np.zeros((1, 3)), turn[None], np.ones((1, 3)))
        np.testing.assert_allclose(matrix, wanted, atol=1e-12)


def test_a_quarter_turn_is_even_and_takes_the_shorter_way() -> None:
    ends = [about(UNIT_Z, 0.3), -about(UNIT_Z, 0.3 + math.pi / 2)]
    turn = tracks(ends, (0.0, 2.0), "rotation")
    for t in (0.0, 0.4, 1.0, 1.7):
        got = sample(turn, t)[0]
        want = about(UNIT_Z, 0.3 + t / 2.0 * math.pi / 2)
        np.testing.assert_allclose(got * np.sign(got @ want), want, atol=1e-12)


quaternions = arrays(np.float64, 4, elements=st.floats(-1, 1)).filter(
    lambda q: np.linalg.norm(q) > 1e-3
)


@FUZZ
@given(a=quaternions, b=quaternions, s=st.floats(0, 1))
def test_slerp_divides_the_angle(a: F64, b: F64, s: float) -> None:
    a, b = a / np.linalg.norm(a), b / np.linalg.norm(b)
    got = slerp(a[None], b[None], s)[0]
    assert np.linalg.norm(got) == pytest.approx(1.0)
    angle = 2 * math.acos(min(abs(a @ b), 1.0))
    assert 2 * math.acos(min(abs(a @ got), 1.0)) == pytest.approx(s * angle, abs=2e-4)
    back = slerp(b[None], a[None], 1.0 - s)[0]
    if angle < math.pi - 1e-3:
        assert abs(back @ got) == pytest.approx(1.0)


@FUZZ
@given(
    translation=arrays(np.float64, 3, elements=st.floats(-10, 10)),
    rotation=quaternions,
    scale=arrays(np.float64, 3, elements=st.floats(-3, 3)),
)
def test_composed_is_translation_rotation_scale(
    translation: F64, rotation: F64, scale: F64
) -> None:
    got = composed(translation[None], rotation[None], scale[None])[0]
    np.testing.assert_allclose(got, transforms.compose(translation, rotation, scale), atol=1e-5)


def moving(builder: RigBuilder, *nodes: int) -> Scene:
    """A scene of unit boxes that stand on nodes of a rig."""
    made = scene(*[(mesh(box()), IDENTITY) for _ in nodes])
    for instance, node in zip(made.instances, nodes, strict=True):
        instance.dynamic, instance.node = True, node
    made.motion = builder.motion()
    return made


def test_a_moon_rides_on_its_planet() -> None:
    """Two turning nodes with arms: a closed form of sums of circles."""
    builder = RigBuilder()
    planet = builder.node()
    moon = builder.node(planet, translation=[5, 0, 0])
    rock = builder.node(moon, translation=[1, 0, 0])
    turn = [about(UNIT_Z, a) for a in np.linspace(0, 2 * math.pi, 4)]
    builder.tracks = [
        tracks(turn, np.linspace(0, 8, 4), "rotation", node=planet),
        tracks(turn, np.linspace(0, 2, 4), "rotation", node=moon),
    ]
    world = moving(builder, rock)
    for t in (0.0, 0.7, 3.0, 11.25):
        a, b = 2 * math.pi * t / 8, 2 * math.pi * t * (1 / 8 + 1 / 2)
        expected = [5 * math.cos(a) + math.cos(b), 5 * math.sin(a) + math.sin(b), 0]
        pose = evaluate(world, t)
        np.testing.assert_allclose(pose.world_from_local[0][:3, 3], expected, atol=1e-5)


def test_offsets_stand_between_a_node_and_its_parent() -> None:
    builder = RigBuilder()
    lifted = transforms.compose([0, 3, 0], [0, 0, 0, 1], [2, 2, 2])
    root = builder.node(offset=lifted)
    leaf = builder.node(root, offset=transforms.compose([1, 0, 0], [0, 0, 0, 1], [1, 1, 1]))
    builder.tracks = [tracks([[0.0, 0, 0], [1.0, 0, 0]], (0, 1), node=root)]
    pose = evaluate(moving(builder, leaf), 0.5)
    np.testing.assert_allclose(pose.world_from_local[0][:3, 3], [3, 3, 0], atol=1e-6)


def test_what_is_hidden_or_scaled_to_nothing_is_not_visible() -> None:
    builder = RigBuilder()
    hidden = builder.node()
    child = builder.node(hidden)
    shrunk = builder.node(scale=[1, 1, 1])
    builder.tracks = [
        tracks([[1.0], [0.0], [1.0]], path="visible", interpolation="step", node=hidden),
        tracks([[1.0, 1, 1], [1.0, 0, 1], [1.0, 1, 1]], path="scale", node=shrunk),
    ]
    world = moving(builder, hidden, child, shrunk)
    shown = [evaluate(world, t).visible.tolist() for t in (0.5, 1.0, 1.5)]
    assert shown == [[True] * 3, [False] * 3, [False, False, True]]


def test_the_last_of_two_tracks_wins() -> None:
    builder = RigBuilder()
    node = builder.node()
    builder.tracks = [tracks(np.full((3, 3), k), node=node) for k in (1.0, 2.0)]
    pose = evaluate(moving(builder, node), 0.5)
    np.testing.assert_array_equal(pose.world_from_local[0][:3, 3], [2, 2, 2])


def test_lights_and_cameras_ride_along() -> None:
    builder = RigBuilder()
    node = builder.node()
    builder.tracks = [
        tracks([[0.0, 0, 0], [4.0, 0, 0]], (0, 1), node=node),
        tracks([about(np.array([0, 1.0, 0]), a) for a in (0, math.pi / 2)], (0, 1), "rotation"),
        tracks([[1.0], [1.0], [0.0]], (0, 0.9, 1), "visible", "step"),
    ]
    world = moving(builder)
    zero, down = vector(0, 0, 0), vector(0, -1, 0)
    world.lights = [Light("lamp", "spot", vector(1, 1, 1), 5.0, zero, down, node=node),
                    Light("still", "point", vector(1, 1, 1), 1.0, zero, down)]  # fmt: skip
    world.cameras = [Camera("ride", IDENTITY, 1.0, 0.1, node=node)]
    pose = evaluate(world, 0.5)
    np.testing.assert_allclose(pose.lights[0].position, [2, 0, 0], atol=1e-6)
    half = math.sqrt(0.5)
    np.testing.assert_allclose(pose.lights[0].direction, [-half, 0, -half], atol=1e-6)
    assert pose.lights[0].intensity == 5.0
    assert pose.lights[1] is world.lights[1]
    view = pose.cameras[0].world_from_view
    np.testing.assert_allclose(view[:3, 3], [2, 0, 0], atol=1e-6)
    np.testing.assert_allclose(-view[:3, 2], [-half, 0, -half], atol=1e-6)


def test_a_hidden_light_is_dark() -> None:
    builder = RigBuilder()
    node = builder.node()
    builder.tracks = [tracks([[0.0], [1.0], [0.0]], path="visible", interpolation="step")]
    world = moving(builder)
    lamp = Light("lamp", "point", vector(1, 1, 1), 5.0, vector(0, 0, 0), vector(0, -1, 0))
    lamp.node = node
    world.lights = [lamp]
    assert [evaluate(world, t).lights[0].intensity for t in (0.5, 1.5)] == [0.0, 5.0]


def test_still_instances_are_not_in_the_pose() -> None:
    builder = RigBuilder()
    node = builder.node()
    builder.tracks = [tracks(POINTS, node=node)]
    world = moving(builder, node)
    world.instances.insert(0, Instance("still", 0, IDENTITY))
    assert evaluate(world, 0.0).instances.tolist() == [1]


def test_levels_put_parents_before_children() -> None:
    rig = Rig(
        np.array([-1, 0, -1, 1, 0]), *(np.zeros((5, 4, 4)), np.zeros((5, 3))),
        np.zeros((5, 4)), np.zeros((5, 3)),
    )  # fmt: skip
    assert [level.tolist() for level in rig.levels] == [[0, 2], [1, 4], [3]]
