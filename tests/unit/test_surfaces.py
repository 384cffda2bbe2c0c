"""The scene of decals and glass is what its tool makes, and loads without a complaint."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from elemental.scene.load import load_scene
from make_surfaces import FOLDER, files


def test_the_files_are_what_the_tool_makes(tmp_path: Path) -> None:
    made = files()
    assert {path.name for path in FOLDER.iterdir()} == set(made)
    for name, content in made.items():
        committed = (FOLDER / name).read_bytes()
        if name.endswith(".glb"):
            (tmp_path / name).write_bytes(content)
            scenes = [load_scene(folder / name, default_lights=False)
                      for folder in (tmp_path, FOLDER)]  # fmt: skip
            points = [np.concatenate([m.positions for m in scene.meshes]) for scene in scenes]
            np.testing.assert_allclose(*points, atol=1e-5)
            looks = [[(m.roughness, m.thickness, m.transmission) for m in scene.materials]
                     for scene in scenes]  # fmt: skip
            assert looks[0] == looks[1]
            continue
        ours, theirs = (np.asarray(Image.open(io.BytesIO(data)), int)
                        for data in (committed, content))  # fmt: skip
        assert np.abs(ours - theirs).max() <= 1, name


@pytest.mark.parametrize("name", ["surfaces", "atrium_glass"])
def test_the_scenes_load_without_warnings(name: str) -> None:
    scene = load_scene(name, default_lights=False)
    assert scene.warnings == []
    glass = [material for material in scene.materials if material.transmits]
    assert len(glass) == 4
    assert len({material.thickness for material in glass}) == 3
    assert len(scene.decals) == (8 if name == "surfaces" else 0)
