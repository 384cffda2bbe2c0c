"""File names in a scene that is saved in another folder: there they name the same files."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import tomlkit

from elemental.core.paths import content_root, is_file
from elemental.scene.named_files import FILE_KEYS

ALWAYS_FILES = frozenset({"file", "ies", "mask"})
"""Keys outside the settings that name a file whether it is there or not."""
NEVER_FILES = frozenset({"name", "model", "light"})
"""Keys whose texts are names of things."""
SETTINGS = "settings"
FILE_WORDS = frozenset(key.rpartition(".")[2] for key in FILE_KEYS)
"""Last words of the settings that name a file."""


def seen_from(values: Mapping[str, Any], source: Path, target: Path) -> dict[str, Any]:
    """Settings by flat keys whose file names count from `source`, as they read in `target`.

    An absolute name, one of content/textures/ and one of no file stay.
    """
    if source.resolve() == target.resolve():
        return dict(values)
    return {
        key: _moved(value, source, target) if key in FILE_KEYS else value
        for key, value in values.items()
    }


def move_files(document: tomlkit.TOMLDocument, source: Path, target: Path) -> None:
    """Rewrite the names in a scene file's tables from its folder `source` to `target`.

    A text that names a file there is such a name, whatever its key.
    """
    for key, section in document.items():
        _move_names(section, source, target, key == SETTINGS)


def relative(file: Path, folder: Path) -> str:
    """The name of a file as it is written in a scene in `folder`."""
    try:
        return Path(os.path.relpath(file.resolve(), folder.resolve())).as_posix()
    except ValueError:  # another drive
        return file.resolve().as_posix()


def name_in(folder: Path, file: Path) -> str:
    """A file's name as a scene in `folder` has it: short for one that is there or ships along."""
    for home in (folder.resolve(), content_root() / "textures"):
        if file.resolve().is_relative_to(home):
            return file.resolve().relative_to(home).as_posix()
    return str(file)


def _move_names(holder: Any, source: Path, target: Path, in_settings: bool) -> None:
    """Of a table or an array, and of all in it."""
    keys: list[Any] = []
    if isinstance(holder, Mapping):
        keys = list(holder)
    elif isinstance(holder, list):
        keys = list(range(len(holder)))
    for key in keys:
        value = holder[key]
        if isinstance(value, Mapping | list):
            _move_names(value, source, target, in_settings or key == SETTINGS)
        elif isinstance(value, str) and not isinstance(key, int):
            moved = _renamed(key, value, source, target, in_settings)
            if moved != value:
                holder[key] = moved


def _renamed(key: str, value: str, source: Path, target: Path, in_settings: bool) -> str:
    if in_settings:
        return _moved(value, source, target) if key.rpartition(".")[2] in FILE_WORDS else value
    if key in NEVER_FILES:
        return value
    if key in ALWAYS_FILES and not Path(value).is_absolute():
        return relative(source / value, target)
    return _moved(value, source, target) if Path(value).suffix else value


def _moved(name: str, source: Path, target: Path) -> str:
    is_there = bool(name) and not Path(name).is_absolute() and is_file(source / name)
    return relative(source / name, target) if is_there else name
