"""Every tunable of the program, once: name, unit, range, default, meaning and source.

The command line (``--set gi.resolution=256``), scene files (``[settings]``), ``elemental list
settings`` and the passes all read the one table ``SETTINGS``. Values are checked when a
``Settings`` is made, so a pass never meets a value outside its range.
"""

from __future__ import annotations

import difflib
import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, Literal

from elemental.core.errors import InputError

Kind = Literal["bool", "int", "float", "choice", "color", "text"]

TRUE_WORDS = frozenset({"true", "on", "yes", "1"})
FALSE_WORDS = frozenset({"false", "off", "no", "0"})


@dataclass(frozen=True)
class Setting:
    """One tunable. ``lo`` and ``hi`` are inclusive and apply to each component of a colour."""

    key: str
    kind: Kind
    default: Any
    help: str
    unit: str = ""
    lo: float | None = None
    hi: float | None = None
    choices: tuple[Any, ...] = ()
    source: str = ""

    def range_text(self) -> str:
        """What may be assigned, for help and error messages: ``64, 128, 256``, ``-16 to 16 EV``."""
        if self.kind == "bool":
            return "true or false"
        if self.kind == "choice":
            return ", ".join(str(choice) for choice in self.choices)
        if self.kind == "text":
            return "text"
        word = {"int": "a whole number", "float": "a number", "color": "r,g,b (linear)"}[self.kind]
        if self.lo is not None and self.hi is not None:
            span = f"{self.lo:g} to {self.hi:g}"
            word = span if self.kind == "float" else f"{word}, {span}"
        return f"{word} {self.unit}".rstrip()

    def value_text(self, value: Any) -> str:
        """The value as ``--set`` takes it."""
        if self.kind == "bool":
            return "true" if value else "false"
        if self.kind == "color":
            return ",".join(f"{component:g}" for component in value)
        return f"{value:g}" if self.kind == "float" else str(value)

    def parse(self, text: str) -> Any:
        """The value that a text stands for. Raises ValueError with the reason."""
        text = text.strip()
        if self.kind == "bool":
            return self._parse_bool(text)
        if self.kind == "choice":
            return self.check(next((c for c in self.choices if str(c) == text), text))
        if self.kind == "text":
            return self.check(text)
        parts = text.split(",") if self.kind == "color" else [text]
        try:
            numbers = [int(part) if self.kind == "int" else float(part) for part in parts]
        except ValueError:
            raise ValueError(f"{text[:60]!r} is not {self.range_text()}") from None
        return self.check(tuple(numbers) if self.kind == "color" else numbers[0])

    def check(self, value: Any) -> Any:
        """The value in its own type and inside its range. Raises ValueError with the reason."""
        if self.kind == "choice":
            allowed = any(value == c and type(value) is type(c) for c in self.choices)
            return self._require(allowed, value, value)
        if self.kind in ("bool", "text"):
            kind = bool if self.kind == "bool" else str
            allowed = isinstance(value, kind) and (kind is bool or str(value).isprintable())
            return self._require(allowed, value, value)
        if self.kind == "color":
            if not isinstance(value, tuple | list) or len(value) != 3:
                self._require(False, value, value)
            return tuple(self._number(component, value) for component in value)
        return self._number(value, value)

    def _number(self, number: Any, shown: Any) -> Any:
        kinds = int if self.kind == "int" else (int, float)
        allowed = isinstance(number, kinds) and not isinstance(number, bool)
        allowed = allowed and (isinstance(number, int) or math.isfinite(number))
        allowed = allowed and (self.lo is None or number >= self.lo)
        allowed = allowed and (self.hi is None or number <= self.hi)
        self._require(allowed, number, shown)
        return number if self.kind == "int" else float(number)

    def _require(self, allowed: bool, value: Any, shown: Any) -> Any:
        if not allowed:
            text = shown if isinstance(shown, str) else repr(shown)
            raise ValueError(f"{text[:60]!r} is not {self.range_text()}")
        return value

    def _parse_bool(self, text: str) -> bool:
        word = text.lower()
        self._require(word in TRUE_WORDS | FALSE_WORDS, text, text)
        return word in TRUE_WORDS


