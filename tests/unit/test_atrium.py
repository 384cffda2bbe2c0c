"""The generated scene: closed solids, its size, and that the committed file is what the tool makes.

AP-05 (its geometry; the systems that it shows are tested with them).
"""

from __future__ import annotations

import json
import struct
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from atrium.glb import GlbWriter
from atrium.layout import places
from atrium.materials import MATERIALS
from atrium.mesh import indexed, is_closed, join, volume
from atrium.prototypes import PROTOTYPES, THIN, WALL_THICKNESS
from atrium.shapes import arch_panel, box, groin_vault, revolve, ring
from atrium.sky import SUN_DIRECTION, sky_hdr
from elemental.core.images import read_environment
from elemental.scene.load import load_scene

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "content" / "scenes" / "atrium"


@pytest.mark.parametrize("name", PROTOTYPES)
def test_every_part_but_cloth_and_leaves_is_a_closed_solid(name: str) -> None:
    for material, soup in PROTOTYPES[name]():
        if material not in THIN:
            assert is_closed(soup), material
            assert volume(soup) > 0.0, material


def test_the_shapes_enclose_their_volumes() -> None:
    assert volume(box((1.0, 2.0, 3.0), (5.0, 0.0, 0.0))) == pytest.approx(6.0)
    assert volume(ring([(0, 0), (1, 0), (1, 1), (0, 1)], 4.0, 3.0)) == pytest.approx(10 * 8 - 8 * 6)
    cylinder = revolve([(0.0, 0.0), (1.0, 0.0), (1.0, 2.0), (0.0, 2.0)], 400)
    assert volume(cylinder) == pytest.approx(2.0 * np.pi, rel=1e-3)
    panel = arch_panel(2.8, 1.65, 1.1, 0.5, 200)
    assert volume(panel) == pytest.approx(0.5 * (2.8 * 1.65 - np.pi * 1.1**2 / 2.0), rel=1e-3)
    # Two crossed half cylinders of radius 1 hold 2·(π/2)·2 - 8/3 under their union.
    vault = groin_vault(2.0, 1.0, 200, 4)
    assert volume(vault) == pytest.approx(4.0 - (2.0 * np.pi - 8.0 / 3.0), rel=1e-2)


def test_an_open_or_turned_face_is_not_closed() -> None:
    whole = box((1.0, 1.0, 1.0), (0.0, 0.0, 0.0))
    missing = type(whole)(whole.position[1:], whole.uv[1:])
    first = type(whole)(whole.position[:1], whole.uv[:1])
    assert not is_closed(missing)
    assert not is_closed(join(missing, first.flipped()))


def test_normals_are_smooth_on_a_column_and_sharp_on_a_box() -> None:
    cylinder = indexed(revolve([(0, 0), (1, 0), (1, 2), (0, 2)], 32), 38.0, 1.0)
    side = np.abs(cylinder.normal[:, 1]) < 0.5
    radial = cylinder.position[side] * [1.0, 0.0, 1.0]
    assert np.abs(cylinder.normal[side] - radial).max() < 2e-2
    cube = indexed(box((1.0, 1.0, 1.0), (0.0, 0.0, 0.0)), 38.0, 1.0)
    assert len(cube.position) == 24


def test_the_scene_is_large_enough_and_loads_without_a_warning() -> None:
    scene = load_scene("atrium", default_lights=False)
    assert 100_000 <= scene.triangle_count <= 160_000
    assert scene.warnings == []
    low, high = scene.bounds()
    assert np.all(np.abs(high - low - [24.0, 10.0, 15.0]) < 1.0)
    assert {"courtyard", "gallery", "floor"} <= {camera.name for camera in scene.cameras}
    assert scene.camera_path is not None
    assert sum(material.emits for material in scene.materials) >= 1
    assert WALL_THICKNESS >= 0.4


def test_the_sky_glows_where_the_sun_stands(tmp_path: Path) -> None:
    lights = tomllib.loads((FOLDER.parent / "atrium.toml").read_text())["lights"]
    assert lights[0]["direction"] == [-d for d in SUN_DIRECTION]
    file = tmp_path / "sky.hdr"
    file.write_bytes(sky_hdr())
    radiance = read_environment(file)
    row, column = np.unravel_index(radiance.sum(axis=2).argmax(), radiance.shape[:2])
    height, width = radiance.shape[:2]
    theta, phi = (row + 0.5) / height * np.pi, ((column + 0.5) / width - 0.5) * 2.0 * np.pi
    brightest = np.array([np.sin(theta) * np.sin(phi), np.cos(theta), -np.sin(theta) * np.cos(phi)])
    to_sun = np.array(SUN_DIRECTION) / np.linalg.norm(SUN_DIRECTION)
    assert brightest @ to_sun > 0.95


def _document(glb: bytes) -> dict[str, Any]:
    (length,) = struct.unpack_from("<I", glb, 12)
    document: dict[str, Any] = json.loads(glb[20 : 20 + length])
    return document


def test_the_committed_file_is_what_the_tool_makes() -> None:
    committed = (FOLDER / "atrium.glb").read_bytes()
    assert len(committed) < 4_000_000
    document = _document(committed)
    assert len(document["nodes"]) == len(places())
    assert {m["name"] for m in document["materials"]} <= set(MATERIALS)
    for name, entry in zip(PROTOTYPES, document["meshes"], strict=True):
        assert entry["name"] == name
        for (material, soup), primitive in zip(
            PROTOTYPES[name](), entry["primitives"], strict=True
        ):
            mesh = indexed(soup, MATERIALS[material].crease_degrees, 1.0)
            count = document["accessors"][primitive["indices"]]["count"]
            assert count == len(mesh.index), (name, material)


def test_the_writer_makes_the_same_bytes_twice() -> None:
    def once() -> bytes:
        glb = GlbWriter()
        primitive = glb.primitive(indexed(box((1, 1, 1), (0, 0, 0)), 38.0, 1.0))
        mesh = glb.add("meshes", {"primitives": [primitive]})
        glb.node("box", mesh, (1.0, 0.0, 0.0), 0.5, 1.0)
        return glb.bytes([])

    assert once() == once()
