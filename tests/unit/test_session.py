"""What the doors settle before the first frame."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest

from cli.small_scene import corner as corner_gltf
from cli.small_scene import write_corner
from elemental.core.errors import InputError
from elemental.core.images import write_exr
from elemental.scene.model import Scene, framing_camera
from elemental.session import (
    Viewpoint,
    check_output,
    choose_camera,
    frame_file,
    known_name,
    open_scene,
    set_stage,
)
from elemental.settings import Settings
from gltf_builder import GltfBuilder


@pytest.fixture
def corner(tmp_path: Path) -> Scene:
    scene, _ = open_scene(str(write_corner(tmp_path)), ())
    return scene


def test_a_scene_opens_with_its_settings(tmp_path: Path) -> None:
    path = write_corner(tmp_path)
    scene, settings = open_scene(str(path), ["exposure=1"])
    assert scene.triangle_count == 6
    # Its lamp alone lights it, so light is gathered twice.
    assert settings.changed() == {"exposure": 1.0, "gi.bounces": 2}
    assert scene.lights == []  # the lamp emits: no default sun


def test_a_scene_that_only_its_emission_lights_says_so(tmp_path: Path) -> None:
    path = write_corner(tmp_path)
    scene, _ = open_scene(str(path), ())
    [note] = scene.notes
    assert note.startswith(f"{path}: lit by its own emission only; --set scene.default_lights=on")
    write_exr(tmp_path / "sky.exr", np.full((2, 4, 3), 0.5, np.float32))
    scene, _ = open_scene(str(path), [f"sky.image={tmp_path / 'sky.exr'}"])
    assert scene.notes == []
    scene, _ = open_scene(str(path), ["scene.default_lights=on"])
    assert [light.name for light in scene.lights] == ["default sun"]
    assert scene.environment is not None
    assert scene.notes == [f"{path}: a default sun and sky light it"]
    words = [f"sky.image={tmp_path / 'sky.exr'}", "scene.default_lights=on"]
    scene, _ = open_scene(str(path), words)
    assert scene.environment is not None
    assert scene.environment.radiance is not None  # the image, not the default's plain sky
    with pytest.raises(InputError, match="default_lights"):
        open_scene(str(path), ["scene.default_lights=true"])


def test_the_exposure_of_a_bright_sun_is_noted_unless_another_is_asked_for(tmp_path: Path) -> None:
    gltf = corner_gltf()
    gltf["extensionsUsed"] = ["KHR_lights_punctual"]
    sun = {"type": "directional", "intensity": 1e5}
    gltf["extensions"] = {"KHR_lights_punctual": {"lights": [sun]}}
    gltf["nodes"][3]["extensions"] = {"KHR_lights_punctual": {"light": 0}}
    path = tmp_path / "sunny.gltf"
    path.write_text(json.dumps(gltf))
    scene, settings = open_scene(str(path), ())
    assert settings["exposure"] == -15.0
    reason = "a sun of 100000 lux: exposure -15 EV; --set exposure=EV changes it"
    assert scene.notes == [f"{path}: {reason}"]
    assert bounds(settings) == (1.0, 1.0)  # in lux the eye's own bounds mean nothing
    scene, settings = open_scene(str(path), ["exposure=-12"])
    assert (settings["exposure"], scene.notes) == (-12.0, [])


def test_a_sun_brighter_than_any_exposure_gets_the_darkest(tmp_path: Path) -> None:
    gltf = corner_gltf()
    gltf["extensionsUsed"] = ["KHR_lights_punctual"]
    sun = {"type": "directional", "intensity": 1e38}
    gltf["extensions"] = {"KHR_lights_punctual": {"lights": [sun]}}
    gltf["nodes"][3]["extensions"] = {"KHR_lights_punctual": {"light": 0}}
    path = tmp_path / "sunny.gltf"
    path.write_text(json.dumps(gltf))
    assert open_scene(str(path), ())[1]["exposure"] == -16.0


def bounds(settings: Settings) -> tuple[float, float]:
    """What the eye adapts between, nit; equal: it does not. # PP-08"""
    low, high = (settings[f"eye_adaptation.{end}_brightness"] for end in ("min", "max"))
    return low, high


