"""Volumes back into their scene file, with its comments and layout kept."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from elemental.core.errors import InputError
from elemental.scene import toml_edit
from elemental.scene.scene_file import parse_scene_file
from elemental.scene.volume_file import volumes_of
from elemental.scene.volumes import RADIUS_M, SIZE_M, Volume

PLAIN_KEYS = (
    "shape", "center", "rotation_deg", "size", "radius", "priority", "blend_radius",
    "blend_weight", "enabled", "unbound",
)  # fmt: skip
"""Keys of a table that hold the volume's field of that name."""


def save_volumes(path: Path, volumes: Sequence[Volume]) -> None:
    """Put the volumes in the scene file's place of its own; all else, comments too, stays.

    The file is replaced whole or not at all. Raises InputError where it can't be read or written,
    and leaves it as it is.
    """
    toml_edit.rewrite(path, lambda text: with_volumes(text, volumes, path))


def with_volumes(text: str, volumes: Sequence[Volume], path: Path) -> str:
    """A scene file's text with these volumes in it. Raises InputError."""
    before = volumes_of(parse_scene_file(text, path).volumes, path)
    if same_volumes(before, volumes):
        return text
    # The first keeps more comments, and not every layout bears it.
    edits = (
        partial(_merge, before=before, volumes=volumes),
        partial(
            toml_edit.replace_tables,
            name="volumes",
            contents=[_table_of(volume) for volume in volumes],
        ),
    )
    made = toml_edit.edited_as(text, edits, partial(_reads_as, volumes=volumes, path=path))
    if made is None:
        raise InputError(path, "volumes", "can't be changed in this file's layout")
    return made


def same_volumes(one: Sequence[Volume], other: Sequence[Volume]) -> bool:
    """Equal in every field that their shape has, in the same order."""
    return [_essential(volume) for volume in one] == [_essential(volume) for volume in other]


def _essential(volume: Volume) -> Volume:
    if volume.shape == "box":
        return replace(volume, radius=RADIUS_M)
    return replace(volume, size=SIZE_M)


def _reads_as(text: str, volumes: Sequence[Volume], path: Path) -> bool:
    try:
        return same_volumes(volumes_of(parse_scene_file(text, path).volumes, path), volumes)
    except InputError:
        return False


def _merge(doc: Any, before: Sequence[Volume], volumes: Sequence[Volume]) -> None:
    """Change what differs in the tables that are there, drop and append others."""
    tables = doc.get("volumes", [])
    place = {volume.name: i for i, volume in enumerate(before)}
    known = [volume for volume in volumes if volume.name in place]
    kept = [place[volume.name] for volume in known]
    if kept != sorted(kept) or known != list(volumes[: len(known)]):
        raise toml_edit.CannotEditError("another order")
    for volume in known:
        _update(tables[place[volume.name]], before[place[volume.name]], volume)
    for i in reversed(range(len(before))):
        if i not in kept:
            del tables[i]
    for volume in volumes[len(known) :]:
        toml_edit.append_table(doc, "volumes", _table_of(volume))
    if not volumes and "volumes" in doc:
        del doc["volumes"]


def _update(table: Any, before: Volume, volume: Volume) -> None:
    if "name" not in table:  # its number may change
        table["name"] = volume.name
    for key in PLAIN_KEYS:
        value = getattr(volume, key)
        if value != getattr(before, key) and key in _measures(volume.shape):
            toml_edit.assign(table, key, value)
    for key in {"size", "radius"} - _measures(volume.shape):
        table.pop(key, None)
    for key in before.overrides.keys() - volume.overrides.keys():
        toml_edit.drop_setting(table, "settings", key)
    for key, value in volume.overrides.items():
        if key not in before.overrides or before.overrides[key] != value:
            toml_edit.assign_setting(table, "settings", key, value)


def _measures(shape: str) -> set[str]:
    """The keys that a volume of a shape may have."""
    return set(PLAIN_KEYS) - {"radius" if shape == "box" else "size"}


def _table_of(volume: Volume) -> dict[str, Any]:
    """What a new table says: the name, the place, and what is not by default."""
    default = Volume("")
    table: dict[str, Any] = {"name": volume.name, "shape": volume.shape}
    for key in PLAIN_KEYS:
        value = getattr(volume, key)
        is_place = key in ("center", "size", "radius") and not volume.unbound
        if key in _measures(volume.shape) and (is_place or value != getattr(default, key)):
            table[key] = value
    if volume.overrides:
        table["settings"] = dict(volume.overrides)
    return table
