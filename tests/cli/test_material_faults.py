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
