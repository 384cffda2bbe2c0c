"""The panel as a whole: a menu bar, and pages docked around the picture."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

from imgui_bundle import imgui

from elemental.ui.widgets import Widgets
from elemental.ui.words import Rect

DOCK = "workspace"
LEFT_SHARE, RIGHT_SHARE, BOTTOM_SHARE = 0.17, 0.32, 0.34
"""Of what is left of the window's width and height, in this order."""
SETTLING_FRAMES = 3
"""Until docked windows have taken their places."""


@dataclass(frozen=True)
class Page:
    """A dockable window; ``draw`` makes its widgets."""

    name: str
    place: Literal["left", "right", "bottom"]
    draw: Callable[[Widgets], None]


class Workspace:
    """Pages and where they are. ``layout``: ImGui's text of an earlier run, empty for ours."""

    def __init__(self, widgets: Widgets, pages: Sequence[Page], layout: str = "") -> None:
        self.widgets = widgets
        self.pages = tuple(pages)
        self.hidden: set[str] = set()
        self._front: list[str] = []
        """Pages to bring to the front, one a frame; several times each: docks settle slowly."""
        self._wants_layout = True
        if layout:
            imgui.load_ini_settings_from_memory(layout)
            self._wants_layout = DOCK not in layout

    def layout(self) -> str:
        """The places of everything, as ``Workspace`` takes it again."""
        return f"; {DOCK}\n{imgui.save_ini_settings_to_memory()}"

    def reset_layout(self) -> None:
        """Put every page back where it was at first."""
        self._wants_layout = True
        self.hidden.clear()

    def bring_to_front(self, name: str) -> None:
        """Show a page before those that share its place, with the next frame."""
        self.hidden.discard(name)
        self._front += [name] * SETTLING_FRAMES

    @property
    def is_settled(self) -> bool:
        """Whether every page is where and as it was asked for."""
        return not (self._front or self._wants_layout)

    def draw(self, menu: Callable[[Widgets], None]) -> Rect:
        """All widgets of a frame. Returns the picture's place between them."""
        w = self.widgets
        w.begin_frame()
        w.page = "menu"
        if imgui.begin_main_menu_bar():
            menu(w)
            imgui.end_main_menu_bar()
        dock = imgui.get_id(DOCK)
        if self._wants_layout:
            self._wants_layout = False
            self._build(dock)
        flags = imgui.DockNodeFlags_.passthru_central_node.value
        flags |= imgui.DockNodeFlags_.no_docking_over_central_node.value
        imgui.dock_space_over_viewport(dock, imgui.get_main_viewport(), flags)
        node = imgui.internal.dock_builder_get_central_node(dock)
        place = (node.pos.x, node.pos.y, node.pos.x + node.size.x, node.pos.y + node.size.y)
        front = self._front.pop(0) if self._front else ""
        for page in self.pages:
            if page.name not in self.hidden:
                self._draw_page(page, page.name == front)
        return place

    def _draw_page(self, page: Page, to_front: bool) -> None:
        if to_front:
            imgui.set_next_window_focus()
        self.widgets.page = page.name
        if imgui.begin(page.name)[0]:
            page.draw(self.widgets)
        imgui.end()

    def _build(self, dock: int) -> None:
        build = imgui.internal
        viewport = imgui.get_main_viewport()
        build.dock_builder_remove_node(dock)
        build.dock_builder_add_node(dock, imgui.internal.DockNodeFlagsPrivate_.dock_space.value)
        build.dock_builder_set_node_size(dock, viewport.work_size)
        rest, places = dock, {}
        for place, way, share in (
            ("left", imgui.Dir.left, LEFT_SHARE),
            ("right", imgui.Dir.right, RIGHT_SHARE),
            ("bottom", imgui.Dir.down, BOTTOM_SHARE),
        ):
            _, at_way, rest = build.dock_builder_split_node_py(rest, way, share)
            places[place] = at_way
        for page in self.pages:
            build.dock_builder_dock_window(page.name, places[page.place])
        build.dock_builder_finish(dock)
        first = {page.place: page.name for page in reversed(self.pages)}
        self._front = [
            name for name in first.values() for _ in range(SETTLING_FRAMES)
        ] + self._front
