"""What an artist may set of a material: typed parameters with range, default, unit and help."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal, TypeAlias, get_args

from elemental.core.errors import InputError

ParameterKind: TypeAlias = Literal[
    "float", "int", "bool", "color", "rgba", "vec2", "vec3", "texture"
]
ParameterValue: TypeAlias = float | int | bool | str | tuple[float, ...]
"""A number, or several; of a texture the name of a plain one, or of an image file."""

LANES: Mapping[ParameterKind, int] = {
    "float": 1, "int": 1, "bool": 1, "vec2": 2, "vec3": 3, "color": 3, "rgba": 4, "texture": 0,
}  # fmt: skip
"""Floats that a value takes."""
PLAIN_TEXTURES: Mapping[str, tuple[int, int, int, int]] = {
    "white": (255, 255, 255, 255),
    "grey": (128, 128, 128, 255),
    "black": (0, 0, 0, 255),
    "flat": (128, 128, 255, 255),
}
"""Textures of one RGBA8 texel; "flat" is the normal map of a plane."""
_WORDS = """
active asm attribute bool break buffer case centroid class coherent common const continue default
discard do double else enum extern external false filter fixed flat float for goto half highp if
image in inline input inout int interface invariant layout long lowp mat2 mat3 mat4 mediump
namespace noinline none noperspective out output packed partition patch precise precision public
readonly resource restrict return sample sampler shared short sizeof smooth static struct
subroutine superp switch template this true typedef uint uniform union unsigned using varying vec2
vec3 vec4 void volatile while writeonly
"""
GLSL_WORDS = frozenset(_WORDS.split())
"""Names that no parameter may have: words of GLSL, of a driver's own dialect, or of ours."""
LARGEST = 1e9
"""Bound of a number without a range of its own."""
LARGEST_INTEGER = 1 << 24
"""Integers are kept as floats, which hold all of them up to here."""


@dataclass(frozen=True)
class Parameter:
    """One parameter: what a panel needs to draw it and a shader to declare it.

    `low` and `high` bound each component; `unit` is empty for pure numbers. `is_srgb`: whether a
    texture's colours are sRGB encoded.
    """

    name: str
    kind: ParameterKind
    default: ParameterValue
    low: float = -LARGEST
    high: float = LARGEST
    unit: str = ""
    help: str = ""
    is_srgb: bool = True

    @property
    def lanes(self) -> int:
        """Floats that a value takes; 0 for textures."""
        return LANES[self.kind]

    def checked(self, value: object, file: object, field: str) -> ParameterValue:
        """`value` as this parameter holds it. Raises InputError(file, field, reason)."""
        try:
            return self._checked(value)
        except ValueError as error:
            raise InputError(str(file), field, str(error)) from None

    def _checked(self, value: object) -> ParameterValue:
        if self.kind == "texture":
            if not isinstance(value, str) or not value:
                raise ValueError("should be an image's file name")
            return value
        if self.kind == "bool":
            if not isinstance(value, bool):
                raise ValueError("should be true or false")
            return value
        if self.lanes == 1:
            return self._number(value)
        if not isinstance(value, list | tuple) or len(value) != self.lanes:
            raise ValueError(f"should be a list of {self.lanes} numbers")
        return tuple(float(self._number(item)) for item in value)

    def _number(self, value: object) -> float | int:
        whole = self.kind == "int"
        if isinstance(value, bool) or not isinstance(value, int if whole else int | float):
            raise ValueError(f"should be {'an integer' if whole else 'a number'}")
        if not math.isfinite(value) or not self.low <= value <= self.high:
            raise ValueError(f"should be {self.range_text()}")
        return value if whole else float(value)

    def range_text(self) -> str:
        """The range in words: ``0 to 1``, ``0 or more``, or nothing where there is none."""
        ends = [f"{end:g}" for end in (self.low, self.high)]
        if self.kind in ("texture", "bool") or (self.low <= -LARGEST and self.high >= LARGEST):
            return ""
        if self.high >= LARGEST:
            return f"{ends[0]} or more"
        return f"{ends[1]} or less" if self.low <= -LARGEST else f"{ends[0]} to {ends[1]}"

    def value_text(self, value: ParameterValue) -> str:
        """A value as a scene file has it."""
        if isinstance(value, bool):
            return str(value).lower()
        if isinstance(value, tuple):
            return f"[{', '.join(f'{part:g}' for part in value)}]"
        return value if isinstance(value, str) else f"{value:g}"


def read_parameter(name: str, table: object, file: object) -> Parameter:
    """A parameter from its table in a material's heading. Raises InputError."""
    field = f"parameters.{name}"

    def refuse(key: str, reason: str) -> InputError:
        return InputError(str(file), f"{field}.{key}" if key else field, reason)

    if not isinstance(table, dict):
        raise refuse("", "should be a table")
    _check_name(name, str(file), field)
    left = dict(table)
    kind = left.pop("type", None)
    if kind not in get_args(ParameterKind):
        raise refuse("type", f"should be one of {', '.join(get_args(ParameterKind))}")
    texts = {key: left.pop(key, "") for key in ("unit", "help")}
    for key, text in texts.items():
        if not isinstance(text, str):
            raise refuse(key, "should be a text")
    lowest = 0.0 if kind in ("color", "rgba") else -LARGEST
    highest = float(LARGEST_INTEGER) if kind == "int" else LARGEST
    low, high = left.pop("min", lowest), left.pop("max", highest)
    for key, end in (("min", low), ("max", high)):
        if isinstance(end, bool) or not isinstance(end, int | float) or not abs(end) <= LARGEST:
            raise refuse(key, "should be a number")
    if not low < high:
        raise refuse("max", "is not greater than min")
    srgb = left.pop("srgb", True)
    if not isinstance(srgb, bool):
        raise refuse("srgb", "should be true or false")
    default = left.pop("default", None)
    if left:
        raise refuse(min(left), "is an unknown key")
    if default is None:
        raise refuse("default", "is missing")
    parameter = Parameter(
        name, kind, 0.0, float(low), float(high), texts["unit"], texts["help"], srgb
    )
    default = parameter.checked(default, file, f"{field}.default")
    if kind == "texture" and default not in PLAIN_TEXTURES:
        raise refuse("default", f"should be one of {', '.join(PLAIN_TEXTURES)}")
    return Parameter(
        name, kind, default, float(low), float(high), texts["unit"], texts["help"], srgb
    )


def _check_name(name: str, file: str, field: str) -> None:
    """Raises InputError(file, field, reason) for what can be no name in GLSL."""
    reason = ""
    if name in GLSL_WORDS or name.startswith("gl_"):
        reason = "is a word of GLSL"
    elif not (name.isidentifier() and name.isascii() and "__" not in name):
        reason = "is no name: letters, digits and single underscores"
    if reason:
        raise InputError(file, field, reason)
