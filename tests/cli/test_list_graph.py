# PP-01
"""``elemental list graph``: a frame's passes and targets as text and as JSON."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from cli.process import assert_refused, elemental
from cli.small_scene import write_corner

WORDS = ("--size", "32x24", "--set", "gi.resolution=64", "--set", "shadow.resolution=256")


def test_the_frame_s_graph_is_listed_and_written(tmp_path: Path) -> None:
    write_corner(tmp_path)
    result = elemental("list", "graph", "corner.gltf", *WORDS, "--json", "g.json", cwd=tmp_path)
    assert result.returncode == 0, result.stderr
    told = json.loads((tmp_path / "g.json").read_text())
    assert told["schema"] == "elemental.graph/1"
    assert (told["size"], told["view"]) == ([32, 24], "final")
    lines = result.stdout.splitlines()
    assert lines[0].split()[:3] == ["#", "pass", "kind"]
    count = len(told["passes"])
    assert [line.split()[0] for line in lines[1 : count + 1]] == [str(k) for k in range(count)]
    for number, entry in enumerate(told["passes"]):
        assert entry["name"] in lines[number + 1]
    for resource in told["resources"]:
        assert any(line.startswith(resource["name"]) for line in lines[count + 2 :])
        assert 0 <= resource["first_pass"] <= resource["last_pass"] < count
    assert sum(resource["kept"] for resource in told["resources"]) == 1
    for edge in told["edges"]:
        assert edge["producer"] < edge["consumer"] < count
        assert edge["resource"] in told["passes"][edge["producer"]]["writes"]
    assert sum(entry["gpu_ms"] for entry in told["passes"]) > 0.0
    assert told["pool"]["bytes"] == sum(held["nbytes"] for held in told["pool"]["held"])


def test_a_view_has_a_graph_of_its_own(tmp_path: Path) -> None:
    write_corner(tmp_path)
    words = ("list", "graph", "corner.gltf", *WORDS, "--view", "normal")
    result = elemental(*words, cwd=tmp_path)
    assert "gbuffer" in result.stdout
    assert "tonemap" not in result.stdout


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (("graph", "--view", "nonsense"), "--view: no such name"),
        (("graph", "nowhere.gltf"), "nowhere.gltf"),
        (("graph", "--json", "g.txt"), "--json: g.txt: the name must end in .json"),
        (("views", "--json", "g.json"), "list views: --json: is a flag of list graph"),
        (("settings", "--set", "exposure=1"), "list settings: --set: is a flag of list graph"),
    ],
)
def test_what_can_t_be_listed_is_refused(words: tuple[str, ...], expected: str) -> None:
    assert_refused(elemental("list", *words), expected)
