"""A scene file's changes to the lights that its models bring along."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from elemental.core.errors import InputError, named_by
from elemental.scene.light_masks import read_light_mask
from elemental.scene.lights import Light, LightMask, checked
from elemental.scene.model import Scene
from elemental.scene.tables.lights import LightChangeTable

VECTORS = frozenset({"position", "direction", "color"})


def change_lights(scene: Scene, tables: Sequence[LightChangeTable], own: int) -> None:
    """Apply each table to the models' lights of its name, which come after the file's ``own``.

    Raises InputError for a name that none has, and for a light that can't be.
    """
    for number, table in enumerate(tables):
        fitting = [n for n in range(own, len(scene.lights)) if scene.lights[n].name == table.name]
        if not fitting:
            known = ", ".join(repr(light.name) for light in scene.lights[own:]) or "none"
            reason = f"no model's light is named {table.name!r}; known: {known}"
            raise InputError(scene.path, f"light_changes[{number}].name", reason)
        mask = None
        if table.mask is not None:
            with named_by(scene.path, f"light_changes[{number}].mask", table.mask):
                mask = read_light_mask(scene.path.parent / table.mask)
        for index in fitting:
            try:
                scene.lights[index] = checked(_changed(scene.lights[index], table, mask))
            except InputError as error:
                field = f"light_changes[{number}].{error.field}"
                raise InputError(scene.path, field, error.reason) from error


def _changed(light: Light, table: LightChangeTable, mask: LightMask | None) -> Light:
    fields: dict[str, Any] = {} if mask is None else {"mask": mask}
    for key in table.model_fields_set - {"name", "mask"}:
        value = getattr(table, key)
        if key in VECTORS:
            value = np.array(value, np.float32)
        if key == "mask_scroll":
            value = tuple(value)
        if key == "direction":
            value = value / max(float(np.linalg.norm(value)), 1e-30)
        if key.endswith("_deg"):
            key, value = key.removesuffix("_deg"), math.radians(value)  # noqa: PLW2901
        fields[key] = value
    return replace(light, **fields)
