"""The rooms that accuracy is measured on: their files, their solids, their light."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from atrium.mesh import is_closed, volume
from elemental.core.images import read_environment
from elemental.scene.area_lights import area_lights
from elemental.scene.load import load_scene
from make_rooms import files
from rooms.plans import PLANS
from rooms.room import ball, span, torus
from rooms.sky import SUN_RADIANCE, SUN_RADIUS_DEG, sky_radiance

FOLDER = Path(__file__).resolve().parents[2] / "content" / "scenes" / "rooms"


def test_the_committed_files_are_what_the_tool_makes(tmp_path: Path) -> None:
    made = files()
    assert {path.name for path in FOLDER.iterdir()} == set(made)
    for name, content in made.items():
        (tmp_path / name).write_bytes(content)
        if name.endswith(".hdr"):
            ours, stored = (read_environment(folder / name) for folder in (tmp_path, FOLDER))
            assert np.allclose(ours, stored, rtol=1e-2), name
            continue
        scenes = [
            load_scene(str(folder / name), default_lights=False) for folder in (tmp_path, FOLDER)
        ]
        ours, stored = (np.concatenate([m.positions for m in s.meshes]) for s in scenes)
        assert np.allclose(ours, stored, atol=1e-5), name
        assert [m.base_color.tolist() for m in scenes[0].materials] == [
            m.base_color.tolist() for m in scenes[1].materials
        ]


@pytest.mark.parametrize("name", PLANS)
def test_a_room_loads_by_its_name_without_a_warning(name: str) -> None:
    scene = load_scene(name, default_lights=False)
    assert scene.warnings == []
    assert len(scene.cameras) == 1
    assert scene.settings["gi.bounces"] == 6
    assert scene.environment is not None or len(area_lights(scene)) in (1, 2)


def test_the_cornell_box_has_its_published_measures() -> None:
    scene = load_scene("cornell_box", default_lights=False)
    low, high = scene.bounds()
    assert np.allclose(low, 0.0, atol=1e-6)
    assert np.allclose(high, [0.556, 0.5488, 0.5592], atol=1e-6)
    (lamp,) = area_lights(scene)
    assert np.linalg.norm(np.cross(lamp.edge_u, lamp.edge_v)) == pytest.approx(0.130 * 0.105)
    assert np.cross(lamp.edge_u, lamp.edge_v)[1] < 0.0  # it shines down


def test_solids_are_closed_and_face_outwards() -> None:
    assert volume(span((0, 0, 0), (1, 2, 3))) == pytest.approx(6.0)
    for soup, whole in (
        (ball(0.5, (1, 2, 3)), 4.0 / 3.0 * np.pi * 0.5**3),
        (torus(0.4, 0.1, (0, 1, 0)), 2.0 * np.pi**2 * 0.4 * 0.1**2),
    ):
        assert is_closed(soup)
        assert volume(soup) == pytest.approx(whole, rel=0.04)


def test_the_suns_disc_holds_its_light() -> None:
    radiance = sky_radiance()
    theta = (np.arange(len(radiance)) + 0.5) / len(radiance) * np.pi
    texel = np.sin(theta)[:, None] * (np.pi / len(radiance)) ** 2
    disc = (radiance == SUN_RADIANCE).all(axis=-1)
    solid_angle = 2.0 * np.pi * (1.0 - np.cos(np.radians(SUN_RADIUS_DEG)))
    assert float((disc * texel).sum()) == pytest.approx(solid_angle, rel=0.15)
