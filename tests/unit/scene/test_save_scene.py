"""AP-03: saving into a scene file: what changed, in its place; comments and the rest stay."""

from __future__ import annotations

import json
import math
import tomllib
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cli.small_scene import corner
from elemental.core.errors import InputError
from elemental.core.images import write_png
from elemental.core.paths import content_root
from elemental.scene.defaults import default_sun
from elemental.scene.definitions import find_definition
from elemental.scene.light_masks import masked, read_light_mask
from elemental.scene.lights import Light
from elemental.scene.load import load_scene
from elemental.scene.materials import Texture
from elemental.scene.save_parts import MaterialChanges
from elemental.scene.save_scene import Changes, save_scene
from elemental.scene.scene_file import flat_settings
from elemental.scene.scene_materials import read_texture
from elemental.ui.document import same

MODELS = '[[models]]\nfile = "m/a.glb"  # the house\n'

LAYOUTS = {
    "none": f"# top\n{MODELS}",
    "quoted": f'# top\n{MODELS}\n[settings]\n"gi.bounces" = 2   # two\nexposure = 1.0  # bright\n',
    "dotted": f"# top\n{MODELS}\n[settings]  # ours\ngi.bounces = 2   # two\ngi.enabled = true\n",
    "tables": f"# top\n{MODELS}\n[settings]\n# gi\n[settings.gi]\nbounces = 2  # two\n\n"
    "[environment]\n",
    "inline": f"settings = {{ gi = {{ bounces = 2 }}, exposure = 1.0 }}  # ours\n{MODELS}# end\n",
    "top": f"settings.gi.bounces = 2  # two\nsettings.exposure = 1.0\n{MODELS}# end\n",
}
VALUES: dict[str, st.SearchStrategy[Any]] = {
    "gi.bounces": st.integers(0, 8),
    "gi.enabled": st.booleans(),
    "exposure": st.floats(-16, 16),
    "sky.image": st.text(st.characters(codec="utf-8", exclude_categories=("C",)), max_size=20),
    "indirect.color": st.tuples(*[st.floats(0, 1)] * 3),
    "shadow.resolution": st.sampled_from([256, 512]),
}
SETTINGS = st.fixed_dictionaries({}, optional=VALUES)


def comments(text: str) -> list[str]:
    """The comments of a file whose strings hold no number sign."""
    return [line.partition("#")[2] for line in text.splitlines() if "#" in line]


@pytest.mark.parametrize("layout", LAYOUTS)
@given(settings=SETTINGS)
def test_what_is_assigned_is_read_back_and_the_rest_stays(
    tmp_path_factory: pytest.TempPathFactory, layout: str, settings: dict[str, Any]
) -> None:
    path = tmp_path_factory.getbasetemp() / f"{layout}.toml"
    path.write_text(LAYOUTS[layout])
    before = tomllib.loads(LAYOUTS[layout])
    save_scene(path, path, Changes(settings))
    after = tomllib.loads(path.read_text())
    expected = flat_settings(before.get("settings", {}))
    expected |= {k: list(v) if isinstance(v, tuple) else v for k, v in settings.items()}
    assert flat_settings(after.get("settings", {})) == expected
    assert after["models"] == before["models"]
    if "#" not in str(settings.get("sky.image")):
        assert comments(path.read_text()) == comments(LAYOUTS[layout])


def test_nothing_changed_leaves_every_byte(tmp_path: Path) -> None:
    path = tmp_path / "a.toml"
    path.write_text(LAYOUTS["dotted"])
    save_scene(path, path, Changes())
    assert path.read_text() == LAYOUTS["dotted"]


def test_a_model_is_saved_as_a_scene_that_names_it(tmp_path: Path) -> None:
    (tmp_path / "models").mkdir()
    save_scene(tmp_path / "models" / "a.glb", tmp_path / "a.toml", Changes({"exposure": 1.5}))
    written = tomllib.loads((tmp_path / "a.toml").read_text())
    assert written == {"models": [{"file": "models/a.glb"}], "settings": {"exposure": 1.5}}


def test_saved_elsewhere_it_names_the_same_files(tmp_path: Path) -> None:
    (tmp_path / "there").mkdir()
    here = tmp_path / "here.toml"
    here.write_text(f'{MODELS}[environment]\nfile = "sky.hdr"\n')
    save_scene(here, tmp_path / "there" / "b.toml", Changes())
    written = tomllib.loads((tmp_path / "there" / "b.toml").read_text())
    assert written["models"][0]["file"] == "../m/a.glb"
    assert written["environment"]["file"] == "../sky.hdr"


@pytest.mark.parametrize("name", ["many_lights", "surfaces"])
def test_a_scene_of_ours_saved_elsewhere_loads_as_it_did(name: str, tmp_path: Path) -> None:
    """With its profiles and the images of its decals."""
    here = content_root() / "scenes" / f"{name}.toml"
    there = tmp_path / "there.toml"
    save_scene(here, there, Changes())
    was, now = (load_scene(str(path), default_lights=False) for path in (here, there))
    assert len(now.lights) == len(was.lights)
    assert len(now.decals) == len(was.decals)
    assert [texture.name for texture in now.textures] == [texture.name for texture in was.textures]


