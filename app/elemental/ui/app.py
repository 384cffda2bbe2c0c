"""``elemental run``: the window's loop and what each binding does."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from elemental.core.errors import InputError
from elemental.frame import VIEWS, Frame, Renderer
from elemental.gpu.device import Device
from elemental.picture import save_picture
from elemental.scene.evaluate import placed_camera
from elemental.session import Stage, Viewpoint, set_stage
from elemental.ui.averages import Averages
from elemental.ui.clock import SceneClock
from elemental.ui.fly_camera import FAST_FACTOR, FlyCamera
from elemental.ui.gui import Gui
from elemental.ui.hud import Figures, draw_help, draw_hud, draw_message
from elemental.ui.present import present
from elemental.ui.window import Events, Window

if TYPE_CHECKING:
    from elemental.remote.server import Remote

MESSAGE_S = 4.0
"""How long a message stays."""
HIDDEN_WAIT_S = 0.1
"""How often a minimised window looks for events."""


@dataclass(frozen=True)
class Run:
    """The words of one ``elemental run``; ``size`` in pixels, ``frames`` None until closed.

    ``remote`` and ``osc``: ports of the remote control, 0 for any, None without it.
    """

    scene: str | None
    size: tuple[int, int]
    assignments: list[str]
    fullscreen: bool
    frames: int | None
    remote: int | None = None
    osc: int | None = None
    remote_host: str | None = None


def run(words: Run) -> None:
    """Show the scene until the window is closed or ``words.frames`` are drawn.

    Raises InputError for a bad scene or setting and where no window can be had.
    """
    stage = set_stage(words.scene, words.assignments, Viewpoint(), words.size)
    remote = _remote(words, stage)
    try:
        window = Window(words.size, f"{stage.scene.name} – elemental", words.fullscreen)
        app = App(window, stage, words)
        app.remote = remote
        try:
            app.loop()
        finally:
            app.release()
    finally:
        if remote is not None:
            remote.release()


def _remote(words: Run, stage: Stage) -> Remote | None:
    """The remote control that was asked for. Raises InputError."""
    if words.remote is None and words.osc is None:
        if words.remote_host is not None:
            raise InputError("--remote-host", words.remote_host, "needs --remote or --osc")
        return None
    from elemental.remote.server import LOOPBACK, Remote  # noqa: PLC0415 (asyncio: 50 ms)

    remote = Remote(words.remote_host or LOOPBACK, words.remote, words.osc)
    remote.update(stage.scene, stage.settings)
    for line in remote.announcement:
        print(line, flush=True)
    return remote


class App:
    """One window, one scene, one renderer."""

    def __init__(self, window: Window, stage: Stage, words: Run) -> None:
        self.window, self.stage, self.words = window, stage, words
        self.device = Device.from_window(window.get_proc_address)
        self.gui = Gui(window)
        self.renderer = Renderer(self.device, stage.scene, stage.settings, words.size)
        self.renderer.spreads_gathers = True
        self.fly = FlyCamera.at(stage.camera, _diagonal(stage))
        self.rides = stage.camera_moves
        """Whether the scene moves the camera, until the user does."""
        self.clock = SceneClock()
        self.averages = Averages()
        self.views = list(VIEWS)
        self.view = "final"
        self.drawn = 0
        self.shows_hud, self.shows_help = True, False
        self.frame: Frame | None = None
        self.problems: list[str] = []
        self.remote: Remote | None = None
        self._wall_s = self._frame_s = self._cpu_ms = 0.0
        self._message, self._message_until = "", 0.0

    def loop(self) -> None:
        """Draw frames until the end; a minimised window waits for events instead."""
        before = time.perf_counter()
        while not self.window.should_close() and self.drawn != self.words.frames:
            size = self.window.framebuffer_size()
            hidden = 0 in size
            events = self.window.poll(HIDDEN_WAIT_S if hidden else 0.0)
            now = time.perf_counter()
            self._wall_s, before = now - before, now
            self._frame_s = self.clock.advance(self._wall_s)
            self.handle(events)
            if not hidden:
                self.draw(size)

    def draw(self, size: tuple[int, int]) -> None:
        """Render one frame of ``size`` pixels and show it under the panels."""
        self._reload_shaders()
        began = time.perf_counter()
        self.renderer.resize(size)
        if self.remote is not None:
            self.remote.update(self.stage.scene, self.renderer.settings)
        if self.rides:
            self.fly.jump(self.stage.camera_at(self.clock.time_s))
        self.frame = self.renderer.render(
            self.fly.camera(), self.clock.time_s, self.drawn, self.view
        )
        present(self.device, self.frame, size)
        self._cpu_ms = 1e3 * (time.perf_counter() - began)
        timings = [(timing.name, timing.gpu_ms) for timing in self.device.timings]
        self.averages.update([("frame", 1e3 * self._wall_s), *timings], self._wall_s)
        with self.gui.frame():
            self._panels()
        self.window.swap()
        self.drawn += 1

    def handle(self, events: Events) -> None:
        """Act on keys and mouse, unless a panel has them."""
        if not self.gui.wants_keys:
            for action, index, shift in events.pressed:
                self.act(action, index, shift)
            self._fly()
        if not self.gui.wants_mouse:
            self.rides = self.rides and not any(events.drag_px)
            self.fly.look(*events.drag_px)
            self.fly.scroll(events.scroll)

    def act(self, action: str, index: int = 0, shift: bool = False) -> None:
        """What a ``press`` binding does; ``index`` tells which of its keys."""
        match action:
            case "camera.pick":
                self._pick_camera(index)
            case "camera.home":
                self.rides = self.stage.camera_moves
                self.fly.jump(self.stage.camera)
            case "help":
                self.shows_help = not self.shows_help
            case "hud":
                self.shows_hud = not self.shows_hud
            case "fullscreen":
                self.window.toggle_fullscreen()
            case "screenshot":
                self._screenshot()
            case "reload":
                self._reload()
            case "view.next":
                way = -1 if shift else 1
                self.view = self.views[(self.views.index(self.view) + way) % len(self.views)]
                self.say(f"{self.view}: {VIEWS[self.view]}")
            case "pause":
                self.clock.toggle()
                self.say("paused" if self.clock.paused else "playing")
            case "step":
                self.clock.step()
            case "quit" if self.shows_help:
                self.shows_help = False
            case "quit":
                self.window.close()

    def say(self, message: str) -> None:
        """Show a line for a while."""
        self._message, self._message_until = message, time.perf_counter() + MESSAGE_S

    def release(self) -> None:
        """Free everything, the window last."""
        self.gui.release()
        self.renderer.release()
        self.device.release()
        self.window.release()

    def _reload_shaders(self) -> None:
        """Take over edited shaders; what does not compile is told and its old program kept."""
        self.device.reload_changed_shaders()
        self.problems = self.renderer.problems()

    def _fly(self) -> None:
        held = self.window.held
        factor = FAST_FACTOR if held("fly.fast") else 1.0
        factor = factor / FAST_FACTOR if held("fly.slow") else factor
        right = held("fly.right") - held("fly.left")
        up = held("fly.up") - held("fly.down")
        forward = held("fly.forward") - held("fly.back")
        self.rides = self.rides and not (right or up or forward)
        self.fly.fly(factor * right, factor * up, factor * forward, self._frame_s)

    def _pick_camera(self, index: int) -> None:
        cameras = self.stage.scene.cameras
        if index < len(cameras):
            self.rides = False
            self.fly.jump(placed_camera(self.stage.scene, cameras[index], self.clock.time_s))
            self.say(f"camera {index + 1}: {cameras[index].name}")
        else:
            self.say(f"the scene has {len(cameras)} cameras")

    def _screenshot(self) -> None:
        if self.frame is None:
            return
        stamp = time.strftime("%Y%m%d-%H%M%S")
        path = Path(f"elemental-{stamp}-{self.drawn}.png").resolve()
        try:
            save_picture(path, self.renderer.read(self.frame), self.frame.is_linear)
        except InputError as error:
            self.say(str(error))
        else:
            self.say(f"wrote {path}")

    def _reload(self) -> None:
        """Read the scene again; a broken one is reported and the old one stays."""
        size = self.window.framebuffer_size()
        if 0 in size:
            return
        words = self.words
        try:
            stage = set_stage(words.scene, words.assignments, Viewpoint(), size)
        except InputError as error:
            self.say(str(error))
            return
        self.frame = None
        self.renderer.release()
        self.stage = stage
        self.renderer = Renderer(self.device, stage.scene, stage.settings, self.renderer.size)
        self.fly = replace(self.fly, diagonal=_diagonal(stage))
        self.say(f"reloaded {stage.scene.name}")

    def _panels(self) -> None:
        if self.shows_hud and not self.shows_help and self.frame is not None:
            draw_hud(self._figures(self.frame))
        if self.shows_help:
            draw_help()
        if time.perf_counter() < self._message_until:
            draw_message(self._message)

    def _figures(self, frame: Frame) -> Figures:
        passes, settings = dict(self.averages.values), self.stage.settings
        return Figures(
            scene=self.stage.scene.name,
            driver=self.device.info.renderer,
            view=self.view,
            size=self.renderer.size,
            voxels=settings["gi.resolution"] if settings["gi.enabled"] else 0,
            frame_ms=passes.pop("frame", 0.0),
            cpu_ms=self._cpu_ms,
            passes=passes,
            counters=frame.counters,
            bytes=self.device.bytes(),
            time_s=self.clock.time_s,
            paused=self.clock.paused,
            speed=self.fly.speed,
            problems=self.problems,
        )


def _diagonal(stage: Stage) -> float:
    low, high = stage.scene.bounds()
    return float(np.linalg.norm(high.astype(np.float64) - low))
