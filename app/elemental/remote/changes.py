"""What a remote client may change of a volume, checked, and what it is told about volumes."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any

from elemental.core.errors import InputError
from elemental.scene.volumes import Volume
from elemental.settings import SETTINGS, Setting, Settings, check_override

LARGEST = 1e12
"""Of a priority and a radius; as in scene files."""

FIELDS = {
    "weight": ("blend_weight", Setting("weight", "float", 1.0, "blend weight", lo=0, hi=1)),
    "priority": ("priority", Setting("priority", "float", 0.0, "priority", lo=0, hi=LARGEST)),
    "blend_radius": (
        "blend_radius",
        Setting("blend_radius", "float", 1.0, "blend radius", "m", lo=0, hi=LARGEST),
    ),
    "enabled": ("enabled", Setting("enabled", "bool", True, "whether it acts")),
    "unbound": ("unbound", Setting("unbound", "bool", False, "whether it acts everywhere")),
}
"""Property -> (field of Volume, its kind and range); every other property is an override."""


class RefusedError(Exception):
    """A request that is not carried out. ``status``: as in HTTP."""

    def __init__(self, status: int, reason: str) -> None:
        super().__init__(reason)
        self.status = status


@dataclass(frozen=True)
class Change:
    """One checked assignment; None as the value of an override takes the override away."""

    volume: str
    property: str
    value: Any


def checked(
    volumes: Sequence[Volume], settings: Settings, name: str, property: str, value: Any
) -> Change:
    """The change that a request asks for. Raises RefusedError.

    A text names a file: only those that the scene's settings or volumes name already may be
    chosen, so that no client makes the program open another.
    """
    if all(volume.name != name for volume in volumes):
        raise RefusedError(404, f"no volume is named {name!r}")
    if property in FIELDS:
        return Change(name, property, _field_value(property, value))
    if property not in SETTINGS or not SETTINGS[property].volume:
        raise RefusedError(404, f"volumes have no property {property!r}")
    if value is None:
        return Change(name, property, None)
    try:
        value = check_override("", property, value)
    except InputError as error:
        raise RefusedError(400, f"{property}: {error.reason}") from None
    if SETTINGS[property].kind == "text" and value not in _known_texts(volumes, settings, property):
        raise RefusedError(400, f"{property}: only a text that the scene names may be set")
    return Change(name, property, value)


def _field_value(property: str, value: Any) -> Any:
    try:
        return FIELDS[property][1].check(value)
    except ValueError as error:
        raise RefusedError(400, f"{property}: {error}") from None


def _known_texts(volumes: Sequence[Volume], settings: Settings, key: str) -> set[str]:
    named = {volume.overrides[key] for volume in volumes if key in volume.overrides}
    return named | {settings[key], SETTINGS[key].default}


def applied(volumes: Iterable[Volume], changes: Iterable[Change]) -> list[Volume]:
    """The volumes after the changes; those of volumes that are gone are left out."""
    by_name = {volume.name: volume for volume in volumes}
    for change in changes:
        volume = by_name.get(change.volume)
        if volume is not None:
            by_name[change.volume] = _changed(volume, change)
    return list(by_name.values())


def _changed(volume: Volume, change: Change) -> Volume:
    if change.property in FIELDS:
        return replace(volume, **{FIELDS[change.property][0]: change.value})
    overrides = dict(volume.overrides)
    if change.value is None:
        overrides.pop(change.property, None)
    else:
        overrides[change.property] = change.value
    return replace(volume, overrides=overrides)


def description(volume: Volume) -> dict[str, Any]:
    """What a client is told of a volume, ready for JSON."""
    fields = {name: getattr(volume, field) for name, (field, _) in FIELDS.items()}
    measure = {"size": volume.size} if volume.shape == "box" else {"radius": volume.radius}
    return {
        "name": volume.name,
        "shape": volume.shape,
        "center": volume.center,
        "rotation_deg": volume.rotation_deg,
        **measure,
        **fields,
        "settings": dict(volume.overrides),
    }