def test_what_can_not_be_written_is_refused_and_leaves_the_file(tmp_path: Path) -> None:
    path = tmp_path / "a.toml"
    path.write_text(LAYOUTS["none"])
    with pytest.raises(InputError, match="a scene is saved as"):
        save_scene(path, tmp_path / "a.glb", Changes())
    with pytest.raises(InputError, match="can't be written"):
        save_scene(path, tmp_path / "nowhere" / "a.toml", Changes())
    path.write_text("models = 3 = 4")
    with pytest.raises(InputError, match="broken"):
        save_scene(path, path, Changes({"exposure": 1.0}))
    assert [p.name for p in tmp_path.iterdir()] == ["a.toml"]


LIT = """[[models]]
file = "corner.gltf"

[[lights]]  # ours
kind = "spot"
position = [0.0, 2.0, 0.0]
direction = [0.0, -1.0, 0.0]
lumen = 100.0   # bright enough

[[materials]]
name = "*"
parameters = { roughness = 0.5 }  # all alike
"""


def test_lights_and_materials_come_back_as_they_were_left(tmp_path: Path) -> None:
    gltf = corner()
    gltf["extensionsUsed"] = ["KHR_lights_punctual"]
    gltf["extensions"] = {"KHR_lights_punctual": {"lights": [{"type": "point", "name": "bulb"}]}}
    gltf["nodes"].append({"extensions": {"KHR_lights_punctual": {"light": 0}}})
    gltf["scenes"][0]["nodes"].append(len(gltf["nodes"]) - 1)
    (tmp_path / "corner.gltf").write_text(json.dumps(gltf))
    path = tmp_path / "lit.toml"
    path.write_text(LIT)
    scene = load_scene(path, default_lights=False)
    spot, bulb = scene.lights
    lights = [
        replace(spot, intensity=12.5, inner_angle=0.25, temperature=3000.0, range=7.0),
        replace(bulb, name=bulb.name, color=np.array([1, 0.5, 0.25], np.float32), intensity=3.5),
    ]
    first, second, third = scene.materials
    flag = find_definition("flag", tmp_path, path, "shader")
    materials = [
        first.with_value("base_color", (0.1, 0.2, 0.3, 1.0)).with_value("metallic", 0.75),
        second,
        third.with_definition(flag),
    ]
    for _ in range(2):  # the second time into its own tables
        save_scene(path, path, Changes(
            lights=(scene.lights, lights), materials=MaterialChanges(scene.materials, materials)
        ))  # fmt: skip
    again = load_scene(path, default_lights=False)
    for wanted, got in zip((*lights, *materials), (*again.lights, *again.materials), strict=True):
        assert same(replace(wanted, **{"inner_angle": got.inner_angle})
                    if isinstance(wanted, Light) else wanted, got), (wanted, got)  # fmt: skip
        if isinstance(wanted, Light):
            assert math.isclose(wanted.inner_angle, got.inner_angle, rel_tol=1e-6)
    for comment in ("# ours", "# all alike"):
        assert comment in path.read_text()


def test_a_models_light_keeps_its_mask_in_another_folder(tmp_path: Path) -> None:
    gltf = corner()
    gltf["extensionsUsed"] = ["KHR_lights_punctual"]
    lamps = [{"type": "spot", "name": "lamp", "spot": {}}, {"type": "point", "name": "bulb"}]
    gltf["extensions"] = {"KHR_lights_punctual": {"lights": lamps}}
    for number in range(2):
        gltf["nodes"].append({"extensions": {"KHR_lights_punctual": {"light": number}}})
        gltf["scenes"][0]["nodes"].append(len(gltf["nodes"]) - 1)
    opened = tmp_path / "corner.gltf"
    opened.write_text(json.dumps(gltf))
    file = tmp_path / "bars.png"
    write_png(file, np.arange(48, dtype=np.uint8).reshape(4, 4, 3))
    lamp, bulb = load_scene(opened, default_lights=False).lights
    worn = replace(masked(lamp, read_light_mask(file)), roll=math.pi / 6, mask_scroll=(0.25, -0.5))
    (tmp_path / "saved").mkdir()
    target = tmp_path / "saved" / "lit.toml"
    save_scene(opened, target, Changes(lights=((lamp, bulb), (worn, bulb))))
    again, _ = load_scene(target, default_lights=False).lights
    assert again.mask is not None
    assert np.array_equal(again.mask.pixels, worn.mask.pixels)
    assert (again.mask_scroll, again.mask_size) == ((0.25, -0.5), 1.0)
    assert again.roll == pytest.approx(math.pi / 6)
    save_scene(target, target, Changes(lights=((again, bulb), (masked(again, None), bulb))))
    assert load_scene(target, default_lights=False).lights[0].mask is None
    assert tomllib.loads(target.read_text())["light_changes"] == [{"name": "lamp"}]
    target.write_text(target.read_text().replace('"lamp"', '"bulb"\nmask = "../bars.png"'))
    with pytest.raises(InputError, match=r"light_changes\[0\]\.mask: is for spot and directional"):
        load_scene(target, default_lights=False)


