"""Headings of artist's materials: what they may say, and what is told of broken ones. SH-10"""

from __future__ import annotations

from pathlib import Path

import pytest

from elemental.core.errors import InputError
from elemental.passes.material_pack import pack_parameters
from elemental.passes.material_snippets import prelude
from elemental.scene.definitions import (
    COMMON_PARAMETERS,
    STANDARD,
    builtin,
    definition_names,
    find_definition,
    read_definition,
)
from elemental.scene.materials import Material

HEADING = """/*
help = "rust over metal"
animated = true
emits = ["glow", "strength"]

[parameters]
amount = { type = "float", default = 0.5, min = 0, max = 1, help = "how much" }
glow = { type = "color", default = [1, 0.5, 0.25] }
strength = { type = "float", default = 4, unit = "nit" }
steps = { type = "int", default = 3, min = 1, max = 9 }
wet = { type = "bool", default = true }
offset = { type = "vec2", default = [0.25, -2] }
tint = { type = "rgba", default = [1, 0.5, 0.25, 0.75] }
mask = { type = "texture", default = "grey", srgb = false }
roughness = { type = "float", default = 1, min = 0, max = 1 }
*/
void material(inout Surface s, MaterialInput m, Parameters p) {}
"""


def write(folder: Path, text: str, name: str = "rust") -> Path:
    path = folder / f"{name}.glsl"
    path.write_text(text)
    return path


def test_a_heading_becomes_typed_parameters(tmp_path: Path) -> None:
    rust = read_definition(write(tmp_path, HEADING))
    assert (rust.name, rust.help, rust.animated) == ("rust", "rust over metal", True)
    kinds = [(p.name, p.kind) for p in rust.parameters]
    assert kinds[:3] == [("amount", "float"), ("glow", "color"), ("strength", "float")]
    amount, glow = rust.parameters[:2]
    assert (amount.default, amount.low, amount.high, amount.help) == (0.5, 0.0, 1.0, "how much")
    assert (glow.default, glow.low, rust.parameters[2].unit) == ((1.0, 0.5, 0.25), 0.0, "nit")
    assert [p.name for p in rust.textures] == ["mask"]
    assert not rust.textures[0].is_srgb
    assert "roughness" not in rust.places()  # it is the file's own


def test_values_lie_where_the_shader_reads_them(tmp_path: Path) -> None:
    """Declaration order, and none straddles a vec4."""
    rust = read_definition(write(tmp_path, HEADING))
    assert rust.places() == {
        "amount": 0, "glow": 1, "strength": 4, "steps": 5, "wet": 6, "offset": 8, "tint": 12,
    }  # fmt: skip
    material = Material("m", definition=rust).with_value("offset", [7, 8]).with_value("steps", 5)
    packed = pack_parameters(material).reshape(-1)
    assert packed[:14].tolist() == [0.5, 1, 0.5, 0.25, 4, 5, 1, 0, 7, 8, 0, 0, 1, 0.5]
    text = prelude(rust)
    assert "p.glow = materials[material].parameters[0].yzw;" in text
    assert "p.offset = materials[material].parameters[2].xy;" in text
    assert "p.steps = int(materials[material].parameters[1].y);" in text
    assert "p.roughness = materials[material].roughness;" in text
    assert "uniform sampler2D u_mask;" in text


def test_emission_is_bounded_by_the_parameters_it_comes_from(tmp_path: Path) -> None:
    material = Material("m", definition=read_definition(write(tmp_path, HEADING)))
    assert material.emission_max == 4.0
    assert material.with_value("glow", [0, 0.5, 0]).with_value("strength", 10).emission_max == 5.0
    assert Material("m").emission_max == 0.0


@pytest.mark.parametrize("name", definition_names())
def test_those_that_come_along_can_be_drawn_by_a_panel(name: str) -> None:
    definition = builtin(name)
    assert definition.help
    for parameter in definition.parameters:
        assert parameter.help, parameter.name
        if parameter.kind not in ("texture", "bool"):
            assert parameter.range_text(), parameter.name
            assert parameter.checked(parameter.default, "", "") == parameter.default


def test_the_standard_material_has_all_that_gltf_has() -> None:
    assert [p.name for p in builtin(STANDARD).parameters] == list(COMMON_PARAMETERS)


def test_a_definition_may_take_gltf_s_parameters_along(tmp_path: Path) -> None:
    text = HEADING.replace("animated = true", "standard = true")
    names = [p.name for p in read_definition(write(tmp_path, text)).parameters]
    assert len(names) == len(set(names))
    assert set(COMMON_PARAMETERS) <= set(names)


