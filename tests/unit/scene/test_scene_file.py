"""Scene files: what they place, and every mistake at once."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import shapes
from elemental.core.errors import CombinedInputError, InputError
from elemental.core.images import write_exr
from elemental.scene.load import load_scene
from elemental.scene.model import Scene
from gltf_builder import GltfBuilder

MODEL = '[[models]]\nfile = "model.glb"\n'


@pytest.fixture(autouse=True)
def _model(tmp_path: Path) -> None:
    """model.glb: a textured box, a light and a camera."""
    builder = GltfBuilder()
    slot = {"index": builder.texture(np.zeros((2, 2, 3)))}
    material = builder.material(pbr={"baseColorTexture": slot})
    positions, indices = shapes.box()
    uv = positions[:, :2].copy()
    builder.add(positions, indices, uv0=uv, name="box", material=material, translation=[1, 0, 0])
    builder.light("spot", translation=[0, 1, 0], name="lamp")
    builder.camera(translation=[0, 0, 2], name="cam")
    builder.write(tmp_path / "model.glb")


def load(folder: Path, toml: str) -> Scene:
    path = folder / "scene.toml"
    path.write_text(toml, encoding="utf-8")
    return load_scene(path, default_lights=False)


def mistakes(folder: Path, toml: str) -> list[str]:
    with pytest.raises(InputError) as caught:
        load(folder, toml)
    start = f"{folder / 'scene.toml'}: "
    assert all(line.startswith(start) for line in caught.value.lines)
    assert str(caught.value) == "\n".join(caught.value.lines)
    return [line.removeprefix(start) for line in caught.value.lines]


def test_everything(tmp_path: Path) -> None:
    radiance = np.random.default_rng(1).random((4, 8, 3)).astype(np.float32)
    write_exr(tmp_path / "sky.exr", radiance)
    scene = load(
        tmp_path,
        """
        name = "Yard"
        exposure_ev = -1.5
        [[models]]
        file = "model.glb"
        translation = [0, 5, 0]
        rotation_deg = [0, 90, 0]
        scale = 2.0
        [[lights]]
        kind = "directional"
        direction = [0, -2, 0]
        intensity = 3
        [[lights]]
        kind = "spot"
        name = "beam"
        position = [0, 3, 0]
        direction = [1, 0, 0]
        color = [1, 0.5, 0]
        range = 7.0
        inner_angle_deg = 30
        outer_angle_deg = 45
        source_radius = 0.1
        casts_shadow = false
        [environment]
        file = "sky.exr"
        tint = [1, 1, 0.5]
        intensity = 2.0
        [[cameras]]
        name = "cam"
        eye = [0, 0, 5]
        target = [0, 0, 0]
        fov_y_deg = 60
        near = 0.2
        far = 50
        [camera_path]
        loop = true
        keys = [{ time = 0, eye = [0, 0, 5], target = [0, 0, 0] },
                { time = 2.5, eye = [5, 0, 0], target = [0, 0, 0] }]
        [[regions]]
        min = [-1, -1, -1]
        max = [1, 1, 1]
        level_offset = -2
        [settings]
        gi.resolution = 256
        "gi.enabled" = false
        """,
    )
    assert (scene.name, scene.exposure_ev) == ("Yard", -1.5)
    # The box's centre, 1 along the model's x: turned to -z, doubled, raised.
    centre = scene.instances[0].world_from_local @ np.array([0, 0, 0, 1])
    np.testing.assert_allclose(centre, [0, 5, -2, 1], atol=1e-6)
    sun, beam, lamp = scene.lights
    np.testing.assert_array_equal(sun.direction, [0, -1, 0])
    assert (sun.name, sun.kind, sun.intensity, sun.range) == (
        "directional0", "directional", 3.0, math.inf,
    )  # fmt: skip
    assert (beam.name, beam.range, beam.source_radius, beam.casts_shadow) == ("beam", 7, 0.1, False)
    assert beam.inner_angle == pytest.approx(math.pi / 6)
    np.testing.assert_allclose(lamp.position, [0, 7, 0], atol=1e-6)
    np.testing.assert_allclose(lamp.direction, [-1, 0, 0], atol=1e-6)
    assert scene.environment is not None
    np.testing.assert_array_equal(scene.environment.radiance, radiance)
    assert scene.environment.intensity == 2.0
    own, models = scene.cameras
    assert (own.name, models.name) == ("cam", "cam.2")
    assert (own.near, own.far) == (0.2, 50.0)
    np.testing.assert_allclose(own.world_from_view[:3, 3], [0, 0, 5], atol=1e-6)
    np.testing.assert_allclose(models.world_from_view[:3, 3], [4, 5, 0], atol=1e-6)
    np.testing.assert_allclose(np.linalg.det(models.world_from_view[:3, :3]), 1.0, atol=1e-6)
    assert scene.camera_path is not None
    assert scene.camera_path.loop
    assert scene.regions[0].level_offset == -2
    assert scene.settings == {"gi.resolution": 256, "gi.enabled": False}


def test_two_placements_share_meshes_and_two_models_do_not_mix(tmp_path: Path) -> None:
    other = GltfBuilder()
    other.add(*shapes.quad(), material=other.material((1, 0, 0, 1), name="red"))
    other.write(tmp_path / "other.glb")
    scene = load(
        tmp_path,
        MODEL + '[[models]]\nfile = "other.glb"\n' + MODEL + "translation = [9, 0, 0]\n",
    )
    assert [i.mesh for i in scene.instances] == [0, 1, 0]
    assert [scene.materials[m.material].name for m in scene.meshes] == ["material0", "red"]
    slot = scene.materials[0].base_color_texture
    assert slot is not None
    assert slot.texture == 0
    assert scene.instances[2].world_from_local[0, 3] == 10.0
    assert [camera.name for camera in scene.cameras] == ["cam", "cam.2"]


def test_every_mistake_is_a_line(tmp_path: Path) -> None:
    found = mistakes(
        tmp_path,
        MODEL
        + """
        size = 3
        exposure_ev = "bright"
        """.replace("\n        ", "\n")
        + """
        [[lights]]
        kind = "laser"
        [[lights]]
        kind = "point"
        intensity = -1
        position = [0, 0]
        [[cameras]]
        name = "a"
        eye = [0, 0, 0]
        [[regions]]
        min = [0, 0, 0]
        max = [1, 1, 1]
        level_offset = 3
        """,
    )
    assert found == [
        "models[0].size: is an unknown key",
        "models[0].exposure_ev: is an unknown key",
        "lights[0].kind: should be 'directional', 'point' or 'spot'",
        "lights[1].position: needs 3 items or more, not 2",
        "lights[1].intensity: should be 0 or more",
        "cameras[0].target: is missing",
        "regions[0].level_offset: should be 2 or less",
    ]


@pytest.mark.parametrize(
    ("toml", "expected"),
    [
        ("", "models: is missing"),
        ("models = []", "models: needs 1 items or more, not 0"),
        (MODEL + "scale = 0", "models[0].scale: should be greater than 0"),
        (MODEL + "scale = nan", "models[0].scale: should be a finite number"),
        (MODEL + 'scale = "2"', "models[0].scale: should be a number"),
        ('[[models]]\nfile = "none.glb"', "models[0].file: none.glb: does not exist"),
        (MODEL + "[sky]", "sky: is an unknown key"),
        (MODEL + '[[lights]]\nkind = "spot"', "lights[0]: a spot light needs a position"),
        (
            MODEL + '[[lights]]\nkind = "directional"\ndirection = [0, 0, 0]',
            "lights[0]: direction has length 0",
        ),
        (
            MODEL + '[[cameras]]\nname = "a"\neye = [1, 1, 1]\ntarget = [1, 1, 1]',
            "cameras[0]: eye and target are the same point",
        ),
        (
            MODEL + '[[cameras]]\nname = "a"\neye = [1, 1, 1]\ntarget = [0, 0, 0]\n' * 2,
            "cameras[1].name: another camera is named 'a'",
        ),
        (
            MODEL + "[[regions]]\nmin = [0, 0, 0]\nmax = [1, 0, 1]\nlevel_offset = 1",
            "regions[0]: max is not greater than min on every axis",
        ),
        (
            MODEL + "[camera_path]\nkeys = [{time = 1, eye = [0,0,0], target = [1,0,0]}, "
            "{time = 1, eye = [0,0,0], target = [1,0,0]}]",
            "camera_path: the keys' times do not increase",
        ),
    ],
)
def test_mistakes(toml: str, expected: str, tmp_path: Path) -> None:
    assert mistakes(tmp_path, toml) == [expected]


def test_no_toml(tmp_path: Path) -> None:
    for toml, reason in (
        ("a = ", "Invalid value (at end of document)"),
        ("[a\n", "line 1"),
        ("a = 1\na = 2", "Cannot overwrite a value"),
        (f"a = {'9' * 5000}", "a number has too many digits"),
        ("a = " + "[" * 5000, "nested too deeply"),
    ):
        (line,) = mistakes(tmp_path, toml)
        assert line.startswith("TOML: is broken")
        assert reason in line


def test_not_utf_8(tmp_path: Path) -> None:
    (tmp_path / "a.toml").write_bytes(b"\xff\xff")
    with pytest.raises(InputError, match=r"a\.toml: is not UTF-8 text \(byte 1\)"):
        load_scene(tmp_path / "a.toml", default_lights=False)


def test_a_byte_order_mark_is_no_mistake(tmp_path: Path) -> None:
    (tmp_path / "a.toml").write_bytes(b"\xef\xbb\xbf" + MODEL.encode())
    assert load_scene(tmp_path / "a.toml", default_lights=False).triangle_count == 12


def test_a_mistake_in_a_model_names_the_model(tmp_path: Path) -> None:
    (tmp_path / "bad.glb").write_bytes(b"glTF")
    with pytest.raises(InputError, match=r"bad\.glb: header: ") as caught:
        load(tmp_path, '[[models]]\nfile = "bad.glb"')
    assert not isinstance(caught.value, CombinedInputError)


WHOLE = (
    MODEL
    + """
