"""Where pages are docked at first, and how that follows the window's size and the text's."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

from imgui_bundle import imgui

Place = Literal["left", "right", "bottom"]
MARK = "workspace"
"""Name of the dock space, and the first word of a kept layout."""
COMPACT_BELOW_EM = (56.0, 27.0)
"""A window narrower or lower than this, in heights of the text, has all pages in one column."""
LEFT_EM, RIGHT_EM, BOTTOM_EM = 13.0, 24.0, 11.0
"""Least sizes of the docks, in heights of the text: their labels fit."""
LEFT_SHARE, RIGHT_SHARE, BOTTOM_SHARE = 0.15, 0.27, 0.33
"""Sizes of the docks in large windows, as parts of it."""
COMPACT_SHARE = 0.5
"""Of a compact window's width, for the one column."""
LEAST_PX = 1.0
MOST_SHARE = 0.6
"""Of a window, for docks side by side."""


@dataclass(frozen=True)
class Room:
    """What there is to lay out in: px, and the height of the text."""

    width: float
    height: float
    em: float

    @property
    def is_compact(self) -> bool:
        """Whether three docks around a picture do not fit."""
        least_width, least_height = COMPACT_BELOW_EM
        return self.width < least_width * self.em or self.height < least_height * self.em

    def sizes(self) -> dict[Place, float]:
        """Width or height of each dock at first, px."""
        if self.is_compact:
            return {"right": max(COMPACT_SHARE * self.width, 1.0)}
        left = max(LEFT_SHARE * self.width, LEFT_EM * self.em)
        right = max(RIGHT_SHARE * self.width, RIGHT_EM * self.em)
        shrink = min(1.0, MOST_SHARE * self.width / (left + right))
        bottom = max(BOTTOM_SHARE * self.height, BOTTOM_EM * self.em)
        return {"left": shrink * left, "right": shrink * right, "bottom": bottom}


@dataclass
class Docking:
    """The docks of our own layout. Once a page has been docked elsewhere, it is the user's."""

    room: Room
    nodes: dict[Place, int] = field(default_factory=dict)
    pages: dict[str, int] = field(default_factory=dict)
    """The node that each page was put into."""

    @classmethod
    def build(cls, dock: int, room: Room, places: Mapping[str, Place]) -> Docking:
        """Dock all pages, by name, where they are at first."""
        build = imgui.internal
        # Where tabs do not fit beside each other, a button lists them.
        imgui.get_style().window_menu_button_position = (
            imgui.Dir.left if room.is_compact else imgui.Dir.none
        )
        build.dock_builder_remove_node(dock)
        build.dock_builder_add_node(dock, build.DockNodeFlagsPrivate_.dock_space.value)
        build.dock_builder_set_node_size(dock, imgui.ImVec2(room.width, room.height))
        ways = {"left": imgui.Dir.left, "right": imgui.Dir.right, "bottom": imgui.Dir.down}
        made = cls(room)
        rest, width, height = dock, room.width, room.height
        for place, size in room.sizes().items():
            along = height if place == "bottom" else width
            _, made.nodes[place], rest = build.dock_builder_split_node_py(
                rest, ways[place], min(size / max(along, 1.0), 0.9)
            )
            width -= size if place != "bottom" else 0.0
        for name, place in places.items():
            made.pages[name] = made.nodes.get(place, made.nodes["right"])
            build.dock_builder_dock_window(name, made.pages[name])
        build.dock_builder_finish(dock)
        return made

    @property
    def is_ours(self) -> bool:
        """Whether every page that was drawn is still where it was put."""
        windows = {name: imgui.internal.find_window_by_name(name) for name in self.pages}
        return bool(self.nodes) and all(
            window is None or window.dock_id in (0, self.pages[name])
            for name, window in windows.items()
        )

    def fit(self, room: Room) -> bool:
        """Follow another window or text size. Returns whether to build the layout anew.

        Docks keep the shares that the user gave them, but for their least sizes.
        """
        before, self.room = self.room, room
        if not self.is_ours:
            return False
        if room.is_compact != before.is_compact:
            return True
        first, now = before.sizes(), room.sizes()
        for place, number in self.nodes.items():
            node = imgui.internal.dock_builder_get_node(number)
            if node is None:
                return True
            laid_out = node.size if node.size.x > 0.0 and node.size.y > 0.0 else node.size_ref
            width, height = max(laid_out.x, LEAST_PX), max(laid_out.y, LEAST_PX)
            grown = now[place] / max(first[place], 1.0)
            size = (width, grown * height) if place == "bottom" else (grown * width, height)
            extent = imgui.ImVec2(*(max(along, LEAST_PX) for along in size))
            imgui.internal.dock_builder_set_node_size(number, extent)
        return False

    def told(self) -> dict[str, Any]:
        """Plain values that ``read`` takes again."""
        room = [self.room.width, self.room.height, self.room.em]
        return {"room": room, "nodes": self.nodes, "pages": self.pages}

    @classmethod
    def read(cls, held: Any, names: Sequence[str]) -> Docking | None:
        """What ``told`` told; None for anything else, or where a page is missing."""
        try:
            room = Room(*(float(extent) for extent in held["room"]))
            nodes: dict[Place, int] = {place: int(held["nodes"][place]) for place in held["nodes"]}
            pages = {name: int(held["pages"][name]) for name in names}
        except (ValueError, TypeError, KeyError, AttributeError, OverflowError):
            return None
        fits = min(room.width, room.height, room.em) > 0.0 and nodes.keys() == room.sizes().keys()
        return cls(room, nodes, pages) if fits else None
