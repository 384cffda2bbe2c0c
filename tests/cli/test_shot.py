"""``elemental shot`` end to end."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import PIL.Image
import pytest
from numpy.typing import NDArray

from cli.process import elemental
from cli.schema import mismatches
from cli.small_scene import corner, write_corner
from elemental.core.images import read_exr
from elemental.core.srgb import encode_srgb
from elemental.frame import VIEWS
from elemental.report import Report

SMALL = ("--size", "48x32", "--set", "gi.resolution=64", "--set", "shadow.resolution=256")

REQUIRED_VIEWS = {
    "final",
    "scene_color",
    "normal",
    "diffuse",
    "specular",
    "specular_power",
    "ao",
    "depth",
    "shadow",
    "diffuse_gi",
    "specular_gi",
    "direct",
    "voxels",
}


def shot(folder: Path, *words: object) -> str:
    """Render corner.gltf in ``folder``; returns stdout."""
    write_corner(folder)
    result = elemental("shot", "corner.gltf", *SMALL, *words, cwd=folder)
    assert result.returncode == 0, result.stderr
    assert "Traceback" not in result.stderr
    return result.stdout


def pixels(path: Path) -> NDArray[np.uint8]:
    with PIL.Image.open(path) as image:
        return np.asarray(image)


FIXED_EXPOSURE = ("--set", "eye_adaptation.min_brightness=1",
                  "--set", "eye_adaptation.max_brightness=1")  # fmt: skip
"""For pictures that differ by rounding: the eye would spread that over all of one."""


def assert_alike(a: NDArray[np.int64], b: NDArray[np.int64]) -> None:
    """Equal but for rounding: 1 % of the pixels over 2/255; single ones up to 16, where a cone just
    meets an edge or misses it."""
    difference = np.abs(a - b).max(axis=2)
    assert difference.max() <= 16
    assert (difference > 6).mean() <= 0.002
    assert (difference > 2).mean() <= 0.01


def test_two_runs_give_the_same_bytes(tmp_path: Path) -> None:
    for name in ("a.png", "b.png"):
        assert shot(tmp_path, "-o", name) == f"{name}\n"
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()
    picture = pixels(tmp_path / "a.png")
    assert picture.shape == (32, 48, 3)
    assert picture.std() > 10  # not a plain colour
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.png", "b.png", "corner.gltf"]


def test_the_report_follows_its_schema(tmp_path: Path) -> None:
    shot(tmp_path, "-o", "a.png", "--report", "r.json", "--seed", 7, "--time", 1.5)
    report = json.loads((tmp_path / "r.json").read_text())
    assert mismatches(report, Report) == []
    assert report["size"] == [48, 32]
    assert (report["seed"], report["time_s"], report["view"]) == (7, 1.5, "final")
    assert report["settings"]["gi.resolution"] == 64
    assert report["scene"]["triangles"] == 6
    assert report["gl"]["renderer"]
    assert report["passes"]
    assert all(entry["cpu_ms"] > 0 for entry in report["passes"])
    assert report["frame"]["wall_ms"] >= report["frame"]["cpu_ms"] > 0
    sizes = report["bytes"]
    assert sizes["total"] == sum(size for name, size in sizes.items() if name != "total")
    assert min(sizes["targets"], sizes["octree"], sizes["meshes"]) > 0
    for what in ("voxel_fragments", "octree_nodes", "octree_bricks"):
        assert report["counters"][what] > 0
        assert report["counters"][f"{what}_dropped"] == 0
    assert report["gl_messages"] == []


def test_scene_color_as_exr_is_linear_radiance(tmp_path: Path) -> None:
    words = ("--view", "scene_color", "--set", "gi.enabled=false", "-o")
    shot(tmp_path, *words, "a.exr", "--set", "exposure=5")
    shot(tmp_path, *words, "b.exr", "--set", "exposure=-5")
    radiance = read_exr(tmp_path / "a.exr")
    assert radiance.shape == (32, 48, 3)
    assert radiance.max() == pytest.approx(1.0, rel=1e-3)  # the lamp, in half floats
    assert (tmp_path / "a.exr").read_bytes() == (tmp_path / "b.exr").read_bytes()


def test_final_as_exr_shows_what_the_png_shows(tmp_path: Path) -> None:
    shot(tmp_path, "-o", "a.png")
    shot(tmp_path, "-o", "a.exr")
    display = encode_srgb(read_exr(tmp_path / "a.exr"))
    np.testing.assert_allclose(display * 255, pixels(tmp_path / "a.png"), atol=0.51)


def test_a_numbered_name_gets_each_frame_and_a_plain_one_the_last(tmp_path: Path) -> None:
    assert shot(tmp_path, "-o", "s.%03d.png", "--frames", 3) == "s.002.png\n"
    names = [f"s.00{i}.png" for i in range(3)]
    assert sorted(p.name for p in tmp_path.glob("*.png")) == names
    shot(tmp_path, "-o", "last.png", "--frames", 3)
    assert (tmp_path / "last.png").read_bytes() == (tmp_path / names[2]).read_bytes()


def test_a_name_of_250_bytes_can_be_written(tmp_path: Path) -> None:
    name = "a" * 246 + ".png"
    assert shot(tmp_path, "-o", name, "--set", "gi.enabled=false") == f"{name}\n"


def test_cameras_by_name_and_by_place_agree(tmp_path: Path) -> None:
    fov = np.degrees(0.7)
    look = ("--target", "0,1,0", *FIXED_EXPOSURE)
    shot(tmp_path, "-o", "a.png", "--camera", "front", *FIXED_EXPOSURE)
    shot(tmp_path, "-o", "b.png", *FIXED_EXPOSURE)
    shot(tmp_path, "-o", "c.png", "--eye", "0,1,4", "--fov", fov, *look)
    shot(tmp_path, "-o", "d.png", "--eye", "-1,1,4", *look)
    a, b, c, d = (pixels(tmp_path / f"{name}.png").astype(int) for name in "abcd")
    assert np.array_equal(a, b)
    assert_alike(a, c)
    assert np.abs(a - d).max() > 20


def test_views_are_chosen_by_their_names(tmp_path: Path) -> None:
    """Of surfaces, of cones, of the octree; tests/gpu/test_renderer.py writes every one."""
    views = {line.split()[0] for line in elemental("list", "views").stdout.splitlines()}
    assert REQUIRED_VIEWS <= views == set(VIEWS)
    pictures = set()
    for view in ("normal", "diffuse_gi", "voxels"):
        shot(tmp_path, "-o", f"{view}.png", "--view", view)
        assert pixels(tmp_path / f"{view}.png").shape == (32, 48, 3)
        pictures.add(pixels(tmp_path / f"{view}.png").tobytes())
    assert len(pictures) == 3


def test_a_huge_and_a_tiny_scene_look_the_same(tmp_path: Path) -> None:
    pictures = []
    for scale in (1e4, 1e-3):  # 20 km and 2 mm across
        gltf = corner()
        gltf["nodes"].append({"children": [0, 1, 2, 3], "scale": [scale] * 3})
        gltf["scenes"][0]["nodes"] = [4]
        (tmp_path / "scaled.gltf").write_text(json.dumps(gltf))
        place = ("--eye", f"0,{scale},{4 * scale}", "--target", f"0,{scale},0")
        words = ("scaled.gltf", "-o", "a.png", *SMALL, *place)
        result = elemental("shot", *words, cwd=tmp_path)
        assert result.returncode == 0, result.stderr
        pictures.append(pixels(tmp_path / "a.png").astype(int))
    assert pictures[0].std() > 10
    assert_alike(*pictures)


def test_a_scene_that_overflows_its_memory_is_drawn_and_says_what_was_dropped(
    tmp_path: Path,
) -> None:
    write_corner(tmp_path)
    words = ("--size", "48x32", "--set", "gi.resolution=512", "--set", "gi.memory_budget_mb=16")
    outputs = ("-o", "a.png", "--report", "r.json")
    result = elemental("shot", "corner.gltf", *words, *outputs, cwd=tmp_path)
    assert result.returncode == 0, result.stderr
    report = json.loads((tmp_path / "r.json").read_text())
    dropped = {n: c for n, c in report["counters"].items() if "dropped" in n and c}
    assert dropped
    assert len(report["warnings"]) == len(dropped)
    told = [f"elemental: warning: {line}" for line in report["warnings"]]
    told += [f"elemental: note: {line}" for line in report["notes"]]
    assert result.stderr.splitlines() == told
    assert report["counters"]["octree_resolution"] < 512
    assert "2 octree levels dropped" in result.stderr
    assert "raise gi.memory_budget_mb or lower gi.resolution" in result.stderr
