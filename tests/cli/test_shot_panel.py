"""AP-03: ``elemental shot --ui`` draws the panel around the picture, headless."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from cli.process import assert_refused, elemental
from cli.small_scene import write_corner
from elemental.core.images import read_png_jpeg_webp

SMALL = ("--size", "640x360", "--set", "gi.enabled=false", "--set", "shadow.resolution=256")


def test_the_panel_stands_around_the_picture(tmp_path: Path) -> None:
    write_corner(tmp_path)
    for name, words in (("plain", ()), ("panel", ("--ui",)), ("log", ("--ui-page", "Log"))):
        result = elemental("shot", "corner.gltf", "-o", f"{name}.png", *SMALL, *words, cwd=tmp_path)
        assert result.returncode == 0, result.stderr
    plain, panel, log = (
        read_png_jpeg_webp(tmp_path / f"{n}.png") for n in ("plain", "panel", "log")
    )
    assert plain.shape == panel.shape == (360, 640, 4)
    right = panel[100:300, 500:, :3].astype(int)
    assert (np.ptp(right, axis=2) < 12).mean() > 0.8  # the panel's greys
    assert not np.array_equal(panel, log)
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "corner.gltf", "log.png", "panel.png", "plain.png",
    ]  # fmt: skip


def test_what_the_panel_can_not_do_is_refused(tmp_path: Path) -> None:
    write_corner(tmp_path)
    shot = ("shot", "corner.gltf", *SMALL)
    result = elemental(*shot, "-o", "a.exr", "--ui", cwd=tmp_path)
    assert_refused(result, "-o", "a picture with the panel is a .png")
    result = elemental(*shot, "-o", "a.png", "--ui", "--report", "r.json", cwd=tmp_path)
    assert_refused(result, "--report", "not together with --ui")
    result = elemental(*shot, "-o", "a.png", "--ui-page", "Lgo", cwd=tmp_path)
    assert_refused(result, "--ui-page", "did you mean 'Log'?")
