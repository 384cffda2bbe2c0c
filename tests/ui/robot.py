"""An artist's hands on a headless desk: finds items by what they say, points, clicks and types."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from imgui_bundle import imgui

from elemental.gpu.device import Device
from elemental.session import Viewpoint, set_stage
from elemental.ui.desk import Desk, Words
from elemental.ui.headless import HeadlessDesk
from elemental.ui.images import Place
from elemental.ui.words import Rect

SIZE = (1000, 640)
QUICK = (
    "gi.enabled=false",
    "shadow.resolution=256",
    "eye_adaptation.min_brightness=1",  # no adaptation: pictures of one state are equal
    "eye_adaptation.max_brightness=1",
)
DOUBLE_CLICK_FRAMES = 30
"""Longer than ImGui waits for a second click."""


class Robot:
    """Hands, on a desk with the scene of ``path``."""

    def __init__(
        self,
        device: Device,
        path: Path,
        *words: str,
        page: str = "Settings",
        size: Any = SIZE,
        scale: float = 1.0,
    ) -> None:
        assignments = [*QUICK, *words]
        stage = set_stage(str(path), assignments, Viewpoint(), size)
        again = Words(str(path), assignments)
        self.screen = HeadlessDesk(device, stage, again, size, records=True, scale=scale)
        self.desk: Desk = self.screen.desk
        self.desk.clock.paused = True
        self.page = page
        self.desk.workspace.bring_to_front(page)
        self.frames(3)

    def frames(self, count: int = 1) -> None:
        """Let some frames pass."""
        for _ in range(count):
            self.screen.draw()

    def find(self, label: str) -> Rect:
        """Where an item of the page (or of ``page/label``) is; it has to be in sight."""
        items = self.desk.workspace.widgets.items
        assert items is not None
        name = label if "/" in label else f"{self.page}/{label}"
        assert name in items, f"{name!r} is not among {sorted(items)}"
        return items[name]

    def sees(self, label: str) -> bool:
        """Whether an item is in sight."""
        items = self.desk.workspace.widgets.items
        return items is not None and (label if "/" in label else f"{self.page}/{label}") in items

    def move(self, x: float, y: float) -> None:
        """Put the mouse somewhere."""
        imgui.get_io().add_mouse_pos_event(x, y)
        self.frames()

    def point(self, label: str, across: float = 0.5) -> None:
        """Put the mouse on an item, ``across`` of its width."""
        left, top, right, bottom = self.find(label)
        self.move(left + across * (right - left), (top + bottom) / 2)

    def button(self, down: bool) -> None:
        """Press or let go of the left button."""
        imgui.get_io().add_mouse_button_event(0, down)
        self.frames()

    def click(self, label: str, across: float = 0.5) -> None:
        """Point and click."""
        self.point(label, across)
        self.button(True)
        self.button(False)
        self.frames(2)

    def drag(self, label: str, start: float, end: float, steps: int = 4) -> None:
        """Hold an item and pull, by shares of its width."""
        left, top, right, bottom = self.find(label)
        y = (top + bottom) / 2
        self.move(left + start * (right - left), y)
        self.button(True)
        for step in range(1, steps + 1):
            share = start + (end - start) * step / steps
            self.move(left + share * (right - left), y)
        self.button(False)
        self.frames()

    def type(self, text: str, enter: bool = True) -> None:
        """Type into the field that has the keyboard, over what it holds."""
        self.key(imgui.Key.a, imgui.Key.mod_ctrl)
        imgui.get_io().add_input_characters_utf8(text)
        self.frames(2)
        if enter:
            self.key(imgui.Key.enter)

    def enter_number(self, label: str, text: str) -> None:
        """Ctrl and a click on a slider, then the number."""
        io = imgui.get_io()
        io.add_key_event(imgui.Key.mod_ctrl, True)
        self.click(label)
        io.add_key_event(imgui.Key.mod_ctrl, False)
        self.frames()
        self.type(text)

    def await_image(self, place: Place) -> None:
        """Let frames pass until no file is being read for a place."""
        end = time.monotonic() + 30
        self.frames(2)
        while self.desk.images.is_reading(place):
            assert time.monotonic() < end
            time.sleep(0.005)
            self.frames()
        self.frames(2)

    def enter_image(self, place: Place, text: str) -> None:
        """Type a file's name into the row of a place, or nothing, and wait for its image."""
        self.click(place.name)
        if text:
            self.type(text)
        else:
            self.key(imgui.Key.a, imgui.Key.mod_ctrl)
            self.key(imgui.Key.delete)
            self.key(imgui.Key.enter)
        self.await_image(place)

    def key(self, key: imgui.Key, modifier: imgui.Key | None = None) -> None:
        """Press a key."""
        io = imgui.get_io()
        for down in (True, False):
            for one in (modifier, key) if modifier is not None else (key,):
                io.add_key_event(one, down)
            self.frames()

    def menu(self, *labels: str) -> None:
        """Open a menu and choose."""
        for label in labels:
            self.click(f"menu/{label}")

    def pixels(self) -> npt.NDArray[Any]:
        """The picture alone, (H, W, 4) uint8, without the panel."""
        self.frames()
        frame = self.desk.frame
        assert frame is not None
        return np.array(self.desk.renderer.read(frame))

    def setting(self, key: str) -> Any:
        """The document's value."""
        return self.desk.document.state.settings[key]
