"""``elemental bench`` end to end."""

from __future__ import annotations

import io
import json
from pathlib import Path
from typing import Any

from rich.console import Console

from cli.process import elemental
from cli.schema import mismatches
from cli.small_scene import write_corner
from elemental.bench import BenchReport, Spread, print_tables, spread

WORDS = ("--size", "32x24", "--frames", 3, "--warmup", 2, "--set", "gi.resolution=64",
         "--json", "b.json")  # fmt: skip


def bench(folder: Path, *words: object) -> tuple[str, dict[str, Any]]:
    write_corner(folder)
    result = elemental("bench", "corner.gltf", *WORDS, *words, cwd=folder)
    assert result.returncode == 0, result.stderr
    report: dict[str, Any] = json.loads((folder / "b.json").read_text())
    assert mismatches(report, BenchReport) == []
    return result.stdout, report


def test_a_still_scene_does_no_voxel_work_and_a_forced_rebuild_does(tmp_path: Path) -> None:
    table, still = bench(tmp_path)
    _, rebuilt = bench(tmp_path, "--rebuild", "geometry")
    names = {entry["name"] for entry in still["passes"]}
    more = {entry["name"] for entry in rebuilt["passes"]} - names
    assert any("voxel" in name for name in more)
    assert not any("voxelize" in name for name in names)
    for entry in still["passes"]:
        assert entry["name"] in table
        assert entry["frames"] % 3 == 0  # passes of one name count together
        assert 0 <= entry["gpu_ms"]["min"] <= entry["gpu_ms"]["median"] <= entry["gpu_ms"]["p95"]
    assert still["frame_wall_ms"]["min"] >= still["frame_cpu_ms"]["min"] > 0
    assert still["counters"] == rebuilt["counters"]


def test_no_figure_is_cut_where_no_terminal_bounds_the_table() -> None:
    """Nor the name of a pass, however long."""
    name = "a pass with a name of more than forty letters"
    times = Spread(median=12345.678, min=9876.543, p95=54321.987)
    report: Any = {
        "scene": {"name": "corner"}, "size": [32, 24], "frames": 123, "gl": {"renderer": "r"},
        "passes": [{"name": name, "frames": 369, "gpu_ms": times, "cpu_ms": times}],
        "frame_gpu_ms": times, "frame_wall_ms": times, "frame_cpu_ms": times,
        "counters": {}, "bytes": {},
    }  # fmt: skip
    told = io.StringIO()
    print_tables(report, Console(file=told, width=80))
    rows = [line for line in told.getvalue().splitlines() if "12345.678" in line]
    assert len(rows) == 3
    assert name in rows[0]
    for row in rows:
        assert "9876.543" in row
        assert "54321.987" in row
        assert "\u2026" not in row


def test_a_spread_of_nothing_is_zero_and_of_one_is_itself() -> None:
    assert spread([]) == {"median": 0.0, "min": 0.0, "p95": 0.0}
    assert spread([2.0]) == {"median": 2.0, "min": 2.0, "p95": 2.0}
    assert spread([float(i) for i in range(101)]) == {"median": 50.0, "min": 0.0, "p95": 95.0}
