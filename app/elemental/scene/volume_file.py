"""Volumes out of a scene file's checked tables."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from elemental.core.errors import CombinedInputError, InputError
from elemental.scene.model import unique_name
from elemental.scene.scene_file import flat_settings
from elemental.scene.tables.volumes import VolumeTable
from elemental.scene.volumes import RADIUS_M, SIZE_M, Vector, Volume
from elemental.settings import check_override


def volumes_of(tables: Sequence[VolumeTable], path: Path) -> list[Volume]:
    """The volumes of a file's checked tables, their settings checked too.

    A volume without a name gets one of its number. Raises CombinedInputError with a line for each
    override that is unknown, out of range or not for volumes, and for a name that is taken.
    """
    wrong: list[tuple[str, str]] = []
    taken = {table.name for table in tables if table.name is not None}
    volumes: list[Volume] = []
    for i, table in enumerate(tables):
        overrides: dict[str, Any] = {}
        for key, value in flat_settings(table.settings).items():
            try:
                overrides[key] = check_override("", key, value)
            except InputError as error:
                wrong.append((f"volumes[{i}].settings.{key}", error.reason))
        name = table.name
        if name is None:
            name = unique_name(f"volume{i}", taken)
            taken.add(name)
        elif any(name == volume.name for volume in volumes):
            wrong.append((f"volumes[{i}].name", f"another volume is named {name!r}"))
        volumes.append(_volume(table, name, overrides))
    if wrong:
        raise CombinedInputError(path, wrong)
    return volumes


def _volume(table: VolumeTable, name: str, overrides: dict[str, Any]) -> Volume:
    return Volume(
        name=name,
        shape=table.shape,
        center=_vector(table.center),
        rotation_deg=_vector(table.rotation_deg),
        size=_vector(table.size) if table.size else SIZE_M,
        radius=table.radius or RADIUS_M,
        priority=table.priority,
        blend_radius=table.blend_radius,
        blend_weight=table.blend_weight,
        enabled=table.enabled,
        unbound=table.unbound,
        overrides=overrides,
    )


def _vector(values: Sequence[float]) -> Vector:
    x, y, z = (float(value) for value in values)
    return x, y, z
