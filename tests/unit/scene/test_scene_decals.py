"""The decals of scene files: where they lie, what they wear, and every mistake a line. SH-07"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import shapes
from elemental.core.errors import InputError
from elemental.core.images import write_png
from elemental.scene.load import load_scene
from elemental.scene.model import Scene
from elemental.scene.scene_decals import box_matrix
from gltf_builder import GltfBuilder

MODEL = '[[models]]\nfile = "model.glb"\n'
DECAL = "[[decals]]\nposition = [1.0, 2.0, 3.0]\ndirection = [0.0, 0.0, -1.0]\n"
DECAL += "size = [2.0, 1.0, 0.5]\n"


@pytest.fixture(autouse=True)
def _files(tmp_path: Path) -> None:
    """model.glb: a box; poster.png."""
    builder = GltfBuilder()
    positions, indices = shapes.box()
    builder.add(positions, indices, name="box", material=builder.material(pbr={}))
    builder.write(tmp_path / "model.glb")
    write_png(tmp_path / "poster.png", np.full((2, 2, 3), 200, np.uint8))


def load(folder: Path, toml: str) -> Scene:
    path = folder / "scene.toml"
    path.write_text(toml, encoding="utf-8")
    return load_scene(path, default_lights=False)


def reason(folder: Path, decal: str) -> str:
    with pytest.raises(InputError) as caught:
        load(folder, MODEL + decal)
    text = str(caught.value)
    assert "\n" not in text
    return text.removeprefix(f"{folder / 'scene.toml'}: ")


def test_a_box_stands_as_the_table_says() -> None:
    matrix = box_matrix([1, 2, 3], [0, 0, -5], [0, 1, 0], [2, 1, 0.5])
    want = np.diag([2, 1, 0.5, 1.0])
    want[:3, 3] = 1, 2, 3
    np.testing.assert_allclose(matrix, want, atol=1e-6)
    slanted = box_matrix([0, 0, 0], [1, -1, 0], [0, 1, 0], [1, 1, 1])[:3, :3]
    np.testing.assert_allclose(slanted.T @ slanted, np.eye(3), atol=1e-6)
    np.testing.assert_allclose(slanted[:, 2], np.array([-1, 1, 0]) / np.sqrt(2), atol=1e-6)
    assert slanted[1, 1] > 0.0
    assert np.linalg.det(slanted) == pytest.approx(1.0)


def test_decals_of_one_look_share_a_material(tmp_path: Path) -> None:
    look = 'parameters = { base_color_texture = "poster.png", roughness = 0.25 }\n'
    scene = load(tmp_path, MODEL + DECAL + look + DECAL + "order = 3\n" + look + DECAL)
    assert [decal.material for decal in scene.decals] == [1, 1, 2]
    assert [decal.order for decal in scene.decals] == [0, 3, 0]
    assert scene.decals[0].name == "decal0"
    material = scene.materials[1]
    assert (material.roughness, material.metallic, material.alpha_mode) == (0.25, 0.0, "blend")
    assert material.base_color_texture is not None
    assert scene.textures[material.base_color_texture.texture].pixels[0, 0, 0] == 200


def test_a_model_may_refuse_decals(tmp_path: Path) -> None:
    both = MODEL + MODEL + "receives_decals = false\n"
    scene = load(tmp_path, both + DECAL)
    assert [instance.receives_decals for instance in scene.instances] == [True, False]


@pytest.mark.parametrize(
    ("decal", "expected"),
    [
        (DECAL + 'parameters = { base_color_texture = "gone.png" }',
         "decals[0].parameters.base_color_texture: gone.png: does not exist"),
        (DECAL + "parameters = { rougness = 0.5 }",
         "decals[0].parameters.rougness: is an unknown parameter; did you mean 'roughness'?"),
        (DECAL + "up = [0.0, 0.0, 3.0]", "decals[0]: up is along direction"),
        (DECAL.replace("-1.0", "0.0"), "decals[0]: direction has length 0"),
        (DECAL.replace("0.5", "1e-40"),
         "decals[0].size[2]: should be 0.0001 or more"),
        (DECAL + "fade_deg = [80.0, 60.0]", "decals[0]: fade_deg does not increase"),
        (DECAL + "opacity = 1.5", "decals[0].opacity: should be 1 or less"),
        (DECAL + "channels = []", "decals[0].channels: needs 1 items or more, not 0"),
    ],
)  # fmt: skip
def test_a_mistake_is_one_line(tmp_path: Path, decal: str, expected: str) -> None:
    assert reason(tmp_path, decal) == expected


def test_a_shader_that_is_not_there_is_one_line(tmp_path: Path) -> None:
    assert reason(tmp_path, DECAL + 'shader = "lva"').startswith("decals[0].shader: ")
