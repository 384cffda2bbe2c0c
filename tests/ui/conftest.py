"""A headless desk with hands, over a scene file in a folder of its own."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from imgui_bundle import imgui
from imgui_bundle.imgui import backends

from cli.small_scene import write_corner
from elemental.frame import Renderer
from elemental.gpu.device import Device
from elemental.ui.gui import Gui
from ui.robot import Robot

SCENE = """# A corner, lit from above.
name = "Corner"

[settings]
"shadow.resolution" = 256   # enough for a corner
exposure = 0.25             # a little brighter

[[models]]
file = "corner.gltf"        # beside this file

[[lights]]
kind = "directional"
direction = [0.2, -1.0, -0.6]
intensity = 1.0
"""


@pytest.fixture
def scene_file(tmp_path: Path) -> Path:
    """A scene file with comments, that names a small model."""
    write_corner(tmp_path)
    path = tmp_path / "scene.toml"
    path.write_text(SCENE)
    return path


PICTURE = (96, 54)
"""The scene's picture in a test, stretched over its place: what counts is around it."""


COARSER = 1 / 8
"""The panel's pixels in a test, by its own: it is laid out and drawn whole, and nobody looks."""


def draw_coarsely(_gui: Gui) -> None:
    """As ``Gui.draw``, in a corner of the window."""
    drawn = imgui.get_draw_data()
    drawn.framebuffer_scale = imgui.ImVec2(COARSER, COARSER)
    backends.opengl3_render_draw_data(drawn)


@pytest.fixture
def hands(device: Device, monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[..., Robot]]:
    """Makes desks with hands: ``hands(path, "key=value", page="Settings")``."""
    made: list[Robot] = []
    monkeypatch.setattr(Renderer, "resize", lambda self, size: setattr(self, "size", PICTURE))
    monkeypatch.setattr(Gui, "draw", draw_coarsely)

    def make(path: Path, *words: str, **options: object) -> Robot:
        made.append(Robot(device, path, *words, **options))  # type: ignore[arg-type]
        return made[-1]

    yield make
    for robot in made:
        robot.screen.release()
