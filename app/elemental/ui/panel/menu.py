"""The menu bar: what can be done, with its keys; the scene's name; what the frame costs."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from imgui_bundle import imgui

from elemental.ui import icons, theme
from elemental.ui.bindings import BINDINGS
from elemental.ui.widgets import Widgets

KEYS = {binding.action: binding.keys_text() for binding in BINDINGS}


@dataclass(frozen=True)
class MenuState:
    """What the bar shows."""

    scene: str
    unsaved: bool
    undo: str | None
    redo: str | None
    view: str
    views: Mapping[str, str]
    pages: Sequence[str]
    hidden: frozenset[str]
    scale: float
    scales: Sequence[float]
    figures: str


def menu_bar(w: Widgets, state: MenuState, act: Callable[[str], None]) -> None:
    """Draw the bar; ``act`` is called with the action that was chosen."""
    item = _Items(w, act)
    if imgui.begin_menu("File"):
        item("save", "Save", KEYS["save"], state.unsaved)
        item("save.as", "Save as…", "Ctrl+Shift+S")
        item("revert", "Revert to saved", "", state.unsaved)
        imgui.separator()
        item("screenshot", "Screenshot", KEYS["screenshot"])
        item("page Sequence", "Render a sequence…")
        item("reload", "Reload scene and shaders", KEYS["reload"])
        imgui.separator()
        item("close", "Close")
        imgui.end_menu()
    w.note("File")
    if imgui.begin_menu("Edit"):
        item("undo", f"Undo {state.undo or ''}".rstrip(), KEYS["undo"], state.undo is not None)
        item("redo", f"Redo {state.redo or ''}".rstrip(), KEYS["redo"], state.redo is not None)
        imgui.end_menu()
    w.note("Edit")
    if imgui.begin_menu("View"):
        _view_menu(w, state, item)
        imgui.end_menu()
    w.note("View")
    if imgui.begin_menu("Help"):
        item("help", "Keys", KEYS["help"])
        imgui.end_menu()
    w.note("Help")
    _undo_buttons(w, state, act)
    _title(w, state)


def _view_menu(w: Widgets, state: MenuState, item: _Items) -> None:
    if imgui.begin_menu(f"Buffer: {state.view}"):
        for name, text in state.views.items():
            item(f"view {name}", name, "", ticked=name == state.view, help=text)
        imgui.end_menu()
    if imgui.begin_menu("Pages"):
        for name in state.pages:
            item(f"toggle {name}", name, "", ticked=name not in state.hidden)
        imgui.end_menu()
    w.note("Pages")
    if imgui.begin_menu("Scale"):
        for scale in state.scales:
            item(f"scale {scale}", f"{scale:.0%}", "", ticked=scale == state.scale)
        imgui.end_menu()
    w.note("Scale")
    item("layout.reset", "Reset layout")
    imgui.separator()
    item("panel", "Hide panel", KEYS["panel"])
    item("hud", "Pass times over the picture", KEYS["hud"])
    item("pixel", "Pixel under the mouse", KEYS["pixel"])
    item("fullscreen", "Fullscreen", KEYS["fullscreen"])


def _undo_buttons(w: Widgets, state: MenuState, act: Callable[[str], None]) -> None:
    imgui.push_style_color(imgui.Col_.button.value, theme.color(theme.BACKDROP, 0.0))
    for action, icon, label in (("undo", icons.UNDO, state.undo), ("redo", icons.REDO, state.redo)):
        if w.button(icon, action, label is not None, f"{action} {label or ''} ({KEYS[action]})"):
            act(action)
    imgui.pop_style_color()


def _title(w: Widgets, state: MenuState) -> None:
    """The scene's name in the middle, with a dot while it is unsaved; figures at the right."""
    width = imgui.get_window_width()
    title = f"{state.scene}{' (unsaved)' if state.unsaved else ''}"
    half = imgui.calc_text_size(title).x / 2
    after_menus = imgui.get_cursor_pos_x()
    imgui.set_cursor_pos_x(max(width / 2 - half, after_menus))
    w.text(title, theme.ACCENT if state.unsaved else theme.TEXT)
    w.note("title")
    left = width - imgui.calc_text_size(state.figures).x - imgui.get_style().window_padding.x
    if left > width / 2 + half:
        imgui.set_cursor_pos_x(left)
        w.text(state.figures, theme.MUTED)
        w.note("costs")


class _Items:
    """Menu items that call one function by their action."""

    def __init__(self, w: Widgets, act: Callable[[str], None]) -> None:
        self.w, self.act = w, act

    def __call__(
        self,
        action: str,
        label: str,
        keys: str = "",
        enabled: bool = True,
        ticked: bool = False,
        help: str = "",
    ) -> None:
        pressed, _ = imgui.menu_item(label, keys, ticked, enabled)
        self.w.note(action)
        self.w.tooltip(help)
        if pressed:
            self.act(action)
