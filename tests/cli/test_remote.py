# PP-11
"""``elemental run --remote``: off unless asked for, and the window follows."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import urllib.request
from pathlib import Path

import pytest

from cli.process import APP, assert_refused, elemental
from cli.small_scene import write_corner
from cli.xvfb import display

__all__ = ["display"]

SMALL = ("--size", "96x64", "--set", "gi.resolution=64", "--set", "shadow.resolution=256")
SCENE = '[[models]]\nfile = "corner.gltf"\n[[volumes]]\nname = "lamp"\n'


def test_a_running_window_takes_a_weight(tmp_path: Path, display: str) -> None:
    write_corner(tmp_path)
    (tmp_path / "yard.toml").write_text(SCENE)
    words = ["run", "yard.toml", *SMALL, "--remote", "0", "--frames", "2000"]
    running = subprocess.Popen(
        [sys.executable, "-m", "elemental", *words],
        cwd=tmp_path,
        env=os.environ | {"PYTHONPATH": str(APP), "DISPLAY": display},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        assert running.stdout is not None
        line = running.stdout.readline()
        match = re.fullmatch(
            r"remote: (http://127\.0\.0\.1:\d+/volumes), Authorization: (Bearer \S+)\n", line
        )
        assert match is not None, line

        def ask(path: str, value: str | None) -> object:
            request = urllib.request.Request(
                match[1] + path,
                None if value is None else value.encode(),
                {"Authorization": match[2]},
                method="GET" if value is None else "PUT",
            )
            with urllib.request.urlopen(request, timeout=60) as response:
                return json.load(response)

        wanted = {"volume": "lamp", "property": "weight", "value": 0.5}
        assert ask("/lamp/weight", "0.5") == wanted
        told = ask("/lamp", None)
        assert isinstance(told, dict)
        assert told["weight"] == 0.5
        assert running.poll() is None
    finally:
        running.terminate()
        running.communicate(timeout=30)


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (("--remote", "70000"), "'70000' is not a port, 0 to 65535"),
        (("--remote", "yard.toml"), "'yard.toml' is not a port"),
        (("--remote-host", "0.0.0.0"), "needs --remote or --osc"),
        (("--remote", "0", "--remote-host", "example.org"), "is not an IP address"),
        (("--remote", "0", "--remote-host", "192.0.2.1"), "can't be listened on"),
    ],
)
def test_what_can_t_be_is_refused(tmp_path: Path, words: tuple[str, ...], expected: str) -> None:
    write_corner(tmp_path)
    assert_refused(elemental("run", "corner.gltf", *SMALL, *words, cwd=tmp_path), expected)