[[lights]]
kind = "point"
position = [0, 1, 0]
[[cameras]]
name = "a"
eye = [0, 0, 5]
target = [0, 0, 0]
[[regions]]
min = [0, 0, 0]
max = [1, 1, 1]
level_offset = 1
[settings]
gi.resolution = 64
"""
)


@settings(max_examples=300, deadline=None, derandomize=True, database=None,
          suppress_health_check=list(HealthCheck))  # fmt: skip
@given(
    at=st.integers(0, len(WHOLE) - 1),
    length=st.integers(0, 12),
    text=st.sampled_from(
        ["", "=", "[", "[[x]]\n", '"', "\n", "-1", "1e400", "nan", "{}", "[1]", "\0", "true", "''"]
    ),
)
def test_edited_files_load_or_are_refused(at: int, length: int, text: str, tmp_path: Path) -> None:
    path = tmp_path / "scene.toml"
    path.write_text(WHOLE[:at] + text + WHOLE[at + length :], encoding="utf-8")
    try:
        scene = load_scene(path, default_lights=False)
    except InputError:
        return
    assert scene.triangle_count > 0


def test_a_model_that_stands_in_itself_is_warned_of(tmp_path: Path) -> None:
    covered = "models[1]: stands where models[0] of the same file does"
    for toml, expected in (
        (MODEL * 2, [covered]),
        (MODEL + MODEL + "scale = 2.0\n", []),
        (MODEL + MODEL + 'name = "b"\n[[motions]]\nmodel = "b"\nspin = { period = 1.0 }\n', []),
    ):
        told = load(tmp_path, toml).warnings
        assert told == [f"{tmp_path / 'scene.toml'}: {line}" for line in expected]


def test_settings_are_told_by_their_place(tmp_path: Path) -> None:
    toml = f"{MODEL}[settings]\nfoo.bar = 1\ngi = 1\n"
    assert mistakes(tmp_path, toml) == [
        "settings.foo.bar: unknown setting; see `elemental list settings`",
        "settings.gi: is a group of settings: gi.enabled, gi.resolution, gi.area_lights, …",
    ]
