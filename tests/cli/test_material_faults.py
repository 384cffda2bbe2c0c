"""``shot`` with broken materials: a picture all the same, and a warning that says where."""

# SH-10

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from cli.process import elemental
from cli.small_scene import write_corner

HEADING = '/*\n[parameters]\na = { type = "float", default = -1 }\n*/\n'
SCENE = '[[models]]\nfile = "corner.gltf"\n[[materials]]\nname = "*"\nshader = "draft.glsl"\n'


@pytest.mark.parametrize(
    ("line", "complaint"),
    [
        ("s.albedo = vec3(p.b);", "draft.glsl:6: error: "),
        ("s.albedo = vec3(sqrt(p.a));", "draft.glsl: material '"),
    ],
)
def test_a_broken_material_is_loud_and_named(tmp_path: Path, line: str, complaint: str) -> None:
    write_corner(tmp_path)
    code = f"void material(inout Surface s, MaterialInput m, Parameters p) {{\n    {line}\n}}\n"
    (tmp_path / "draft.glsl").write_text(HEADING + code)
    (tmp_path / "scene.toml").write_text(SCENE)
    result = elemental(
        "shot", "scene.toml", "-o", "out.png", "--size", "64x48", "--report", "out.json",
        "--set", "gi.resolution=64", cwd=tmp_path,
    )  # fmt: skip
    assert result.returncode == 0, result.stderr
    assert "elemental: warning: " in result.stderr
    assert complaint in result.stderr
    warnings = json.loads((tmp_path / "out.json").read_text())["warnings"]
    assert any(complaint in warning for warning in warnings)
    picture = np.asarray(Image.open(tmp_path / "out.png"))[..., :3].astype(float)
    magenta = (picture[..., 0] > 150) & (picture[..., 2] > 150) & (picture[..., 1] < 90)
    assert magenta.sum() > 50


@pytest.mark.parametrize(
    "words",
    [("render", "scene.toml", "-o", "frames", "--frames", "0:2", "--fps", "24"),
     ("shot", "scene.toml", "-o", "out.png", "--ui")],
    ids=["render", "shot --ui"],
)  # fmt: skip
def test_other_doors_name_it_too(tmp_path: Path, words: tuple[str, ...]) -> None:
    write_corner(tmp_path)
    (tmp_path / "draft.glsl").write_text(HEADING + "void material(inout Surface s) { s = 1; }\n")
    (tmp_path / "scene.toml").write_text(SCENE)
    size = ("--size", "320x240" if "--ui" in words else "32x24")
    result = elemental(*words, *size, "--set", "gi.resolution=64", cwd=tmp_path)
    assert result.returncode == 0, result.stderr
    assert result.stderr.count("elemental: warning: ") >= 1
    assert "draft.glsl:5: error: " in result.stderr
