"""``elemental run`` in a window under Xvfb."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

import pytest

from cli.process import APP, elemental
from cli.small_scene import write_corner
from cli.xvfb import display

__all__ = ["display"]

SMALL = ("--size", "96x64", "--set", "gi.resolution=64", "--set", "shadow.resolution=256")


def test_thirty_frames_and_out(tmp_path: Path, display: str) -> None:
    write_corner(tmp_path)
    result = elemental(
        "run", "corner.gltf", *SMALL, "--frames", 30, cwd=tmp_path, **environment(tmp_path, display)
    )
    assert (result.returncode, result.stderr) == (0, "")
    assert [path.name for path in tmp_path.iterdir()] == ["corner.gltf"]  # no imgui.ini


def test_fullscreen_and_back_out(tmp_path: Path, display: str) -> None:
    write_corner(tmp_path)
    words = ("run", "corner.gltf", *SMALL, "--fullscreen", "--frames", 2)
    result = elemental(*words, cwd=tmp_path, **environment(tmp_path, display))
    assert (result.returncode, result.stderr) == (0, "")


MINIMISED = """
import sys
from elemental.cli import main
from elemental.ui.window import Window
sizes, real = iter([(0, 0)] * 5), Window.framebuffer_size
Window.framebuffer_size = lambda self: next(sizes, None) or real(self)
sys.exit(main(sys.argv[1:]))
"""


BROKEN_SHADER = """
import shutil, sys
from dataclasses import replace
from pathlib import Path
import elemental.gpu.device as device
from elemental.session import Viewpoint, set_stage
from elemental.ui.app import App, Run
from elemental.ui.window import Window

root = Path("glsl").resolve()
shutil.copytree(device.glsl_root(), root)
device.glsl_root = lambda: root
words = Run("corner.gltf", (96, 64), ["gi.enabled=false"], False, 2)
stage = set_stage(words.scene, words.assignments, Viewpoint(), words.size)
app = App(Window(words.size, "elemental"), stage, words)
app.device.stop_watching_shaders()  # ask the files each frame: no edit is missed by a moment
shader = root / "post/tonemap.frag.glsl"
good = shader.read_text()

def picture_after(source):
    shader.write_text(source)
    app.words = replace(app.words, frames=app.desk.drawn + 2)
    app.loop()
    return app.desk.renderer.read(app.desk.frame).tobytes()

before = picture_after(good)
assert picture_after(good + "\\nthis is no GLSL\\n") == before
problems = app.desk.problems
assert len(problems) == 1 and "tonemap.frag.glsl:" in problems[0], problems
assert picture_after(good) == before and app.desk.problems == []
app.release()
"""


PANELS = """
import elemental.ui.pages as ui
from elemental.session import Viewpoint, set_stage
from elemental.ui.app import App, Run
from elemental.ui.window import Window

words = Run("corner.gltf", (96, 64), ["gi.enabled=false"], False, 1, panel=False)
stage = set_stage(words.scene, words.assignments, Viewpoint(), words.size)
app = App(Window(words.size, "elemental"), stage, words)
drawn = []
ui.draw_hud = lambda figures, place, fonts: drawn.append(figures.size)
ui.draw_keys = lambda: drawn.append("help")
ui.draw_message = lambda text, place, rgb: drawn.append(text)

def after(action):
    app.act(action)
    drawn.clear()
    app.draw((96, 64))
    return list(drawn)

app.draw((96, 64))
assert after("hud") == [(96, 64)], drawn
assert after("pause") == [(96, 64), "paused"], drawn
assert after("pause") == [(96, 64), "playing"], drawn
assert after("help") == ["help", "playing"], drawn
assert after("help") == [(96, 64), "playing"], drawn
app.device.storage_limit = 16 + 4 * 96 * 16
assert after("hud") == ["playing"] and app.desk.renderer.size == (48, 32), app.desk.renderer.size
app.release()
"""


def environment(folder: Path, display: str) -> dict[str, str]:
    """The tests' environment with a display, and the user's settings beside ``folder``."""
    home = {"XDG_CONFIG_HOME": str(folder.with_name(f"{folder.name}.config"))}
    return os.environ | {"PYTHONPATH": str(APP), "DISPLAY": display} | home


def run_python(code: str, *words: str, folder: Path, display: str) -> tuple[int, str]:
    """Exit code and stderr of ``code`` as a script in ``folder``, where corner.gltf lies."""
    write_corner(folder)
    result = subprocess.run(
        [sys.executable, "-c", code, *words],
        cwd=folder,
        env=environment(folder, display),
        capture_output=True,
        text=True,
        check=False,
    )
    return result.returncode, result.stderr


def test_a_minimised_window_waits_and_goes_on(tmp_path: Path, display: str) -> None:
    words = ("run", "corner.gltf", *SMALL, "--frames", "2")
    assert run_python(MINIMISED, *words, folder=tmp_path, display=display) == (0, "")


def test_a_broken_shader_keeps_its_last_good_program(tmp_path: Path, display: str) -> None:
    code, stderr = run_python(BROKEN_SHADER, folder=tmp_path, display=display)
    assert code == 0, stderr
    assert "keeps its last good program" in stderr
    assert "Traceback" not in stderr


def test_help_covers_the_figures_and_a_size_the_driver_cannot_draw_is_scaled(
    tmp_path: Path, display: str
) -> None:
    assert run_python(PANELS, folder=tmp_path, display=display) == (0, "")


@pytest.mark.skipif(shutil.which("xdotool") is None, reason="xdotool is not installed")
def test_keys_mouse_and_a_storm_of_sizes(tmp_path: Path, display: str) -> None:
    write_corner(tmp_path)
    variables = environment(tmp_path, display)

    def act(*words: str) -> None:
        subprocess.run(["xdotool", *words], env=variables, check=True, timeout=60)

    command = [sys.executable, "-m", "elemental", "run", "corner.gltf", *SMALL]
    with subprocess.Popen(
        command, cwd=tmp_path, env=variables, stderr=subprocess.PIPE, text=True
    ) as process:
        try:
            act("search", "--sync", "--onlyvisible", "--name", "elemental", "windowfocus")
            keys = "F1 F1 F6 F6 v v shift+v 1 9 0 Home space period space r F12"
            for key in keys.split():
                act("key", key)
                time.sleep(0.1)
            act("keydown", "w", "keydown", "e", "sleep", "0.2", "keyup", "w", "keyup", "e")
            act("mousemove", "40", "30", "mousedown", "3", "mousemove", "60", "40", "mouseup", "3")
            act("click", "4", "click", "5")
            for size in ("1 1", "300 2", "2 200", "640 360", "96 64"):
                act("search", "--name", "elemental", "windowsize", *size.split())
                time.sleep(0.2)
            act("key", "Escape")
            _, stderr = process.communicate(timeout=60)
        finally:
            process.kill()
    assert (process.returncode, stderr) == (0, "")
    assert len(list(tmp_path.glob("elemental-*.png"))) == 1