def test_values_that_a_new_definition_does_not_know_are_dropped(tmp_path: Path) -> None:
    old = read_definition(write(tmp_path, HEADING))
    changed = HEADING.replace('"int", default = 3, min = 1, max = 9', '"bool", default = true')
    new = read_definition(write(tmp_path, changed, "new"))
    worn = Material("m", definition=old).with_value("steps", 5).with_value("amount", 0.25)
    worn = worn.with_image("mask", 3).with_definition(new)
    assert worn.values == {"amount": 0.25}
    assert worn.textures.keys() == {"mask"}
    assert worn.value("steps") is True


@pytest.mark.parametrize(
    ("change", "complaint"),
    [
        (("/*", "//"), "heading: the file does not begin with a comment"),
        (('help = "rust', "help = rust"), "heading: is broken TOML"),
        (("animated", "animatd"), "animatd: is an unknown key"),
        (("animated = true", "animated = 1"), "animated: should be true or false"),
        (('"glow", "strength"', '"glow", "mask"'), "emits: 'mask' is no parameter with a value"),
        (('type = "int"', 'type = "whole"'), "parameters.steps.type: should be one of float"),
        (("default = 0.5", "default = 2"), "parameters.amount.default: should be 0 to 1"),
        (("default = [0.25, -2]", "default = 1"), "offset.default: should be a list of 2 numbers"),
        (('unit = "nit"', "unit = 3"), "parameters.strength.unit: should be a text"),
        (("min = 1, max = 9", "min = 9, max = 1"), "steps.max: is not greater than min"),
        (('"grey"', '"gray"'), "parameters.mask.default: should be one of white"),
        (("amount =", "a__b ="), "parameters.a__b: is no name"),
        (("amount =", "sample ="), "parameters.sample: is a word of GLSL"),
        (('roughness = { type = "float"', 'roughness = { type = "int"'), "should be float"),
        (("wet = { type", "wet = { kind"), "parameters.wet.type: should be one of"),
    ],
)
def test_a_broken_heading_is_told_in_a_line(
    tmp_path: Path, change: tuple[str, str], complaint: str
) -> None:
    text = HEADING.replace(*change)
    assert text != HEADING
    with pytest.raises(InputError) as error:
        read_definition(write(tmp_path, text))
    assert complaint in str(error.value)
    assert "rust.glsl" in str(error.value)
    assert "\n" not in str(error.value)


def test_too_many_parameters_are_refused(tmp_path: Path) -> None:
    vectors = "\n".join(f'v{k} = {{ type = "rgba", default = [0, 0, 0, 0] }}' for k in range(9))
    with pytest.raises(InputError, match="take more than 32 numbers"):
        read_definition(write(tmp_path, f"/*\n[parameters]\n{vectors}\n*/"))
    images = "\n".join(f't{k} = {{ type = "texture", default = "white" }}' for k in range(4))
    with pytest.raises(InputError, match="more than 3 textures"):
        read_definition(write(tmp_path, f"/*\n[parameters]\n{images}\n*/"))


def test_a_material_is_found_by_name_or_by_file(tmp_path: Path) -> None:
    path = write(tmp_path, HEADING)
    assert find_definition("rust.glsl", tmp_path, Path("s.toml"), "f").file == path
    assert find_definition("lava", tmp_path, Path("s.toml"), "f") is builtin("lava")
    with pytest.raises(InputError, match=r"s\.toml: f: no material is named 'laav'; did you mean"):
        find_definition("laav", tmp_path, Path("s.toml"), "f")
    with pytest.raises(InputError, match=r"s\.toml: f: none\.glsl: does not exist"):
        find_definition("none.glsl", tmp_path, Path("s.toml"), "f")


@pytest.mark.parametrize(
    ("name", "value", "complaint"),
    [
        ("amuont", 1.0, "is an unknown parameter; did you mean 'amount'?"),
        ("amount", "much", "should be a number"),
        ("amount", float("nan"), "should be 0 to 1"),
        ("steps", 2.5, "should be an integer"),
        ("wet", 1, "should be true or false"),
        ("glow", [1, -1, 1], "should be 0 or more"),
        ("mask", 3, "should be an image's file name"),
    ],
)
def test_a_wrong_value_is_told(tmp_path: Path, name: str, value: object, complaint: str) -> None:
    material = Material("m", definition=read_definition(write(tmp_path, HEADING)))
    with pytest.raises(InputError) as error:
        material.with_value(name, value)
    assert complaint in str(error.value)
