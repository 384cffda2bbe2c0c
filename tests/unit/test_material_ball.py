"""The shapes that materials are shown on: files, and what they are for."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from PIL import Image

from elemental.scene.load import load_scene
from make_material_ball import files

FOLDER = Path(__file__).resolve().parents[2] / "content" / "scenes" / "material_ball"


def test_the_committed_files_are_what_the_tool_makes(tmp_path: Path) -> None:
    made = files()
    assert {path.name for path in FOLDER.iterdir()} == set(made)
    for name, content in made.items():
        (tmp_path / name).write_bytes(content)
        if name.endswith(".png"):
            ours, stored = (Image.open(f / name).convert("L") for f in (tmp_path, FOLDER))
            assert np.abs(np.asarray(ours, int) - np.asarray(stored, int)).max() <= 1
            continue
        ours, stored = (load_scene(f / name, default_lights=False) for f in (tmp_path, FOLDER))
        for a, b in zip(ours.meshes, stored.meshes, strict=True):
            np.testing.assert_allclose(a.positions, b.positions, atol=1e-5)
            np.testing.assert_allclose(a.normals, b.normals, atol=1e-4)
            np.testing.assert_array_equal(a.indices, b.indices)


def test_the_ball_is_closed_smooth_and_looks_outwards() -> None:
    scene = load_scene(FOLDER / "ball.glb", default_lights=False)
    ball = scene.meshes[scene.instances[0].mesh]
    corners = ball.positions[ball.indices.reshape(-1, 3)].astype(np.float64)
    volume = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6
    assert 0.9 < volume / (4 / 3 * np.pi * 0.5**3) < 1.0
    outwards = ball.positions - np.array([0, 0.56, 0])
    assert np.median(np.einsum("ij,ij->i", ball.normals, outwards)) > 0.45


def test_the_bowl_s_wall_is_a_few_millimetres_thick_at_its_rim() -> None:
    scene = load_scene(FOLDER / "leaf.glb", default_lights=False)
    bowl = scene.meshes[scene.instances[1].mesh]
    rim = bowl.positions[bowl.positions[:, 1] > 0.37]
    radius = np.hypot(rim[:, 0], rim[:, 2])
    assert 0.004 < radius.max() - radius.min() < 0.012