ARTIST = """/*
standard = true
[parameters]
mask = { type = "texture", default = "grey" }
*/
void material(inout Surface s, MaterialInput m, Parameters p) { s = standard_surface(m); }
"""


def test_images_and_shaders_are_named_from_the_scene(tmp_path: Path) -> None:
    """Also one folder up; the model's own image comes back by leaving the name out."""
    (tmp_path / "scenes").mkdir()
    (tmp_path / "corner.gltf").write_text(json.dumps(corner()))
    (tmp_path / "rust.glsl").write_text(ARTIST)
    write_png(tmp_path / "dots.png", np.full((2, 2, 3), 99, np.uint8))
    path = tmp_path / "scenes" / "a.toml"
    path.write_text('[[models]]\nfile = "../corner.gltf"\n')
    scene = load_scene(path, default_lights=False)
    own = Texture("own", np.zeros((1, 1, 4), np.uint8))
    textures = [own, read_texture(tmp_path / "dots.png")]
    first, second, _ = bare = scene.materials
    rust = find_definition("../rust.glsl", path.parent, path, "shader")
    worn = [
        replace(first, alpha_mode="mask", double_sided=True).with_image("normal_texture", 1),
        second.with_definition(rust).with_image("mask", 1),
        bare[2],
    ]
    save_scene(path, path, Changes(materials=MaterialChanges(bare, worn, textures)))
    again = load_scene(path, default_lights=False)
    assert [m.definition for m in again.materials] == [m.definition for m in worn]
    assert (again.materials[0].alpha_mode, again.materials[0].double_sided) == ("mask", True)
    for material, name in ((again.materials[0], "normal_texture"), (again.materials[1], "mask")):
        slot = material.texture(name)
        assert slot is not None
        assert again.textures[slot.texture].name == "dots"
    assert '"../dots.png"' in path.read_text()
    assert '.gltf"\n\n[[materials]]\n' in path.read_text()  # set apart from what stood there
    back = [worn[0].with_image("normal_texture", 0), *worn[1:]]
    save_scene(path, path, Changes(materials=MaterialChanges(worn, back, textures)))
    assert load_scene(path, default_lights=False).materials[0].normal_texture is None
    with pytest.raises(InputError, match="materials"):
        save_scene(path, path, Changes(materials=MaterialChanges(worn, back, textures)))


def test_what_decals_project_is_saved_with_them(tmp_path: Path) -> None:
    """A table of materials can't name it: a scene with one would not open any more."""
    (tmp_path / "corner.gltf").write_text(json.dumps(corner()))
    write_png(tmp_path / "dots.png", np.full((2, 2, 3), 99, np.uint8))
    path = tmp_path / "a.toml"
    sticker = (
        "[[decals]]\nposition = [0, 0, 0]\ndirection = [0, -1, 0]\n"
        "up = [0, 0, -1]\nsize = [1, 1, 1]\n"
    )
    path.write_text(
        f'[[models]]\nfile = "corner.gltf"\n{sticker}parameters = {{ roughness = 0.5 }}\n'
        f"{sticker}{sticker}parameters = {{ roughness = 0.5 }}\n"
    )
    scene = load_scene(path, default_lights=False)
    assert [decal.material for decal in scene.decals] == [3, 4, 3]
    textures = [read_texture(tmp_path / "dots.png")]
    worn = list(scene.materials)
    worn[3] = worn[3].with_value("metallic", 0.25).with_image("base_color_texture", 0)
    changes = MaterialChanges(scene.materials, worn, textures, scene.decals)
    save_scene(path, path, Changes(materials=changes))
    again = load_scene(path, default_lights=False)
    assert [decal.material for decal in again.decals] == [3, 4, 3]
    assert same(again.materials, worn)


def test_the_default_sun_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.toml"
    path.write_text(LAYOUTS["none"])
    changed = replace(default_sun(), intensity=9.0)
    with pytest.raises(InputError, match="lights"):
        save_scene(path, path, Changes(lights=([default_sun()], [changed])))
    assert path.read_text() == LAYOUTS["none"]


def test_a_save_that_is_cut_short_leaves_the_old_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "a.toml"
    path.write_text(LAYOUTS["dotted"])

    def killed(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("os.replace", killed)
    with pytest.raises(KeyboardInterrupt):
        save_scene(path, path, Changes({"exposure": 1.5}))
    assert path.read_text() == LAYOUTS["dotted"]
    assert [file.name for file in tmp_path.iterdir()] == ["a.toml"]
