"""What a scene file makes of its models' materials. SH-10"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cli.process import assert_refused, elemental
from cli.small_scene import write_corner
from elemental.core.errors import InputError
from elemental.core.images import write_png
from elemental.scene.load import load_scene
from elemental.scene.materials import Material, TextureSlot
from elemental.scene.model import Scene

RUST = """/*
[parameters]
amount = { type = "float", default = 0.5, min = 0, max = 1 }
mask = { type = "texture", default = "grey", srgb = false }
base_color_texture = { type = "texture", default = "white" }
*/
void material(inout Surface s, MaterialInput m, Parameters p) { s = standard_surface(m); }
"""


def write(folder: Path, tables: str) -> Path:
    """A scene file over the corner's model, with tables of materials."""
    write_corner(folder)
    (folder / "rust.glsl").write_text(RUST)
    write_png(folder / "dots.png", np.full((2, 2, 3), 99, np.uint8))
    path = folder / "scene.toml"
    path.write_text(f'[[models]]\nfile = "corner.gltf"\n{tables}')
    return path


def load(folder: Path, tables: str) -> Scene:
    return load_scene(write(folder, tables), default_lights=False)


def test_a_pattern_dresses_the_materials_that_it_fits(tmp_path: Path) -> None:
    plain = load(tmp_path, "")
    scene = load(
        tmp_path,
        '[[materials]]\nname = "*"\nshader = "rust.glsl"\ndouble_sided = true\n'
        'alpha_mode = "blend"\n'
        f'[[materials]]\nname = "{plain.materials[0].name}"\n'
        'parameters = { amount = 0.25, mask = "dots.png" }\n',
    )
    assert {m.definition.name for m in scene.materials} == {"rust"}
    assert all(m.double_sided and m.alpha_mode == "blend" for m in scene.materials)
    first, others = scene.materials[0], scene.materials[1:]
    assert first.value("amount") == 0.25
    assert all(m.value("amount") == 0.5 for m in others)
    dots = scene.textures[first.textures["mask"].texture]
    assert (dots.name, dots.pixels[0, 0].tolist()) == ("dots", [99, 99, 99, 255])
    np.testing.assert_array_equal(first.base_color, plain.materials[0].base_color)


def test_an_image_is_read_once_and_may_stand_for_gltf_s_own(tmp_path: Path) -> None:
    scene = load(
        tmp_path,
        '[[materials]]\nname = "*"\nshader = "rust.glsl"\n'
        'parameters = { mask = "dots.png", base_color_texture = "dots.png" }\n',
    )
    assert [t.name for t in scene.textures].count("dots") == 1
    slot = scene.materials[0].base_color_texture
    assert slot is not None
    assert scene.textures[slot.texture].name == "dots"
    assert scene.textures[slot.texture].file == tmp_path / "dots.png"


def test_a_plain_texture_takes_the_image_away(tmp_path: Path) -> None:
    image = 'parameters = { mask = "dots.png", base_color_texture = "dots.png" }\n'
    plain = 'parameters = { mask = "black", base_color_texture = "white" }\n'
    head = '[[materials]]\nname = "*"\n'
    tables = f'{head}shader = "rust.glsl"\n{image}{head}{plain}'
    material = load(tmp_path, tables).materials[0]
    assert material.base_color_texture is None
    assert not material.textures
    assert material.value("mask") == "black"


def test_an_image_lies_as_the_one_that_it_replaces() -> None:
    turned = np.array([[0, 2, 0], [-1, 0, 1]], np.float32)
    before = Material("m", normal_texture=TextureSlot(3, 1, turned))
    slot = before.with_image("normal_texture", 5).normal_texture
    assert slot is not None
    assert (slot.texture, slot.uv_set) == (5, 1)
    np.testing.assert_array_equal(slot.uv_from_uv, turned)
    assert before.with_image("base_color_texture", 5).base_color_texture == TextureSlot(
        5, 0, pytest.approx(np.eye(2, 3))
    )


def test_an_image_that_no_texture_holds_is_told_with_its_field(tmp_path: Path) -> None:
    path = write(tmp_path, '[[materials]]\nname = "*"\nparameters.base_color_texture = "wide.png"')
    write_png(tmp_path / "wide.png", np.zeros((1, 16385, 3), np.uint8))
    field = r"scene\.toml: materials\[0\]\.parameters\.base_color_texture"
    with pytest.raises(InputError, match=rf"{field}: wide\.png: is 16385 x 1 pixels"):
        load_scene(path, default_lights=False)


@pytest.mark.parametrize(
    ("tables", "complaint"),
    [
        ('name = "None"', "materials[0].name: no material is named 'None'; known: "),
        ('name = "*"\nshader = "laav"', "materials[0].shader: no material is named 'laav'; did"),
        ('name = "*"\nshader = "no.glsl"', "materials[0].shader: no.glsl: does not exist"),
        ('name = "*"\nshader = 3', "materials[0].shader: should be a text"),
        ('name = "*"\nparameters = { roughnes = 1 }', "materials[0].parameters.roughnes: is an"),
        ('name = "*"\nparameters = { roughness = 7 }', "parameters.roughness: should be 0 to 1"),
        ('name = "*"\nparameters = { roughness = "x" }', "roughness: should be a number"),
        (
            'name = "*"\nshader = "rust.glsl"\nparameters = { mask = "none.png" }',
            "materials[0].parameters.mask: none.png: does not exist",
        ),
        (
            'name = "*"\nshader = "rust.glsl"\nparameters = { mask = "rust.glsl" }',
            "rust.glsl: ",
        ),
    ],
)
def test_what_can_t_be_is_told_in_a_line(tmp_path: Path, tables: str, complaint: str) -> None:
    write(tmp_path, f"[[materials]]\n{tables}\n")
    assert_refused(elemental("shot", "scene.toml", "-o", "out.png", cwd=tmp_path), complaint)
