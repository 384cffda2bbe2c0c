"""A scene's lights and materials back into its file: only what changed, comments kept."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from typing import Any

import numpy as np

from elemental.scene import toml_edit
from elemental.scene.defaults import default_sun
from elemental.scene.definitions import SHARED
from elemental.scene.lights import Light
from elemental.scene.materials import Material

LIGHT_KEYS = ("color", "intensity", "position", "direction", "source_radius", "casts_shadow")
"""Keys of a light's table that hold the field of that name as it is."""


def put_lights(document: Any, before: Sequence[Light], after: Sequence[Light]) -> None:
    """Assign what changed, in ``lights`` for the file's own, which come first, else in
    ``light_changes``, which name a model's light. Raises CannotEditError for the default sun."""
    tables = document.get("lights", [])
    for number, (old, new) in enumerate(zip(before, after, strict=True)):
        changes = _light_changes(old, new)
        if not changes:
            continue
        is_own = number < len(tables)
        if not is_own and new.name == default_sun().name:
            raise toml_edit.CannotEditError("the default sun is in no file")
        table = tables[number] if is_own else _named(document, "light_changes", new.name)
        for key, value in changes.items():
            if key == "intensity" and "lumen" in table:
                del table["lumen"]
            if value is None:
                table.pop(key, None)
            else:
                toml_edit.assign(table, key, value)


def _light_changes(old: Light, new: Light) -> dict[str, Any]:
    """Keys of a light's table that differ, with their values; None: to be left out."""
    changes: dict[str, Any] = {}
    for key in LIGHT_KEYS:
        value = _plain(getattr(new, key))
        if value != _plain(getattr(old, key)):
            changes[key] = value
    if new.temperature != old.temperature:
        changes["temperature"] = new.temperature
    if new.range != old.range:
        changes["range"] = None if math.isinf(new.range) else float(new.range)
    for key in ("inner_angle", "outer_angle"):
        if getattr(new, key) != getattr(old, key):
            changes[f"{key}_deg"] = _short(math.degrees(getattr(new, key)))
    return changes


def put_materials(document: Any, before: Sequence[Material], after: Sequence[Material]) -> None:
    """Assign what changed of each material, in a table of its own name, the last of that name."""
    for old, new in zip(before, after, strict=True):
        parameters = _material_changes(old, new)
        is_other = new.definition != old.definition
        if not parameters and not is_other:
            continue
        table = _named(document, "materials", literal(new.name))
        if is_other:
            toml_edit.assign(table, "shader", new.definition.name)
        for key, value in parameters.items():
            toml_edit.assign_setting(table, "parameters", key, value)


def _material_changes(old: Material, new: Material) -> dict[str, Any]:
    changes: dict[str, Any] = {}
    for parameter in new.definition.parameters:
        if parameter.kind == "texture":
            continue
        name = parameter.name
        value = new.value(name)
        is_known = name in SHARED or old.definition.parameter(name) is not None
        if value != (old.value(name) if is_known else parameter.default):
            changes[name] = [_short(p) for p in value] if isinstance(value, tuple) else value
    return changes


def _named(document: Any, section: str, name: str) -> Any:
    """The last table of ``section`` for ``name``, made if there is none that comes last."""
    tables = document.get(section, [])
    if len(tables) and tables[-1].get("name") == name:
        return tables[-1]
    if section != "materials":
        for table in tables:
            if table.get("name") == name:
                return table
    toml_edit.append_table(document, section, {"name": name})
    return document[section][-1]


def literal(name: str) -> str:
    """A pattern that fits this name alone."""
    return re.sub(r"([*?[])", r"[\1]", name)


def _plain(value: Any) -> Any:
    """As TOML has it."""
    if isinstance(value, np.ndarray):
        return [_short(float(part)) for part in value]
    return _short(value) if isinstance(value, float) else value


def _short(number: float) -> float:
    """A 32-bit number as one would type it."""
    return float(f"{number:.7g}")