def test_the_eye_adapts_unless_a_scene_states_its_exposure(tmp_path: Path) -> None:
    path = write_corner(tmp_path)
    assert bounds(open_scene(str(path), ())[1]) == (0.03, 2.0)
    file = tmp_path / "stated.toml"
    model = f'[[models]]\nfile = "{path.name}"\n'
    file.write_text("exposure_ev = 0.0\n" + model)
    assert bounds(open_scene(str(file), ())[1]) == (1.0, 1.0)
    own = '[settings]\n"eye_adaptation.min_brightness" = 0.5\n'
    file.write_text("exposure_ev = 0.0\n" + own + model)
    assert bounds(open_scene(str(file), ())[1]) == (0.5, 1.0)
    asked = ["eye_adaptation.max_brightness=4"]
    assert bounds(open_scene(str(file), asked)[1]) == (0.5, 4.0)


def test_settings_lie_in_layers(tmp_path: Path) -> None:
    write_corner(tmp_path)
    (tmp_path / "corner.toml").write_text(
        'models = [{ file = "corner.gltf" }]\n[settings]\ngi = { bounces = 2, resolution = 64 }\n'
    )
    _, settings = open_scene(str(tmp_path / "corner.toml"), ["gi.resolution=256"])
    assert settings.changed() == {"gi.bounces": 2, "gi.resolution": 256}


def test_a_sky_image_replaces_the_environment(tmp_path: Path) -> None:
    sky = np.full((2, 4, 3), 0.5, np.float32)
    write_exr(tmp_path / "sky.exr", sky)
    words = [f"sky.image={tmp_path / 'sky.exr'}"]
    scene, _ = open_scene(str(write_corner(tmp_path)), words)
    assert scene.environment is not None
    np.testing.assert_array_equal(scene.environment.radiance, sky)


def test_the_scene_camera_is_taken_unless_another_is_asked_for(corner: Scene) -> None:
    assert choose_camera(corner, Viewpoint(), 1.5) is corner.cameras[0]
    assert choose_camera(corner, Viewpoint(camera="front"), 1.5) is corner.cameras[0]
    wide = choose_camera(corner, Viewpoint(fov_deg=90), 1.5)
    assert wide.fov_y == pytest.approx(math.pi / 2)
    assert wide.world_from_view is corner.cameras[0].world_from_view


def test_a_camera_path_is_followed_unless_a_camera_is_asked_for(tmp_path: Path) -> None:
    write_corner(tmp_path)
    (tmp_path / "ride.toml").write_text(
        'models = [{ file = "corner.gltf" }]\n[camera_path]\nkeys = [\n'
        "{ time = 0.0, eye = [0.0, 1.0, 4.0], target = [0.0, 1.0, 0.0] },\n"
        "{ time = 2.0, eye = [2.0, 1.0, 4.0], target = [2.0, 1.0, 0.0] }]\n"
    )
    ride = set_stage(str(tmp_path / "ride.toml"), (), Viewpoint(fov_deg=30), (8, 8))
    place = ride.camera_at(2.0).world_from_view[:3, 3]
    np.testing.assert_allclose(place, [2, 1, 4], atol=1e-5)
    assert ride.camera_at(1.0).fov_y == pytest.approx(math.radians(30))
    still = set_stage(str(tmp_path / "ride.toml"), (), Viewpoint(camera="front"), (8, 8))
    assert still.camera_at(2.0) is still.camera


def test_a_camera_by_place_looks_there(corner: Scene) -> None:
    camera = choose_camera(corner, Viewpoint(eye=(3, 4, 0), target=(0, 0, 0)), 1.5)
    np.testing.assert_allclose(camera.world_from_view[:3, 3], [3, 4, 0], atol=1e-6)
    np.testing.assert_allclose(-camera.world_from_view[:3, 2], [-0.6, -0.8, 0], atol=1e-6)
    assert camera.fov_y == corner.cameras[0].fov_y
    assert camera.near < 0.01  # of a scene of 3.5 m, whatever the file's camera says
    assert camera.far is None


def test_a_camera_by_place_sees_small_things_in_large_scenes(corner: Scene) -> None:
    """A thousandth of the scene, but no more than a hundredth of the way to what it looks at."""
    far = choose_camera(corner, Viewpoint(eye=(0, 1, 4), target=(0, 0, 0)), 1.5)
    near = choose_camera(corner, Viewpoint(eye=(0, 0, 0.01), target=(0, 0, 0)), 1.5)
    assert far.near == framing_camera(*corner.bounds(), 1.5).near
    assert near.near == pytest.approx(1e-4)


