"""The panel as a whole: a menu bar, and pages docked around the picture."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from imgui_bundle import imgui

from elemental.ui.docking import MARK, Docking, Place, Room
from elemental.ui.widgets import Widgets
from elemental.ui.words import Rect

SETTLING_FRAMES = 3
"""Until docked windows have taken their places."""


@dataclass(frozen=True)
class Page:
    """A dockable window; ``draw`` makes its widgets."""

    name: str
    place: Place
    draw: Callable[[Widgets], None]


class Workspace:
    """Pages and where they are. ``layout``: ImGui's text of an earlier run, empty for ours."""

    def __init__(self, widgets: Widgets, pages: Sequence[Page], layout: str = "") -> None:
        self.widgets = widgets
        self.pages = tuple(pages)
        self.hidden: set[str] = set()
        self._front: list[str] = []
        """Pages to bring to the front, one a frame; several times each: docks settle slowly."""
        self._shown: dict[str, bool] = {}
        """Pages that are drawn, and whether they are in front at their place."""
        self._docking: Docking | None = None
        self._wants_layout = True
        if layout:
            imgui.load_ini_settings_from_memory(layout)
            self._wants_layout = not layout.startswith(f"; {MARK}")
            self._take_over(layout.partition("\n")[0].removeprefix(f"; {MARK}"))

    def layout(self) -> str:
        """The places of everything, as ``Workspace`` takes it again."""
        told = self._docking.told() if self._docking is not None else {}
        told["front"] = [name for name, shows in self._shown.items() if shows]
        return f"; {MARK} {json.dumps(told)}\n{imgui.save_ini_settings_to_memory()}"

    def _take_over(self, head: str) -> None:
        """The first line of a kept layout: docks that are ours, and pages in front of others."""
        try:
            held = json.loads(head)
        except ValueError:
            return
        names = [page.name for page in self.pages]
        self._docking = Docking.read(held, names)
        front = held.get("front") if isinstance(held, dict) else None
        for name in front if isinstance(front, list) else ():
            if name in names:
                self.bring_to_front(name)

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
        dock = imgui.get_id(MARK)
        self._lay_out(dock)
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
        shows = bool(imgui.begin(page.name)[0])
        self._shown[page.name] = shows
        if shows:
            page.draw(self.widgets)
        imgui.end()

    def _lay_out(self, dock: int) -> None:
        """Dock the pages at first, and wherever another size asks for another layout."""
        size = imgui.get_main_viewport().size  # the room without the menu bar is known a frame late
        room = Room(max(size.x, 1.0), max(size.y, 1.0), imgui.get_font_size())
        docking = self._docking
        keeps_front = False
        if docking is not None and not self._wants_layout and docking.room != room:
            self._wants_layout = keeps_front = docking.fit(room)
        if not self._wants_layout:
            return
        self._wants_layout = False
        places = {page.name: page.place for page in self.pages}
        shown = [name for name, shows in self._shown.items() if shows and keeps_front]
        in_front = sorted(shown, key=lambda name: places[name] == "right")
        self._docking = made = Docking.build(dock, room, places)
        first = {made.pages[page.name]: page.name for page in reversed(self.pages)}
        first |= {made.pages[name]: name for name in in_front}
        fronts = [name for name in first.values() if name not in self.hidden]
        self._front = [name for name in fronts for _ in range(SETTLING_FRAMES)] + self._front
