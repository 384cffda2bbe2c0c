"""Files that scene files name: found from the scene's folder, and told by field where they fail."""

from __future__ import annotations

import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from cli.small_scene import write_corner
from elemental.core.errors import InputError
from elemental.core.images import write_exr, write_png
from elemental.core.paths import content_root, named_file
from elemental.scene.load import load_scene
from elemental.scene.save_names import name_in
from elemental.scene.save_scene import Changes, save_scene
from elemental.session import open_scene
from elemental.ui.editor import reopening_words

LUT = "color_grading.lut"
MODEL = '[[models]]\nfile = "corner.gltf"\n'
VOLUME = '[[volumes]]\nname = "v"\nunbound = true\n'
CUBE = "LUT_1D_SIZE 2\n0 0 0\n1 1 1\n"
IES = "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 1 1 2 0 0 0\n1 1 9\n0 45 90\n0\n200 100 0\n"


@pytest.fixture
def show(tmp_path: Path) -> Path:
    """A folder with a model, a table of colours, a sky and files that are none of these."""
    folder = tmp_path / "show"
    folder.mkdir()
    write_corner(folder)
    (folder / "look.cube").write_text(CUBE)
    write_exr(folder / "sky.exr", np.full((2, 4, 3), 0.5, np.float32))
    write_png(folder / "mask.png", np.full((2, 2, 3), 9, np.uint8))
    for name in ("bad.cube", "bad.hdr", "bad.exr", "bad.png", "bad.ies", "bad.glb", "bad.glsl"):
        (folder / name).write_bytes(b"hello")
    (folder / "folder").mkdir()
    (folder / "latin.glsl").write_bytes(b"/* k\xf6rnig */")
    return folder


def scene_file(folder: Path, text: str) -> Path:
    path = folder / "show.toml"
    path.write_text(MODEL + text, encoding="utf-8")
    return path


