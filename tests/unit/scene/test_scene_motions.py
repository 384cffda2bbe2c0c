"""Motions of scene files: orbits, spins and keys against closed forms, and their mistakes."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import shapes
from elemental.core.errors import InputError
from elemental.scene.evaluate import Pose, evaluate
from elemental.scene.load import load_scene
from elemental.scene.model import Scene
from gltf_builder import GltfBuilder

BOTH = '[[models]]\nfile = "still.glb"\n[[models]]\nfile = "mover.glb"\nname = "ball"\n'
PLACED = BOTH + "translation = [3, 1, 0]\nscale = 2.0\n"


@pytest.fixture(autouse=True)
def _models(tmp_path: Path) -> None:
    """still.glb: a box; mover.glb: one at x = 1, a lamp, a camera and a box that slides along y."""
    positions, indices = shapes.box()
    builder = GltfBuilder()
    builder.add(positions, indices, name="floor")
    builder.write(tmp_path / "still.glb")
    builder = GltfBuilder()
    builder.add(positions, indices, name="box", translation=[1, 0, 0])
    builder.light("spot", translation=[0, 1, 0], name="bulb")
    builder.camera(translation=[0, 0, 1], name="eye")
    slider = builder.add(positions, indices, name="slider")
    builder.animation((slider, "translation", [0, 1], [[0, 0, 0], [0, 4, 0]]), name="slide")
    builder.write(tmp_path / "mover.glb")


def load(folder: Path, toml: str, animation: str | None = None) -> Scene:
    path = folder / "scene.toml"
    path.write_text(toml, encoding="utf-8")
    return load_scene(path, default_lights=False, animation=animation)


def matrices(scene: Scene, pose: Pose) -> dict[str, np.ndarray]:
    names = [scene.instances[n].name for n in pose.instances]
    return dict(zip(names, pose.world_from_local, strict=True))


def test_models_animations_come_along(tmp_path: Path) -> None:
    scene = load(tmp_path, PLACED)
    assert [i.name for i in scene.instances if i.dynamic] == ["slider"]
    place = evaluate(scene, 0.25).world_from_local[0]
    np.testing.assert_allclose(place[:3, 3], [3, 3, 0], atol=1e-6)
    np.testing.assert_allclose(np.diag(place)[:3], 2.0)
    assert scene.animations == ["slide"]
    assert load(tmp_path, PLACED, "none").motion is None
    assert load(tmp_path, PLACED + '[settings]\nscene.animation = "none"\n').motion is None


def test_an_orbit_carries_a_model_and_what_belongs_to_it(tmp_path: Path) -> None:
    orbit = "orbit = { center = [1, 0, 0], period = 8.0 }"
    scene = load(tmp_path, f'{PLACED}[[motions]]\nmodel = "ball"\n{orbit}\n')
    assert [i.name for i in scene.instances] == ["floor", "box", "slider"]
    for t in (0.0, 1.0, 6.5):
        pose, angle = evaluate(scene, t), 2 * math.pi * t / 8.0
        placed = matrices(scene, pose)
        # About +y from +x towards -z; the box stands 2 + 2 from the centre.
        expected = [1 + 4 * math.cos(angle), 1, -4 * math.sin(angle)]
        np.testing.assert_allclose(placed["box"][:3, 3], expected, atol=1e-5)
        expected = [1 + 2 * math.cos(angle), 1 + 8 * (t % 1.0), -2 * math.sin(angle)]
        np.testing.assert_allclose(placed["slider"][:3, 3], expected, atol=1e-5)
        expected = [1 + 2 * math.cos(angle), 3, -2 * math.sin(angle)]
        np.testing.assert_allclose(pose.lights[0].position, expected, atol=1e-5)
        expected = [-math.sin(angle), 0, -math.cos(angle)]
        np.testing.assert_allclose(pose.lights[0].direction, expected, atol=1e-6)
        np.testing.assert_allclose(-pose.cameras[0].world_from_view[:3, 2], expected, atol=1e-6)
    low, high = scene.bounds()
    assert (low[[0, 2]] < [-3.9, -4.9]).all()
    assert (high[[0, 2]] > [5.9, 4.9]).all()


def test_a_spin_turns_a_model_about_its_origin(tmp_path: Path) -> None:
    spin = "spin = { axis = [0, 0, 2], period = -4.0 }"
    scene = load(tmp_path, f'{PLACED}[[motions]]\nmodel = "ball"\n{spin}\n')
    place = matrices(scene, evaluate(scene, 1.0))["box"]
    np.testing.assert_allclose(place[:3, 3], [3, -1, 0], atol=1e-6)  # a quarter, clockwise
    np.testing.assert_allclose(place[:3, 0], [0, -2, 0], atol=1e-6)


KEYS = """
keys = [{ time = 0 },
        { time = 2, translation = [0, 0, 4], rotation_deg = [0, 90, 0], scale = 3.0 },
        { time = 3, translation = [0, 0, 4], visible = false }]
