"""A small dialog for a file's name: folders and fitting files to click, and a line to type in."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

from imgui_bundle import imgui

from elemental.ui import icons, theme
from elemental.ui.widgets import Widgets

ROWS = 12
LINES_AROUND = 7.5
"""Of the dialog, besides its list."""
WIDTH_EM = 34.0
WINDOW_SHARE = 0.95
"""Of the window, for the dialog at most."""
MOST_FILES = 1000
"""Shown of a folder; more are found by typing."""


class FileDialog:
    """Asks for a path and calls ``done`` with it. ``saves``: the file need not exist yet."""

    def __init__(
        self,
        title: str,
        start: Path,
        suffixes: tuple[str, ...],
        saves: bool,
        done: Callable[[Path], None],
    ) -> None:
        self.title, self.suffixes, self.saves, self.done = title, suffixes, saves, done
        self.folder = start if start.is_dir() else start.parent
        self.name = "" if start.is_dir() else start.name
        self._listed: tuple[Path, list[str], list[str]] | None = None
        self._overwrites = False

    def draw(self, w: Widgets) -> bool:
        """A frame of the dialog. Returns whether it is over."""
        w.page = "dialog"
        if not imgui.is_popup_open(self.title):
            imgui.open_popup(self.title)
        center = imgui.get_main_viewport().get_center()
        imgui.set_next_window_pos(center, imgui.Cond_.appearing.value, imgui.ImVec2(0.5, 0.5))
        room = imgui.get_main_viewport().size
        width = min(WIDTH_EM * imgui.get_font_size(), WINDOW_SHARE * room.x)
        imgui.set_next_window_size(imgui.ImVec2(width, 0.0), imgui.Cond_.appearing.value)
        flags = imgui.WindowFlags_.no_saved_settings.value | imgui.WindowFlags_.no_docking.value
        shows, stays = imgui.begin_popup_modal(self.title, True, flags)
        if not shows:
            return True
        chosen = self._folder_list(w)
        imgui.set_next_item_width(-1.0)
        entered, name = imgui.input_text(
            "##name", self.name, imgui.InputTextFlags_.enter_returns_true.value
        )
        w.note("name")
        if name != self.name:
            self.name, self._overwrites = name, False
        path = self.path()
        exists = path.is_file()
        verb = "Save" if self.saves else "Open"
        ready = bool(self.name) and (self.saves or exists)
        pressed = w.button(verb, enabled=ready) or ((entered or chosen) and ready)
        imgui.same_line()
        over = w.button("Cancel") or not stays
        if self._overwrites and exists:
            told = "exists: press again to replace it"
            w.flow(imgui.calc_text_size(told).x)
            imgui.align_text_to_frame_padding()
            w.paragraph(told, theme.ACCENT)
        if pressed and self.saves and exists and not self._overwrites:
            self._overwrites = True
        elif pressed:
            self.done(path)
            over = True
        if over:
            imgui.close_current_popup()
        imgui.end_popup()
        return over

    def path(self) -> Path:
        """What the line names now; without a suffix it gets the first fitting one."""
        path = self.folder / Path(self.name).expanduser()
        return path if path.suffix or not self.name else path.with_suffix(self.suffixes[0])

    def _folder_list(self, w: Widgets) -> bool:
        """Folders and files; returns whether a file was double-clicked."""
        chosen = False
        if w.button(icons.UP, "up", help="the folder above"):
            self.folder = self.folder.parent
        imgui.same_line()
        imgui.align_text_to_frame_padding()
        w.paragraph(str(self.folder), theme.MUTED)
        folders, files = self._contents()
        line = imgui.get_text_line_height_with_spacing()
        room = WINDOW_SHARE * imgui.get_main_viewport().size.y - LINES_AROUND * line
        height = max(min(ROWS * line, room), 2.0 * line)
        if imgui.begin_child("files", imgui.ImVec2(0.0, height), imgui.ChildFlags_.borders.value):
            for name in folders:
                if imgui.selectable(f"{icons.FOLDER}  {name}", False)[0]:
                    self.folder = self.folder / name
                w.note(name)
            for name in files:
                double = imgui.SelectableFlags_.allow_double_click.value
                if imgui.selectable(f"{icons.FILE}  {name}", name == self.name, double)[0]:
                    chosen = name == self.name and imgui.is_mouse_double_clicked(0)
                    self.name, self._overwrites = name, False
                w.note(name)
        imgui.end_child()
        return chosen

    def _contents(self) -> tuple[list[str], list[str]]:
        """(folders, fitting files) of the present folder; empty where it can't be read."""
        if self._listed is None or self._listed[0] != self.folder:
            folders, files = [], []
            try:
                with os.scandir(self.folder) as entries:
                    for entry in entries:
                        if entry.name.startswith("."):
                            continue
                        if entry.is_dir():
                            folders.append(entry.name)
                        elif entry.name.lower().endswith(self.suffixes):
                            files.append(entry.name)
            except OSError:
                pass
            self._listed = (self.folder, sorted(folders)[:MOST_FILES], sorted(files)[:MOST_FILES])
        return self._listed[1], self._listed[2]
