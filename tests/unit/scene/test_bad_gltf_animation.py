"""Animations, skins and morph targets of glTF files that are refused or left out."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from elemental.core.errors import InputError
from elemental.scene.load import load_scene
from gltf_builder import GltfBuilder
from unit.scene.gltf_motion import (
    TRIANGLE,
    TWO,
    bent_strip,
    morphing,
    moved_triangle,
)


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