_TABLE = (
    Setting(
        "gi.enabled", "bool", True,
        "indirect light by voxel cone tracing, the sky's too; off leaves direct light and emission",
        source="[Mittring12] [Crassin11]",
    ),
    Setting(
        # 128: the finest grid that a two-core software driver still rebuilds several times a
        # second; one step up costs four times the bricks.
        "gi.resolution", "choice", 128,
        "lattice points a side of the voxel octree at its leaves",
        unit="voxels", choices=(64, 128, 256, 512), source="[Mittring12] [Crassin11]",
    ),
    Setting(
        "gi.area_lights", "bool", True,
        "emissive parallelograms light by closed form, through aimed cones; off: as voxels",
        source="[Mittring12] [Heitz18]",
    ),
    Setting(
        "gi.specular", "bool", True,
        "glossy indirect light, one cone a pixel along the mirrored eye vector",
        source="[Mittring12]",
    ),
    Setting(
        "gi.specular_adaptive", "bool", True,
        "trace a quarter of the glossy pixels first, interpolate where they agree",
        source="[Mittring12]",
    ),
    Setting(
        # 9: the talk's. With area lights seen through cones of their own, 36 find 0 to 4 % more
        # light for three times the cost (docs/gi.md).
        "gi.diffuse_cones", "choice", 9,
        "cones over the sphere that gather diffuse light; more cost more and err less",
        unit="cones", choices=(9, 36, 63), source="[Mittring12] [Segovia06]",
    ),
    Setting(
        "gi.bounces", "int", 1,
        "gathers of indirect light; with n, voxels hold light gathered n-1 times",
        unit="gathers", lo=0, hi=8, source="[Mittring12] [Crassin11]",
    ),
    Setting(
        "gi.memory_budget_mb", "int", 1024,
        "most memory that the octree's pools may grow to",
        unit="MiB", lo=16, hi=16384,
    ),
    Setting(
        "scene.default_lights", "bool", True,
        "a default sun and sky for a scene without any light or emission",
    ),
    Setting(
        "scene.animation", "text", "all",
        "which of the scene's animations plays: its name, all or none",
        unit="name",
    ),
    Setting("sky.enabled", "bool", True, "draw the environment and light the scene by it"),
    Setting("sky.intensity", "float", 1.0, "factor on the environment's radiance", lo=0, hi=1000),
    Setting(
        "sky.image", "text", "",
        "equirectangular .hdr or .exr that replaces the scene's environment; empty keeps it",
        unit="file",
    ),
    Setting(
        "exposure", "float", 0.0,
        "factor 2^exposure on scene radiance before the tone curve",
        unit="EV", lo=-16, hi=16,
    ),
    Setting("fxaa.enabled", "bool", True, "edge antialiasing as the last filter",
            source="[Mittring12]"),
    Setting(
        "shadow.resolution", "choice", 1024,
        "texels a side of each shadow map and of each cascade",
        unit="texels", choices=(256, 512, 1024, 2048, 4096),
    ),
    Setting("shadow.cascades", "int", 3, "shadow maps of a directional light along the view",
            unit="maps", lo=1, hi=4),
    Setting(
        "shadow.distance", "float", 0.0,
        "reach of directional shadows from the camera; 0 takes the scene's size",
        unit="m", lo=0, hi=100000,
    ),
    Setting("voxels.level", "int", 0,
            "level above the leaves that the views 'voxels' and 'occupancy' show",
            unit="level", lo=0, hi=9),
    Setting("voxels.side", "choice", "all",
            "side of the voxels that the view 'voxels' shows; all: those towards the eye",
            choices=("all", "+x", "-x", "+y", "-y", "+z", "-z")),
)  # fmt: skip

SETTINGS: Mapping[str, Setting] = MappingProxyType({setting.key: setting for setting in _TABLE})


class Settings(Mapping[str, Any]):
    """An immutable, complete and checked assignment of every setting: ``s["gi.resolution"]``."""

    def __init__(self, values: Mapping[str, Any] | None = None) -> None:
        """The defaults, with ``values`` over them; raises InputError as ``replace`` does."""
        assigned = {key: setting.default for key, setting in SETTINGS.items()}
        for key, value in (values or {}).items():
            assigned[key] = _checked("settings", key, value)
        self._values = assigned

    def __getitem__(self, key: str) -> Any:
        return self._values[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __hash__(self) -> int:
        return hash(tuple(self._values.items()))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Settings) and self._values == other._values

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
        flat = {key: _checked(file, key, value) for key, value in _flatten(values)}
        return Settings({**self._values, **flat})

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


def _flatten(values: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    for key, value in values.items():
        if isinstance(value, Mapping):
            yield from _flatten(value, f"{prefix}{key}.")
        else:
            yield f"{prefix}{key}", value


def _find(file: str, key: str) -> Setting:
    if key in SETTINGS:
        return SETTINGS[key]
    nearest = difflib.get_close_matches(key, SETTINGS, n=1, cutoff=0.6)
    hint = f"did you mean {nearest[0]}?" if nearest else "see `elemental list settings`"
    raise InputError(file, key, f"unknown setting; {hint}")


def _checked(file: str, key: str, value: Any) -> Any:
    setting = _find(file, key)
    try:
        return setting.check(value)
    except ValueError as error:
        raise InputError(file, key, str(error)) from None