def test_names_count_from_the_scene_then_from_what_ships(
    show: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(show.parent)
    (show.parent / "look.cube").write_text("nonsense")  # of the working directory: not meant
    text = f'[settings]\n{LUT} = "look.cube"\nsky.image = "sky.exr"\n'
    scene, settings = open_scene(str(scene_file(show, text)), ())
    assert named_file(settings[LUT], scene.folder) == show / "look.cube"
    assert scene.environment is not None
    assert scene.environment.radiance is not None
    text = f'[settings]\n{LUT} = "neutral.cube"\n{VOLUME}settings.bloom.dirt_mask = "dirt.png"\n'
    scene, settings = open_scene(str(scene_file(show, text)), ())
    textures = content_root() / "textures"
    assert named_file(settings[LUT], scene.folder) == textures / "neutral.cube"
    (show / "neutral.cube").write_text(CUBE)
    assert named_file(settings[LUT], scene.folder) == show / "neutral.cube"


def test_names_on_the_command_line_count_from_where_it_is_typed(
    show: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(show.parent)
    path = scene_file(show, "")
    (show.parent / "look.cube").write_text(CUBE)
    scene, settings = open_scene(str(path), [f"{LUT}=look.cube"])
    assert named_file(settings[LUT], scene.folder) == show.parent / "look.cube"
    for name, reason in (("none.cube", "does not exist"), ("show", "is a folder")):
        with pytest.raises(InputError) as refused:
            open_scene(str(path), [f"sky.image={name}"])
        assert str(refused.value) == f"--set: sky.image: {name}: {reason}"


NAMED = [
    (f'[settings]\n{LUT} = "none.cube"', f"settings.{LUT}: none.cube: does not exist"),
    (f'[settings]\n{LUT} = "corner.gltf"', f"settings.{LUT}: corner.gltf: expected a .cube file"),
    (f'[settings]\n{LUT} = "bad.cube"', f"settings.{LUT}: bad.cube: line 1: unknown keyword"),
    ('[settings]\nsky.image = "none.hdr"', "settings.sky.image: none.hdr: does not exist"),
    ('[settings]\nsky.image = "bad.hdr"', "settings.sky.image: bad.hdr: not a Radiance .hdr file"),
    (
        '[settings]\nlens_flare.bokeh_shape = "bad.png"',
        "settings.lens_flare.bokeh_shape: bad.png: not a PNG, JPEG or WebP image",
    ),
    (
        f'{VOLUME}enabled = false\nsettings.{LUT} = "none.cube"',
        f"volumes[0].settings.{LUT}: none.cube: does not exist",
    ),
    (
        f'{VOLUME}settings.bloom.dirt_mask = "folder"',
        "volumes[0].settings.bloom.dirt_mask: folder: is a folder",
    ),
    ('[environment]\nfile = "none.hdr"', "environment.file: none.hdr: does not exist"),
    ('[environment]\nfile = "folder"', "environment.file: folder: is a folder"),
    ('[environment]\nfile = "mask.png"', "environment.file: mask.png: expected an .hdr or .exr"),
    ('[environment]\nfile = "bad.exr"', "environment.file: bad.exr: not an OpenEXR file, or a"),
    (
        '[[lights]]\nkind = "point"\nposition = [0, 1, 0]\nies = "bad.ies"',
        "lights[0].ies: bad.ies: TILT: is missing: not an IES LM-63 file",
    ),
    ('[[models]]\nfile = "bad.glb"', "models[1].file: bad.glb: header: the file has 5 bytes"),
    ('[[models]]\nfile = "show.toml"', "models[1].file: show.toml: expected a .gltf or .glb file"),
    ('[[models]]\nfile = "folder"', "models[1].file: folder: expected a .gltf or .glb file"),
    (
        '[[materials]]\nname = "*"\nparameters = { base_color_texture = "bad.png" }',
        "materials[0].parameters.base_color_texture: bad.png: not a PNG, JPEG or WebP image",
    ),
    (
        '[[materials]]\nname = "*"\nshader = "bad.glsl"',
        "materials[0].shader: bad.glsl: heading: the file does not begin with a comment",
    ),
    (
        '[[materials]]\nname = "*"\nshader = "latin.glsl"',
        "materials[0].shader: latin.glsl: is not UTF-8 text (byte 5)",
    ),
]


@pytest.mark.parametrize(("text", "reason"), NAMED, ids=[reason for _, reason in NAMED])
def test_what_is_wrong_with_a_file_names_scene_and_field(
    show: Path, text: str, reason: str
) -> None:
    path = scene_file(show, text)
    with pytest.raises(InputError) as refused:
        open_scene(str(path), ())
    assert str(refused.value).startswith(f"{path}: {reason}")
    assert len(refused.value.lines) == 1
    assert "<" not in str(refused.value)  # no object of ours


def test_saved_elsewhere_settings_and_volumes_name_the_same_files(show: Path) -> None:
    text = (
        f'[settings]\n{LUT} = "look.cube"\nlens_flare.bokeh_shape = "bokeh_disc.png"\n'
        f'{VOLUME}settings.{LUT} = "look.cube"\n'
    )
    path = scene_file(show, text)
    scene = load_scene(path, default_lights=False)
    there = show.parent / "there"
    there.mkdir()
    target = there / "again.toml"
    mask = {"bloom.dirt_mask": "mask.png"}
    edited = [replace(v, overrides={**v.overrides, **mask}) for v in scene.volumes]
    changes = Changes(mask, edited)
    save_scene(path, target, changes)
    saved = tomllib.loads(target.read_text())
    assert saved["settings"]["color_grading"]["lut"] == "../show/look.cube"
    assert saved["settings"]["lens_flare"]["bokeh_shape"] == "bokeh_disc.png"
    again, settings = open_scene(str(target), ())
    assert settings["bloom.dirt_mask"] == "../show/mask.png"
    assert again.volumes[0].overrides == {LUT: "../show/look.cube", **dict(mask, **{
        "bloom.dirt_mask": "../show/mask.png"
    })}  # fmt: skip
    # Edited once more, the names still count from where the scene was opened.
    save_scene(target, target, changes, scene.folder)
    assert load_scene(target, default_lights=False).volumes == again.volumes


def test_names_of_things_are_no_files_when_a_scene_moves(show: Path) -> None:
    path = scene_file(show, '[[cameras]]\nname = "mask.png"\neye = [0, 0, 1]\ntarget = [0, 0, 0]\n')
    save_scene(path, show.parent / "moved.toml", Changes())
    assert (
        tomllib.loads((show.parent / "moved.toml").read_text())["cameras"][0]["name"] == "mask.png"
    )


def test_a_chosen_file_gets_a_short_name(show: Path) -> None:
    assert name_in(show, show / "folder" / "a.cube") == "folder/a.cube"
    assert name_in(show, content_root() / "textures" / "neutral.cube") == "neutral.cube"
    assert name_in(show, show.parent / "a.cube") == str(show.parent / "a.cube")


def test_a_scene_is_reopened_with_the_file_that_it_shows(
    show: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(show.parent)
    (show.parent / "sky.exr").write_bytes(b"of the working directory")
    path = scene_file(show, '[settings]\nsky.image = "sky.exr"\n')
    scene, settings = open_scene(str(path), ())
    assert f"sky.image={show / 'sky.exr'}" in reopening_words(settings, scene.folder)
