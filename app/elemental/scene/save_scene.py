"""Writing a scene file back: what changed is replaced in place, comments and order are kept.

The text is parsed again before it is written, so a file on disk always says what was meant, and a
kill in the middle leaves the old file or the new one, whole.
"""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Any

import tomlkit
from tomlkit.exceptions import TOMLKitError

from elemental.core.errors import InputError
from elemental.core.files import atomic_file, read_text
from elemental.scene import toml_edit
from elemental.scene.gltf import GLTF_SUFFIXES
from elemental.scene.lights import Light
from elemental.scene.load import SCENE_FILE_SUFFIX
from elemental.scene.model import Region
from elemental.scene.regions import with_regions
from elemental.scene.save_names import move_files, relative, seen_from
from elemental.scene.save_parts import MaterialChanges, put_lights, put_materials
from elemental.scene.scene_file import flat_settings, parse_scene_file
from elemental.scene.volume_save import with_volumes
from elemental.scene.volumes import Volume

SETTINGS = "settings"

_Assign = Callable[[Any, str, str, Any], None]


@dataclass(frozen=True)
class Changes:
    """What of a scene is not as in its file; lights as (before, after)."""

    settings: Mapping[str, Any] = field(default_factory=dict)
    """Flat keys; others stay as they are."""
    volumes: Sequence[Volume] | None = None
    lights: tuple[Sequence[Light], Sequence[Light]] | None = None
    materials: MaterialChanges | None = None
    regions: Sequence[Region] | None = None


def save_scene(opened: Path, target: Path, changes: Changes, folder: Path | None = None) -> None:
    """Write the scene of ``opened`` to the scene file ``target`` with ``changes``.

    ``opened`` is a scene file, which is copied but for the changes, or a glTF file, which the new
    file names as its model. ``folder``: what file names in ``changes`` count from, by default that
    of ``opened``; in the new file they name the same files. Raises InputError for a target that is
    no .toml file or can't be written, and for changes that a scene file can't hold.
    """
    if target.suffix.lower() != SCENE_FILE_SUFFIX:
        raise InputError(target, "", f"a scene is saved as {SCENE_FILE_SUFFIX}")
    text = _copied(opened, target)
    moved = partial(seen_from, source=folder or opened.parent, target=target.parent)
    if changes.settings:
        text = _with_settings(text, moved(changes.settings), target)
    if changes.lights is not None:
        before, after = changes.lights
        put = partial(put_lights, before=before, after=after, folder=target.parent)
        text = _edited(text, put, target, "lights")
    if changes.materials is not None:
        put = partial(put_materials, changes=changes.materials, folder=target.parent)
        text = _edited(text, put, target, "materials")
    if changes.volumes is not None:
        volumes = [replace(v, overrides=moved(v.overrides)) for v in changes.volumes]
        text = with_volumes(text, volumes, target)
    if changes.regions is not None:
        text = with_regions(text, changes.regions, target)
    parse_scene_file(text, target)
    with atomic_file(target.resolve()) as temporary:
        temporary.write_text(text, encoding="utf-8", newline="")


def _edited(text: str, edit: Callable[[Any], None], target: Path, section: str) -> str:
    edited = toml_edit.edited(text, edit)
    if edited is None:
        reason = "can't be changed in this file's layout, or are in no file"
        raise InputError(target, section, reason)
    return edited


def _copied(opened: Path, target: Path) -> str:
    """The text to begin with; what it names is named as seen from ``target``."""
    if opened.suffix.lower() in GLTF_SUFFIXES:
        document = tomlkit.document()
        toml_edit.append_table(document, "models", {"file": relative(opened, target.parent)})
        return tomlkit.dumps(document)
    try:
        text = read_text(opened)
        parse_scene_file(text, opened)
        if opened.resolve().parent == target.resolve().parent:
            return text
        document = tomlkit.parse(text)
    except (ValueError, TOMLKitError) as error:
        raise InputError(opened, "TOML", f"is broken ({error})") from error
    move_files(document, opened.parent, target.parent)
    return tomlkit.dumps(document)


def _with_settings(text: str, settings: Mapping[str, Any], target: Path) -> str:
    """The text with settings assigned, and read back to be sure. Raises InputError."""
    for assign in (toml_edit.assign_setting, _assign_quoted):  # not every layout bears the first

        def assign_all(document: Any, assign: _Assign = assign) -> None:
            for key, value in settings.items():
                assign(document, SETTINGS, key, value)

        edited = toml_edit.edited(text, assign_all)
        if edited is not None and _holds(edited, settings):
            return edited
    raise InputError(target, SETTINGS, "can't be changed in this file's layout")


def _assign_quoted(document: Any, section: str, key: str, value: Any) -> None:
    """A setting where the file has it, else under its whole name in quotes."""
    holder, name, rest = document[section], key, key.split(".")
    for count, part in enumerate(rest):
        tail = ".".join(rest[count:])
        if tail in holder:
            name = tail
            break
        if part not in holder or not isinstance(holder[part], Mapping):
            holder = document[section]
            break
        holder = holder[part]
    holder[name] = toml_edit.plain(value)


def _holds(text: str, settings: Mapping[str, Any]) -> bool:
    try:
        found = flat_settings(tomllib.loads(text).get(SETTINGS, {}))
    except ValueError:
        return False
    return all(found.get(key) == toml_edit.plain(value) for key, value in settings.items())