"""


@pytest.mark.parametrize("key", ["scale = 0", "visible = false"])
def test_a_scene_that_never_shows_is_named_as_such(tmp_path: Path, key: str) -> None:
    motion = f'[[motions]]\nmodel = "still"\nkeys = [{{time = 0, {key}}}, {{time = 1, {key}}}]'
    with pytest.raises(InputError) as caught:
        load(tmp_path, f'[[models]]\nfile = "still.glb"\n{motion}')
    reason = "nothing shows: 1 meshes are scaled to 0 or hidden at all times"
    assert str(caught.value) == f"{tmp_path / 'scene.toml'}: {reason}"


def test_keys_move_turn_scale_and_hide(tmp_path: Path) -> None:
    scene = load(tmp_path, f'{PLACED}[[motions]]\nmodel = "ball"\n{KEYS}')
    place = matrices(scene, evaluate(scene, 1.0))["box"]
    # Half way: 2 along z, an eighth of a turn about y, twice as large.
    half = math.sqrt(0.5)
    np.testing.assert_allclose(place[:3, 3], [3 + 4 * half, 1, 2 - 4 * half], atol=1e-5)
    np.testing.assert_allclose(place[:3, 0], [4 * half, 0, -4 * half], atol=1e-5)
    assert evaluate(scene, 2.9).visible.all()
    held = load(tmp_path, f'{PLACED}[[motions]]\nmodel = "ball"\nloop = false\n{KEYS}')
    assert not evaluate(held, 7.0).visible.any()
    assert evaluate(scene, 7.0).visible.all()


@pytest.mark.parametrize(
    ("interpolation", "expected"), [("step", 0.0), ("linear", 0.5), ("smooth", 0.375)]
)
def test_interpolation_of_keys(interpolation: str, expected: float, tmp_path: Path) -> None:
    """Keys 0, 1, 4 at times 0, 1, 2: the smooth curve's slopes are 1 and 2, so that half way it is
    1/2 + (1 - 2)/8."""
    keys = ", ".join(
        f"{{ time = {t}, translation = [{x}, 0, 0] }}" for t, x in ((0, 0), (1, 1), (2, 4))
    )
    motion = f'[[motions]]\nmodel = "ball"\ninterpolation = "{interpolation}"\nkeys = [{keys}]\n'
    scene = load(tmp_path, PLACED + motion)
    place = matrices(scene, evaluate(scene, 0.5))["box"]
    np.testing.assert_allclose(place[0, 3], 5 + expected, atol=1e-6)


LIGHT = """
[[lights]]
kind = "spot"
name = "beam"
position = [2, 5, 0]
direction = [0, -1, 0]
"""


def test_lights_orbit_and_turn(tmp_path: Path) -> None:
    orbit = "orbit = { center = [0, 0, 0], axis = [0, 0, 1], period = 4.0 }"
    scene = load(tmp_path, f'{BOTH}{LIGHT}[[motions]]\nlight = "beam"\n{orbit}\n')
    beam = evaluate(scene, 1.0).lights[0]
    np.testing.assert_allclose(beam.position, [-5, 2, 0], atol=1e-5)
    np.testing.assert_allclose(beam.direction, [1, 0, 0], atol=1e-5)
    np.testing.assert_allclose(scene.lights[0].position, [2, 5, 0], atol=1e-6)


MOTION = '[[motions]]\nmodel = "ball"\nspin = { period = 1.0 }\n'


@pytest.mark.parametrize(
    ("toml", "reason"),
    [
        ('[[motions]]\nspin = { period = 1.0 }\n', "motions[0]: names either a model or a light"),
        ('[[motions]]\nmodel = "ball"\n', "motions[0]: has neither keys nor an orbit nor a spin"),
        (MOTION.replace("ball", "bell"), "motions[0].model: no model is named 'bell'"),
        (MOTION.replace("model", "light"), "motions[0].light: no light is named 'ball'"),
        (MOTION * 2, "motions[1].model: 'ball' already has a motion"),
        (MOTION.replace("1.0", "0.0"), "motions[0].spin: period is less than 0.001 s"),
        (MOTION.replace("period", "axis = [0, 0, 0], period"),
         "motions[0].spin: axis has length 0"),
        (MOTION.replace("{ period", "{ center = [0, 0, 0], period"),
         "motions[0].spin.center: is an unknown key"),
        ('[[motions]]\nmodel = "ball"\nkeys = [{ time = 0 }]\n',
         "motions[0].keys: needs 2 items or more, not 1"),
        ('[[motions]]\nmodel = "ball"\nkeys = [{ time = 1 }, { time = 1 }]\n',
         "motions[0]: the keys' times do not increase"),
        ('[[models]]\nfile = "still.glb"\nname = "ball"\n' + MOTION,
         "models[2].name: another model is named 'ball'"),
        ('[settings]\nscene.animation = "walk"\n',
         "settings.scene.animation: no animation is named 'walk'; known: slide"),
    ],
)  # fmt: skip
def test_mistakes(toml: str, reason: str, tmp_path: Path) -> None:
    with pytest.raises(InputError) as caught:
        load(tmp_path, PLACED + toml)
    assert str(caught.value) == f"{tmp_path / 'scene.toml'}: {reason}"
