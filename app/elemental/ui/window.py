"""A glfw window with a GL 4.3 core context, and the events that happened in it since asked last."""

from __future__ import annotations

# imgui_bundle first: it names the libglfw that both must share, else two of them load.
import imgui_bundle  # noqa: F401  isort: skip
import ctypes
from dataclasses import dataclass, field
from typing import Any

import glfw

from elemental.core.errors import InputError
from elemental.ui.bindings import BINDINGS

glfw.ERROR_REPORTING = "ignore"  # errors are asked for where they matter, and told in one line

DRAG_BUTTONS = (glfw.MOUSE_BUTTON_LEFT, glfw.MOUSE_BUTTON_RIGHT)


@dataclass
class Events:
    """What happened since the last poll: pressed actions in order, mouse way, wheel notches."""

    pressed: list[tuple[str, int, bool]] = field(default_factory=list)
    """(action, which of its keys, Shift held)."""
    scroll: float = 0.0
    drag_px: tuple[float, float] = (0.0, 0.0)


class Window:
    """The window; made current and visible by its constructor.

    Raises InputError where there is no display or the driver gives no GL 4.3 core context.
    """

    def __init__(self, size: tuple[int, int], title: str, fullscreen: bool = False) -> None:
        if not glfw.init():
            raise InputError("run", "window", f"{_last_error()}; without one use `elemental shot`")
        for hint, value in (
            (glfw.CONTEXT_VERSION_MAJOR, 4),
            (glfw.CONTEXT_VERSION_MINOR, 3),
            (glfw.OPENGL_PROFILE, glfw.OPENGL_CORE_PROFILE),
            (glfw.OPENGL_FORWARD_COMPAT, glfw.TRUE),
            (glfw.DEPTH_BITS, 0),
            (glfw.STENCIL_BITS, 0),
        ):
            glfw.window_hint(hint, value)
        self.handle = glfw.create_window(*size, title, None, None)
        if not self.handle:
            reason = _last_error()
            glfw.terminate()
            raise InputError("run", "window", f"no GL 4.3 core context: {reason}")
        glfw.make_context_current(self.handle)
        glfw.swap_interval(1)
        self._windowed: tuple[int, int, int, int] | None = None
        self._pressed: list[tuple[str, int, bool]] = []
        self._scroll = 0.0
        self._cursor: tuple[float, float] | None = None
        self._actions = _key_actions("press")
        self._held = _key_actions("hold")
        glfw.set_key_callback(self.handle, self._on_key)
        glfw.set_scroll_callback(self.handle, self._on_scroll)
        if fullscreen:
            self.toggle_fullscreen()

    @property
    def address(self) -> int:
        """The GLFWwindow's address, for ImGui's backend."""
        return ctypes.cast(self.handle, ctypes.c_void_p).value or 0

    def get_proc_address(self, name: str) -> int:
        """The address of a GL function in the window's context; 0 if there is none."""
        return ctypes.cast(glfw.get_proc_address(name), ctypes.c_void_p).value or 0

    def framebuffer_size(self) -> tuple[int, int]:
        """Pixels to draw, (0, 0) while minimised."""
        width, height = glfw.get_framebuffer_size(self.handle)
        if glfw.get_window_attrib(self.handle, glfw.ICONIFIED):
            return 0, 0
        return int(width), int(height)

    def poll(self, wait_s: float = 0.0) -> Events:
        """Handle pending events, waiting up to ``wait_s`` for one."""
        if wait_s > 0.0:
            glfw.wait_events_timeout(wait_s)
        else:
            glfw.poll_events()
        events = Events(self._pressed, self._scroll, self._drag())
        self._pressed, self._scroll = [], 0.0
        return events

    def held(self, action: str) -> bool:
        """Whether a key of a ``hold`` binding is down."""
        if self._is_down(glfw.KEY_LEFT_CONTROL) or self._is_down(glfw.KEY_RIGHT_CONTROL):
            return False  # Ctrl+S is no flight backwards
        keys = (key for (key, _), (name, _) in self._held.items() if name == action)
        return any(self._is_down(key) for key in keys)

    def cursor_px(self) -> tuple[float, float]:
        """Where the mouse is, in pixels from the window's top left corner."""
        x, y = glfw.get_cursor_pos(self.handle)
        scale = glfw.get_framebuffer_size(self.handle)[0] / max(
            glfw.get_window_size(self.handle)[0], 1
        )
        return x * scale, y * scale

    def toggle_fullscreen(self) -> None:
        """Cover the primary monitor, or go back to the window's former place."""
        if self._windowed is not None:
            glfw.set_window_monitor(self.handle, None, *self._windowed, glfw.DONT_CARE)  # type: ignore[arg-type]
            self._windowed = None
            return
        monitor = glfw.get_primary_monitor()
        mode = glfw.get_video_mode(monitor) if monitor else None
        if mode is None:
            return
        place = glfw.get_window_pos(self.handle)
        self._windowed = (*place, *glfw.get_window_size(self.handle))
        rate = mode.refresh_rate
        glfw.set_window_monitor(self.handle, monitor, 0, 0, mode.size.width, mode.size.height, rate)

    def set_title(self, title: str) -> None:
        """Change the title bar."""
        glfw.set_window_title(self.handle, title)

    def should_close(self) -> bool:
        """Whether the user or ``close`` asked for the end."""
        return bool(glfw.window_should_close(self.handle))

    def close(self) -> None:
        """Ask for the end."""
        glfw.set_window_should_close(self.handle, True)

    def stay(self) -> None:
        """Take back that the end was asked for."""
        glfw.set_window_should_close(self.handle, False)

    def swap(self) -> None:
        """Show what was drawn."""
        glfw.swap_buffers(self.handle)

    def release(self) -> None:
        """Destroy the window and its context."""
        glfw.destroy_window(self.handle)
        glfw.terminate()

    def _is_down(self, key: int) -> bool:
        return bool(glfw.get_key(self.handle, key) == glfw.PRESS)

    def _drag(self) -> tuple[float, float]:
        cursor = glfw.get_cursor_pos(self.handle)
        pressed = any(
            glfw.get_mouse_button(self.handle, button) == glfw.PRESS for button in DRAG_BUTTONS
        )
        before, self._cursor = self._cursor, cursor if pressed else None
        if before is None or not pressed:
            return 0.0, 0.0
        return cursor[0] - before[0], cursor[1] - before[1]

    def _on_key(self, _window: Any, key: int, _scancode: int, event: int, modifiers: int) -> None:
        found = self._actions.get((key, bool(modifiers & glfw.MOD_CONTROL)))
        if event == glfw.PRESS and found is not None:
            self._pressed.append((*found, bool(modifiers & glfw.MOD_SHIFT)))

    def _on_scroll(self, _window: Any, _x: float, notches: float) -> None:
        self._scroll += notches


def _key_actions(kind: str) -> dict[tuple[int, bool], tuple[str, int]]:
    """(GLFW key, with Ctrl) of one kind of binding: action and which of the action's keys."""
    return {
        (getattr(glfw, f"KEY_{key}"), binding.ctrl): (binding.action, index)
        for binding in BINDINGS
        if binding.kind == kind
        for index, key in enumerate(binding.keys)
    }


def _last_error() -> str:
    _, description = glfw.get_error()
    text = description.decode(errors="replace") if isinstance(description, bytes) else description
    return " ".join((text or "no display").split())
