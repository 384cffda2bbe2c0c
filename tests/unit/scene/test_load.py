"""Opening scenes by name and path, and the light of those that have none."""

from __future__ import annotations

import os
import time
from pathlib import Path

import numpy as np
import pytest
from test_gltf_fuzz import check

import shapes
from elemental.core.errors import InputError
from elemental.core.paths import content_root
from elemental.scene.load import load_scene, scene_names
from gltf_builder import GltfBuilder

SCENES = Path(
    os.environ.get("ELEMENTAL_TEST_SCENES", Path(__file__).parents[4] / "shared" / "scenes")
)
"""Scenes of others, which don't come with the project: each that is there becomes a test."""
FOUND = sorted([*SCENES.glob("**/*.glb"), *SCENES.glob("**/*.gltf")])


def test_a_dark_scene_gets_a_sun_and_a_sky(tmp_path: Path) -> None:
    builder = GltfBuilder()
    builder.add(*shapes.box())
    scene = builder.load(tmp_path, default_lights=True)
    assert [light.kind for light in scene.lights] == ["directional"]
    assert scene.environment is not None
    assert scene.environment.radiance is None
    assert np.linalg.norm(scene.lights[0].direction) == pytest.approx(1.0)
    assert scene.lights[0].direction[1] < -0.5
    assert "a default sun and sky" in scene.notes[0]
    plain = builder.load(tmp_path, default_lights=False)
    assert (plain.lights, plain.environment, plain.notes) == ([], None, [])


def test_light_or_emission_keeps_the_default_away(tmp_path: Path) -> None:
    lit = GltfBuilder()
    lit.add(*shapes.box())
    lit.light("point")
    glowing = GltfBuilder()
    glowing.add(*shapes.box(), material=glowing.material(emissive=(0, 0, 1)))
    for builder in (lit, glowing):
        scene = builder.load(tmp_path, default_lights=True)
        assert scene.environment is None
        assert scene.notes == []


def test_unused_emission_and_dark_lights_count_for_nothing(tmp_path: Path) -> None:
    builder = GltfBuilder()
    builder.material(emissive=(1, 1, 1))
    builder.add(*shapes.box())
    builder.light("point", {"intensity": 0})
    assert builder.load(tmp_path, default_lights=True).environment is not None


def test_unknown_names(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="neither a file nor one of the scenes"):
        load_scene("no such scene", default_lights=True)
    odd = tmp_path / "a.obj"
    odd.write_text("")
    with pytest.raises(InputError, match=r"expected a \.gltf, \.glb or \.toml file"):
        load_scene(odd, default_lights=True)


def test_names_are_the_files_of_content() -> None:
    files = {path.stem for path in (content_root() / "scenes").glob("*.toml")}
    assert set(scene_names()) == files


@pytest.mark.parametrize("name", scene_names())
def test_every_scene_of_ours_loads(name: str) -> None:
    scene = load_scene(name, default_lights=True)
    check(scene)
    assert scene.warnings == []


@pytest.mark.parametrize("path", FOUND, ids=lambda path: path.stem)
def test_scenes_of_others(path: Path) -> None:
    begin = time.perf_counter()
    scene = load_scene(path, default_lights=True)
    assert time.perf_counter() - begin < 5.0
    check(scene)
    assert scene.triangle_count > 0
