"""Every setting of the table, by group, with its unit, range and default; found by a search."""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import partial

from elemental.settings import SETTINGS, Setting
from elemental.ui.document import Document
from elemental.ui.rows import property_row, spelled
from elemental.ui.widgets import Widgets

TITLES = {
    "gi": "Indirect light",
    "fxaa": "Antialiasing",
    "dof": "Depth of field",
    "ao": "Ambient occlusion",
    "lut": "Colour grading",
    "voxels": "Voxel views",
    "gbuffer": "G-buffer",
    "ambient_cubemap": "Ambient light",
    "shading": "",
}
"""Headings of groups whose name is not a word."""
FOLDED = frozenset({"voxels", "scene", "lights", "shading"})
"""Groups that an artist seldom opens."""


def groups(table: Mapping[str, Setting]) -> dict[str, list[Setting]]:
    """The settings by the first part of their key, in the table's order; alone ones together."""
    found: dict[str, list[Setting]] = {}
    for setting in table.values():
        found.setdefault(setting.key.partition(".")[0], []).append(setting)
    return found


GROUPS = groups(SETTINGS)


def settings_page(w: Widgets, document: Document, text: str) -> str:
    """Draw the page, filtered by what is searched for; returns that text."""
    text = w.search("search", text)
    words = text.lower().split()
    for group, members in GROUPS.items():
        shown = [setting for setting in members if matches(setting, words)]
        if not shown:
            continue
        is_open = group not in FOLDED or bool(words)
        if len(members) > 1 and not w.section(title_of(group), is_open):
            continue
        for setting in shown:
            _row(w, document, setting)
    return text


def title_of(group: str) -> str:
    """A group's heading."""
    return TITLES.get(group, group.replace("_", " ").capitalize())


def label_of(setting: Setting) -> str:
    """A setting's name within its group, or with it where it is alone there; the unit stands
    behind its value."""
    group, dot, name = setting.key.rpartition(".")
    words = spelled(re.sub(r"(?<=[a-z])(?=\d)", "_", name.removesuffix("_mb")))
    if dot and len(GROUPS.get(group, ())) == 1 and title_of(group):
        return f"{title_of(group)} {words[0].lower()}{words[1:]}"
    return words


def matches(setting: Setting, words: list[str]) -> bool:
    """Whether a setting is among what is searched for."""
    if not words:
        return True
    text = f"{setting.key} {title_of(setting.key.partition('.')[0])} {setting.help}".lower()
    text += setting.key.replace("_", " ")
    return all(word in text for word in words)


LABELS = {key: label_of(setting) for key, setting in SETTINGS.items()}


def _row(w: Widgets, document: Document, setting: Setting) -> None:
    value = document.state.settings[setting.key]
    edit = property_row(w, setting.key, LABELS[setting.key], setting, value, setting.default)
    if edit is not None:
        document.attempt(partial(document.set, setting.key, edit.value, edit.gesture))