@pytest.mark.parametrize(
    "viewpoint",
    [
        Viewpoint(camera="nobody"),
        Viewpoint(eye=(0, 0, 1)),
        Viewpoint(target=(0, 0, 1)),
        Viewpoint(eye=(0, 0, 1), target=(0, 0, 1)),
        Viewpoint(camera="front", eye=(0, 0, 1), target=(0, 0, 0)),
    ],
)
def test_a_viewpoint_that_is_none_is_refused(corner: Scene, viewpoint: Viewpoint) -> None:
    with pytest.raises(InputError):
        choose_camera(corner, viewpoint, 1.5)


def test_bad_words_are_refused_before_a_file_is_read() -> None:
    with pytest.raises(InputError, match=r"gi\.resolution"):
        set_stage("nowhere.gltf", ["gi.resolution=3"], Viewpoint(), (8, 8))


def test_a_name_is_known_or_the_nearest_is_told() -> None:
    names = ["final", "normal", "depth"]
    assert known_name("--view", "depth", names) == "depth"
    with pytest.raises(InputError, match="did you mean 'final'"):
        known_name("--view", "finale", names)
    for far in ("", "colour"):
        with pytest.raises(InputError, match="known: final, normal, depth"):
            known_name("--view", far, names)


def test_outputs_are_checked_before_work_is_spent(tmp_path: Path) -> None:
    check_output("-o", tmp_path / "A.PNG", (".png", ".exr"))
    (tmp_path / "folder.png").mkdir()
    for path in ("a.gif", "a", "folder.png", "nowhere/a.png"):
        with pytest.raises(InputError, match="-o"):
            check_output("-o", tmp_path / path, (".png", ".exr"))


@pytest.mark.parametrize(
    ("pattern", "frame", "name"),
    [
        ("a.png", 7, "a.png"),
        ("a.%04d.png", 7, "a.0007.png"),
        ("a%d.png", 12, "a12.png"),
        ("%dx.png", 12, "12x.png"),
        ("a%2d.exr", 7, "a07.exr"),
        ("100%.png", 7, "100%.png"),
        ("100% a.png", 7, "100% a.png"),
        ("90%.b.png", 7, "90%.b.png"),
        ("grade 5%a_1.png", 7, "grade 5%a_1.png"),
        ("50%grey.%d.png", 7, "50%grey.7.png"),
        ("a%099d.png", 7, f"a{7:099d}.png"),
    ],
)
def test_frame_numbers_in_names(pattern: str, frame: int, name: str) -> None:
    assert frame_file(Path("out") / pattern, frame) == Path("out") / name


@pytest.mark.parametrize("pattern", ["q%99999999d.png", "q%0100d.png", "%d%100d.png"])
def test_a_frame_number_of_a_hundred_digits_is_refused(pattern: str) -> None:
    with pytest.raises(InputError, match="wider than 99 digits"):
        frame_file(Path(pattern), 0)


@pytest.mark.parametrize("pattern", ["a%s.png", "a%i", "%03x.b.png", "%5.2f.png", "%d%s.png"])
def test_what_is_nearly_a_frame_number_is_refused(pattern: str) -> None:
    with pytest.raises(InputError, match="is no frame number; %d or %04d is"):
        frame_file(Path(pattern), 0)


def test_the_command_line_chooses_the_animation_over_the_scene_file(tmp_path: Path) -> None:
    builder = GltfBuilder()
    node = builder.add(np.eye(3, dtype=np.float32))
    builder.animation((node, "translation", [0, 1], np.eye(3)[:2]), name="slide")
    builder.write(tmp_path / "slide.glb")
    path = tmp_path / "still.toml"
    path.write_text('models = [{ file = "slide.glb" }]\n[settings]\nscene.animation = "none"\n')
    for words, moves in (([], False), (["scene.animation=all"], True),
                         (["scene.animation=slide"], True)):  # fmt: skip
        scene, settings = open_scene(str(path), words)
        assert (scene.motion is not None) is moves
        assert settings["scene.animation"] == ("none" if not words else words[0].partition("=")[2])
    with pytest.raises(InputError, match="no animation is named 'run'; known: slide"):
        open_scene(str(path), ["scene.animation=run"])
