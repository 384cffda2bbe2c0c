"""``elemental run``: the window's loop, and what its keys and mouse do."""

from __future__ import annotations

import time
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from elemental.core.errors import InputError
from elemental.gpu.device import Device
from elemental.session import Stage, Viewpoint, set_stage
from elemental.ui import preferences
from elemental.ui.desk import Desk, Words
from elemental.ui.fly_camera import FAST_FACTOR
from elemental.ui.gui import WindowGui
from elemental.ui.window import Events, Window

if TYPE_CHECKING:
    from elemental.remote.server import Remote

HIDDEN_WAIT_S = 0.1
"""How often a minimised window looks for events."""
KEEP_S = 10.0
"""How often the panel's layout is kept while it changes."""


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
    panel: bool | None = None
    """Whether the panel shows at first; None as it was left."""
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
        app.desk.remote = remote
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
    """One window with a desk in it."""

    def __init__(self, window: Window, stage: Stage, words: Run) -> None:
        self.window, self.words = window, words
        try:
            self.device = Device.from_window(window.get_proc_address)
        except RuntimeError as error:
            raise InputError("", "", str(error)) from error
        self.device.watch_shaders()
        self._file: Path = preferences.preferences_file()
        self._kept = preferences.load(self._file)
        if words.panel is not None:
            self._kept.shows_panel = words.panel
        again = Words(words.scene, words.assignments)
        gui = WindowGui(window)
        self.desk = Desk(self.device, gui, stage, again, words.size, self._kept)
        self.desk.window_acts = self._act_on_window
        self._titled = self.desk.document.unsaved
        self._kept_at = time.perf_counter()

    def loop(self) -> None:
        """Draw frames until the end; a minimised window waits for events instead."""
        before = time.perf_counter()
        while self.desk.drawn != self.words.frames:
            if self.window.should_close():
                if self.desk.may_lose_edits("closing"):
                    break
                self.window.stay()
            size = self.window.framebuffer_size()
            hidden = 0 in size
            events = self.window.poll(HIDDEN_WAIT_S if hidden else 0.0)
            now = time.perf_counter()
            wall_s, before = now - before, now
            self.handle(events, self.desk.clock.advance(wall_s))
            if not hidden:
                self.draw(size, wall_s)

    def draw(self, size: tuple[int, int], wall_s: float = 0.0) -> None:
        """Draw one frame of ``size`` pixels, ``wall_s`` after the one before."""
        self.desk.draw(size, wall_s)
        self.window.swap()
        if self.desk.document.unsaved != self._titled:
            self._titled = self.desk.document.unsaved
            mark = "* " if self._titled else ""
            self.window.set_title(f"{mark}{self.desk.stage.scene.name} – elemental")
        if time.perf_counter() - self._kept_at > KEEP_S:
            self._keep()

    def handle(self, events: Events, frame_s: float = 0.0) -> None:
        """Act on keys and mouse, unless a panel has them; cameras move by ``frame_s``."""
        desk = self.desk
        for action, index, shift in () if desk.gui.wants_keys else events.pressed:
            desk.act(action, index, shift)
        if not desk.gui.wants_keys:
            self._fly(frame_s)
        if not desk.wants_mouse:
            desk.rides = desk.rides and not any(events.drag_px)
            desk.fly.look(*events.drag_px)
            desk.fly.scroll(events.scroll)

    def act(self, action: str, index: int = 0, shift: bool = False) -> None:
        """What a ``press`` binding does; ``index`` tells which of its keys."""
        self.desk.act(action, index, shift)

    def release(self) -> None:
        """Free everything, the window last."""
        self._keep()
        self.desk.release()
        self.device.release()
        self.window.release()

    def _act_on_window(self, action: str) -> None:
        match action:
            case "fullscreen":
                self.window.toggle_fullscreen()
            case "quit" | "close":
                if self.desk.may_lose_edits("Esc"):
                    self.window.close()

    def _fly(self, frame_s: float) -> None:
        held, fly = self.window.held, self.desk.fly
        factor = FAST_FACTOR if held("fly.fast") else 1.0
        factor = factor / FAST_FACTOR if held("fly.slow") else factor
        right = held("fly.right") - held("fly.left")
        up = held("fly.up") - held("fly.down")
        forward = held("fly.forward") - held("fly.back")
        self.desk.rides = self.desk.rides and not (right or up or forward)
        fly.fly(factor * right, factor * up, factor * forward, frame_s)

    def _keep(self) -> None:
        """Write the panel's layout to the user's folder where it changed."""
        self._kept_at = time.perf_counter()
        present = self.desk.preferences
        if present == self._kept:
            return
        self._kept = present
        try:
            preferences.save(self._file, present)
        except InputError as error:
            self.desk.say(str(error), "warning")
