"""The scenes that show lights: their files, and what lights them."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from elemental.scene.ies import parse_ies
from elemental.scene.load import load_scene
from elemental.scene.photometry import solid_angle
from make_light_scenes import SIZES_M, files

SCENES = Path(__file__).resolve().parents[2] / "content" / "scenes"


def test_the_committed_files_are_what_the_tool_makes(tmp_path: Path) -> None:
    for name, content in files().items():
        stored = (SCENES / name).read_bytes()
        if not name.endswith(".glb"):
            assert stored == content, name
            continue
        (tmp_path / Path(name).name).write_bytes(content)
        ours, theirs = (load_scene(str(path), default_lights=False)
                        for path in (tmp_path / Path(name).name, SCENES / name))  # fmt: skip
        assert [i.name for i in ours.instances] == [i.name for i in theirs.instances]
        points = [np.concatenate([m.positions for m in s.meshes]) for s in (ours, theirs)]
        np.testing.assert_allclose(*points, atol=1e-5)


def test_many_lights_are_256_that_end_somewhere() -> None:
    scene = load_scene("many_lights", default_lights=False)
    low, high = scene.bounds()
    assert len(scene.lights) == 256
    assert all(math.isfinite(light.range) for light in scene.lights)
    places = np.array([light.position for light in scene.lights])
    assert np.all((low < places) & (places < high))
    sconces = [light for light in scene.lights if light.casts_shadow]
    assert len(sconces) == 20
    assert all(light.profile is not None for light in sconces)


def test_the_sconce_throws_more_up_than_down() -> None:
    text = (SCENES / "festival" / "sconce.ies").read_text()
    profile = parse_ies(text, Path("sconce.ies"))
    up, down = profile.intensity(np.radians([175.0, 5.0]), np.zeros(2))
    assert up > 1.2 * down > 200.0
    lamp = next(li for li in load_scene("many_lights", default_lights=False).lights if li.profile)
    assert 0.5 < solid_angle(lamp) < 2.0


def test_the_sizes_are_those_of_the_scene() -> None:
    scene = load_scene("light_sizes", default_lights=False)
    assert tuple(light.source_radius for light in scene.lights) == SIZES_M
