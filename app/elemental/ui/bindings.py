"""Every key and mouse binding, once: window, help overlay and ``elemental list bindings``."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

KEY_SIGNS = {"PERIOD": ".", "LEFT_SHIFT": "Shift", "LEFT_ALT": "Alt", "ESCAPE": "Esc"}
"""How a GLFW key name is shown, where its own name in lower case is not good enough."""


@dataclass(frozen=True)
class Binding:
    """One action and what triggers it.

    ``keys`` are GLFW names without ``KEY_``; each of them triggers the action. ``hold`` acts as
    long as a key is down, ``press`` once, ``mouse`` is a gesture that ``keys`` only describes.
    """

    action: str
    kind: Literal["hold", "press", "mouse"]
    keys: tuple[str, ...]
    help: str
    ctrl: bool = False
    """Whether Ctrl is held with the key."""

    def keys_text(self) -> str:
        """The keys as one reads them on a keyboard: ``W``, ``1 to 9``, ``E or Page Up``."""
        signs = [KEY_SIGNS.get(key, key.replace("_", " ").title()) for key in self.keys]
        if len(signs) > 3:
            return f"{signs[0]} to {signs[-1]}"
        return " or ".join(f"Ctrl+{sign}" if self.ctrl else sign for sign in signs)


BINDINGS = (
    Binding("fly.forward", "hold", ("W", "UP"), "fly forward"),
    Binding("fly.back", "hold", ("S", "DOWN"), "fly back"),
    Binding("fly.left", "hold", ("A", "LEFT"), "fly left"),
    Binding("fly.right", "hold", ("D", "RIGHT"), "fly right"),
    Binding("fly.up", "hold", ("E", "PAGE_UP"), "fly up"),
    Binding("fly.down", "hold", ("C", "PAGE_DOWN"), "fly down"),
    Binding("fly.fast", "hold", ("LEFT_SHIFT",), "fly four times faster"),
    Binding("fly.slow", "hold", ("LEFT_ALT",), "fly four times slower"),
    Binding("fly.look", "mouse", ("Mouse drag",), "look around, left or right button"),
    Binding("fly.speed", "mouse", ("Mouse wheel",), "flying speed"),
    Binding("panel.type", "mouse", ("Ctrl+click",), "type a number into a slider of the panel"),
    Binding(
        "panel.zoom", "mouse", ("Wheel over a page",), "scroll it; zoom into Graph and Buffers"
    ),
    Binding("camera.pick", "press", tuple("123456789"), "go to that camera of the scene"),
    Binding(
        "camera.home", "press", ("HOME", "0"), "go back to the first view, or onto the camera path"
    ),
    Binding("help", "press", ("F1",), "show or hide this list"),
    Binding("panel", "press", ("F5",), "show or hide the panel"),
    Binding("hud", "press", ("F6",), "show or hide pass times and counters"),
    Binding("pixel", "press", ("Q",), "show the values of the pixel under the mouse, or not"),
    Binding("fullscreen", "press", ("F11",), "fullscreen or window"),
    Binding("screenshot", "press", ("F12",), "write a PNG into the working directory"),
    Binding("reload", "press", ("R",), "reload scene and shaders"),
    Binding("view.next", "press", ("V",), "next buffer view; with Shift the one before"),
    Binding("pause", "press", ("SPACE",), "stop or go on with scene time"),
    Binding("step", "press", ("PERIOD",), "stop and advance scene time by one frame, 1/60 s"),
    Binding(
        "undo", "press", ("Z",), "take back the last edit; with Shift bring it back", ctrl=True
    ),
    Binding("redo", "press", ("Y",), "bring back what was taken back", ctrl=True),
    Binding("save", "press", ("S",), "save the scene; with Shift under a new name", ctrl=True),
    Binding("quit", "press", ("ESCAPE",), "close what is open, or the window"),
)
