"""A scene's lights and materials back into its file: only what changed, comments kept."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from elemental.scene import toml_edit
from elemental.scene.decals import Decal
from elemental.scene.defaults import default_sun
from elemental.scene.definitions import COMMON_PARAMETERS, MaterialDefinition, materials_folder
from elemental.scene.lights import Light
from elemental.scene.materials import Material, Texture
from elemental.scene.save_names import relative

LIGHT_KEYS = ("color", "intensity", "position", "direction", "source_radius", "casts_shadow")
"""Keys of a light's table that hold the field of that name as it is."""

DRAW_STATES = ("double_sided", "alpha_mode")
"""Keys of a material's table that hold the field of that name."""


def put_lights(
    document: Any, before: Sequence[Light], after: Sequence[Light], folder: Path
) -> None:
    """Assign what changed, in ``lights`` for the file's own, which come first, else in
    ``light_changes``, which name a model's light. Files are named as seen from ``folder``.
    Raises CannotEditError for the default sun."""
    tables = document.get("lights", [])
    for number, (old, new) in enumerate(zip(before, after, strict=True)):
        changes = _light_changes(old, new) | _mask_changes(old, new, folder)
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


def _mask_changes(old: Light, new: Light, folder: Path) -> dict[str, Any]:
    """The same of a light's mask, and of what says how it lies."""
    changes: dict[str, Any] = {}
    if new.mask is not old.mask:
        file = None if new.mask is None else new.mask.file
        changes["mask"] = None if file is None else relative(file, folder)
    if new.roll != old.roll:
        changes["roll_deg"] = _short(math.degrees(new.roll)) or None
    for key in ("mask_size", "mask_scroll"):
        value = getattr(new, key)
        if value != getattr(old, key):
            changes[key] = None if value == getattr(Light, key) else _plain(value)
    return changes


@dataclass(frozen=True)
class MaterialChanges:
    """Materials as they were read and as they are, and what their numbers stand for."""

    before: Sequence[Material]
    after: Sequence[Material]
    textures: Sequence[Texture] = ()
    decals: Sequence[Decal] = ()


def put_materials(document: Any, changes: MaterialChanges, folder: Path) -> None:
    """Assign what changed of each material, in a table of its own name, the last of that name;
    what decals project, in their tables. Files are named as seen from `folder`.
    """
    for number, (old, new) in enumerate(zip(changes.before, changes.after, strict=True)):
        parameters = _material_changes(old, new)
        images = _image_changes(old, new, changes.textures, folder)
        states: dict[str, Any] = {
            key: getattr(new, key) for key in DRAW_STATES if getattr(new, key) != getattr(old, key)
        }
        is_other = new.definition != old.definition
        if not (parameters or images or states or is_other):
            continue
        values = {**parameters, **images}
        gone = [key for key, value in values.items() if value is None]
        kept = {key: value for key, value in values.items() if value is not None}
        stuck = [k for k, decal in enumerate(changes.decals) if decal.material == number]
        if is_other:
            states["shader"] = _shader_name(new.definition, folder)
        if stuck:
            of_it = tables = [document["decals"][k] for k in stuck]
            states = {key: value for key, value in states.items() if key not in DRAW_STATES}
        else:
            name = literal(new.name)
            of_it = [t for t in document.get("materials", []) if t.get("name") == name]
            tables = [_named(document, "materials", name)] if kept or states else []
        for key in gone:
            _drop_parameter(of_it, key)
        for table in tables:
            for key, value in states.items():
                toml_edit.assign(table, key, value)
            for key, value in kept.items():
                toml_edit.assign_setting(table, "parameters", key, value)


def _drop_parameter(tables: Sequence[Any], key: str) -> None:
    """Leave a key out of all tables, so that what is below shows. Raises CannotEditError where
    none has it."""
    having = [table for table in tables if key in table.get("parameters", {})]
    if not having:
        raise toml_edit.CannotEditError("a model's own image can't be named from outside")
    for table in having:
        toml_edit.drop_setting(table, "parameters", key)


def _shader_name(definition: MaterialDefinition, folder: Path) -> str:
    own = definition.file.resolve().parent == materials_folder().resolve()
    return definition.name if own else relative(definition.file, folder)


def _image_changes(
    old: Material, new: Material, textures: Sequence[Texture], folder: Path
) -> dict[str, str | None]:
    """Images that differ: their files, the name of a plain one, or None for a model's own image."""
    changes: dict[str, str | None] = {}
    for parameter in new.definition.parameters:
        name = parameter.name
        if parameter.kind != "texture":
            continue
        slot, was = new.texture(name), old.texture(name)
        if slot is not None and (was is None or was.texture != slot.texture):
            file = textures[slot.texture].file
            changes[name] = None if file is None else relative(file, folder)
        elif slot is None and was is not None:
            changes[name] = str(parameter.default if name in COMMON_PARAMETERS else new.value(name))
    return changes


def _material_changes(old: Material, new: Material) -> dict[str, Any]:
    changes: dict[str, Any] = {}
    for parameter in new.definition.parameters:
        name = parameter.name
        if parameter.kind == "texture" and (
            name in COMMON_PARAMETERS or new.texture(name) is not None
        ):
            continue
        value = new.value(name)
        is_known = name in COMMON_PARAMETERS or old.definition.parameter(name) is not None
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
    if isinstance(value, np.ndarray | tuple):
        return [_short(float(part)) for part in value]
    return _short(value) if isinstance(value, float) else value


def _short(number: float) -> float:
    """A 32-bit number as one would type it."""
    return float(f"{number:.7g}")
