"""An assignment of all settings, checked as it is made."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Iterator, Mapping
from types import MappingProxyType
from typing import Any

from elemental.core.errors import InputError
from elemental.settings.lens_table import LENS_TABLE
from elemental.settings.post_table import POST_TABLE
from elemental.settings.setting import Setting
from elemental.settings.surface_table import SURFACE_TABLE
from elemental.settings.table import TABLE

SETTINGS: Mapping[str, Setting] = MappingProxyType(
    {setting.key: setting for setting in (*TABLE, *SURFACE_TABLE, *LENS_TABLE, *POST_TABLE)}
)

LIGHT_KEYS = tuple(setting.key for setting in (*TABLE, *SURFACE_TABLE))
"""All but the post-processing effects'."""

GROUP_TOLD = 3
"""How many settings of a group a refusal lists."""

Mix = tuple[tuple[Any, float], ...]
"""(value, share) of what can't be mixed into one value; the last has the highest priority."""


class Settings(Mapping[str, Any]):
    """An immutable, complete and checked assignment of every setting: ``s["gi.resolution"]``."""

    def __init__(self, values: Mapping[str, Any] | None = None) -> None:
        """The defaults, with ``values`` over them; raises InputError as ``replace`` does."""
        assigned = {key: setting.default for key, setting in SETTINGS.items()}
        for key, value in (values or {}).items():
            assigned[key] = check_setting("settings", key, value)
        self._values = assigned
        self._mixes: Mapping[str, Mix] = {}

    def __getitem__(self, key: str) -> Any:
        return self._values[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __hash__(self) -> int:
        return hash(tuple(self._values.items()))

    def __eq__(self, other: object) -> bool:
        return (
            isinstance(other, Settings)
            and self._values == other._values
            and self._mixes == other._mixes
        )

    def __repr__(self) -> str:
        return f"Settings({self.changed()!r})"

    def changed(self) -> dict[str, Any]:
        """The assignments that differ from the defaults."""
        return {k: v for k, v in self._values.items() if v != SETTINGS[k].default}

    def replace(self, values: Mapping[str, Any], file: str = "settings") -> Settings:
        """These settings with some reassigned, by flat keys or by nested tables.

        ``file`` is where the values come from. Raises InputError(file, key, reason) for a
        key that does not exist, a value of the wrong type and one outside its range.
        """
        flat = {key: check_setting(file, key, value) for key, value in _flatten(values)}
        return Settings({**self._values, **flat})

    def blended(self, values: Mapping[str, Any], mixes: Mapping[str, Mix]) -> Settings:
        """These settings with ``values`` and the heaviest parts of ``mixes`` over them, unchecked.

        Made once a frame from values that were checked: see scene/volumes.py.
        """
        made = object.__new__(Settings)
        made._values = {**self._values, **values}
        for key, mix in mixes.items():
            made._values[key] = max(reversed(mix), key=_share)[0]
        made._mixes = mixes
        return made

    def mix(self, key: str) -> Mix:
        """What stands for a switch, a choice or a text in a blend of volumes: shares sum to 1."""
        return self._mixes.get(key) or ((self._values[key], 1.0),)

    @classmethod
    def parse(cls, assignments: Iterable[str], base: Settings | None = None) -> Settings:
        """``base`` (the defaults if None) with ``key=value`` texts over it; the last one wins.

        Raises InputError("--set", key, reason).
        """
        values: dict[str, Any] = {}
        for assignment in assignments:
            key, equals, text = assignment.partition("=")
            key = key.strip()
            if not equals:
                raise InputError("--set", assignment, "expected key=value")
            setting = _find("--set", key)
            try:
                values[key] = setting.parse(text)
            except ValueError as error:
                raise InputError("--set", key, str(error)) from None
        return (base or cls()).replace(values, "--set")


def check_override(file: str, key: str, value: Any) -> Any:
    """The value of a setting that volumes may override. Raises InputError(file, key, reason)."""
    if not _find(file, key).volume:
        raise InputError(file, key, "is not a setting that volumes may override")
    return check_setting(file, key, value)


def _share(part: tuple[Any, float]) -> float:
    return part[1]


def _flatten(values: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    for key, value in values.items():
        if isinstance(value, Mapping):
            yield from _flatten(value, f"{prefix}{key}.")
        else:
            yield f"{prefix}{key}", value


def _find(file: str, key: str) -> Setting:
    if key in SETTINGS:
        return SETTINGS[key]
    group = [known for known in SETTINGS if known.startswith(f"{key}.")]
    if group:
        raise InputError(file, key, f"is a group of settings: {', '.join(group[:GROUP_TOLD])}, …")
    nearest = difflib.get_close_matches(key, SETTINGS, n=1, cutoff=0.6)
    hint = f"did you mean {nearest[0]}?" if nearest else "see `elemental list settings`"
    raise InputError(file, key, f"unknown setting; {hint}")


def check_setting(file: str, key: str, value: Any) -> Any:
    """The value of a setting in its own type. Raises InputError(file, key, reason)."""
    setting = _find(file, key)
    try:
        return setting.check(value)
    except ValueError as error:
        raise InputError(file, key, str(error)) from None
