"""Typed reading of parsed JSON: a wrong type anywhere is an InputError that names the place."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeVar, overload

import numpy as np

from elemental.core.errors import InputError
from elemental.scene.model import FloatArray

FLOAT32_MAX = float(np.finfo(np.float32).max)
MAX_INTEGER = 2**53 - 1
"""Largest integer that JSON carries exactly."""

Word = TypeVar("Word", bound=str)


@dataclass
class Report:
    """What a file could not be honoured in (`warnings`) and what was done to it (`notes`).

    Both are ordered sets of lines.
    """

    file: Path
    warnings: dict[str, None] = field(default_factory=dict)
    notes: dict[str, None] = field(default_factory=dict)
    _counts: Counter[str] = field(default_factory=Counter)

    def warn(self, where: str, reason: str) -> None:
        """One line, said once."""
        self.warnings[self._line(where, reason)] = None

    def note(self, where: str, reason: str) -> None:
        """One line, said once."""
        self.notes[self._line(where, reason)] = None

    def count(self, what: str, number: int = 1) -> None:
        """Things of one kind, however many: one note in the end."""
        self._counts[what] += number

    def note_counts(self) -> None:
        for what, number in self._counts.items():
            self.note("", f"{number} {what}")

    def _line(self, where: str, reason: str) -> str:
        return str(InputError(self.file, where, reason))


@dataclass(frozen=True)
class Field:
    """A value of the JSON with its path, such as ``materials[2].pbrMetallicRoughness``."""

    report: Report
    path: str
    raw: Any

    def error(self, reason: str) -> InputError:
        return InputError(self.report.file, self.path, reason)

    def warn(self, reason: str) -> None:
        self.report.warn(self.path, reason)

    def _expected(self, what: str) -> InputError:
        return self.error(f"expected {what}")

    # Objects and arrays

    def find(self, key: str) -> Field | None:
        """The member `key` of an object, or None."""
        if not isinstance(self.raw, dict):
            raise self._expected("an object")
        if key not in self.raw:
            return None
        return Field(self.report, f"{self.path}.{key}" if self.path else key, self.raw[key])

    def need(self, key: str) -> Field:
        """The member `key` of an object."""
        found = self.find(key)
        if found is None:
            raise self.error(f"{key} is missing")
        return found

    def keys(self) -> list[str]:
        if not isinstance(self.raw, dict):
            raise self._expected("an object")
        return list(self.raw)

    def extension(self, name: str) -> Field | None:
        """The member `extensions.<name>`, or None."""
        extensions = self.find("extensions")
        return extensions.find(name) if extensions else None

    def elements(self, key: str) -> list[Field]:
        """The elements of the array `key`; a missing array is empty."""
        found = self.find(key)
        return list(found) if found else []

    def __iter__(self) -> Iterator[Field]:
        if not isinstance(self.raw, list):
            raise self._expected("an array")
        for i, raw in enumerate(self.raw):
            yield Field(self.report, f"{self.path}[{i}]", raw)

    # Values

    def text(self) -> str:
        """A string; what can't be printed (control characters, lone surrogates) becomes `?`."""
        if not isinstance(self.raw, str):
            raise self._expected("a string")
        return printable(self.raw)

    def number(self, low: float = -FLOAT32_MAX, high: float = FLOAT32_MAX) -> float:
        """A finite number in low..high."""
        if isinstance(self.raw, bool) or not isinstance(self.raw, int | float):
            raise self._expected("a number")
        if not -FLOAT32_MAX <= self.raw <= FLOAT32_MAX:
            raise self._expected("a finite number within the range of 32-bit floats")
        if not low <= self.raw <= high:
            raise self._expected(_between(low, high) + f", not {self.raw:g}")
        return float(self.raw)

    def integer(self, low: int = 0, high: int = MAX_INTEGER) -> int:
        """A whole number in low..high (`3.0` is one, as in JSON Schema)."""
        raw = self.raw
        if isinstance(raw, float) and math.isfinite(raw) and raw.is_integer():
            raw = int(raw)
        if isinstance(raw, bool) or not isinstance(raw, int):
            raise self._expected("a whole number")
        if not low <= raw <= high:
            raise self.error(f"{raw if abs(raw) <= MAX_INTEGER else 'the number'} is out of range")
        return raw

    def numbers(self, count: int, low: float = -FLOAT32_MAX) -> FloatArray:
        """An array of exactly `count` finite numbers, each at least `low`, as float32."""
        if not isinstance(self.raw, list) or len(self.raw) != count:
            raise self._expected(f"{count} numbers")
        values = [element.number(low) for element in self]
        return np.array(values, np.float32)

    # Optional members

    @overload
    def number_or(self, key: str, default: float, low: float = ..., high: float = ...) -> float: ...
    @overload
    def number_or(self, key: str, default: None, low: float = ...) -> float | None: ...
    def number_or(
        self, key: str, default: float | None, low: float = -FLOAT32_MAX, high: float = FLOAT32_MAX
    ) -> float | None:
        found = self.find(key)
        return found.number(low, high) if found else default

    def clamped_or(self, key: str, default: float, low: float, high: float) -> float:
        """A number; one outside low..high is clamped with a warning."""
        found = self.find(key)
        if found is None:
            return default
        value = found.number()
        if not low <= value <= high:
            found.warn(f"{value:g} is clamped to {low:g}..{high:g}")
        return min(max(value, low), high)

    def integer_or(self, key: str, default: int, low: int = 0, high: int = MAX_INTEGER) -> int:
        found = self.find(key)
        return found.integer(low, high) if found else default

    def index_or_none(self, key: str, count: int, what: str) -> int | None:
        """An index into the `count` elements of the array `what`, or None where it is missing."""
        found = self.find(key)
        return found.index(count, what) if found else None

    def index(self, count: int, what: str) -> int:
        value = self.integer(high=MAX_INTEGER)
        if value >= count:
            raise self.error(f"{value} is out of range, there are {count} {what}")
        return value

    def text_or(self, key: str, default: str) -> str:
        found = self.find(key)
        return found.text() if found else default

    def flag(self, key: str, default: bool = False) -> bool:
        """A boolean member, or the default where it is missing."""
        found = self.find(key)
        if found is None:
            return default
        if not isinstance(found.raw, bool):
            raise found._expected("true or false")
        return found.raw

    def choice_or(self, key: str, default: Word, choices: dict[Any, Word]) -> Word:
        """`choices` maps the JSON's value to ours."""
        found = self.find(key)
        if found is None:
            return default
        if isinstance(found.raw, bool) or not isinstance(found.raw, str | int):
            raise found._expected("one of " + ", ".join(map(str, choices)))
        if found.raw not in choices:
            raise found._expected("one of " + ", ".join(map(str, choices)))
        return choices[found.raw]


def printable(text: str) -> str:
    """`text` with `?` for control characters and lone surrogates."""
    return "".join(c if c.isprintable() else "?" for c in text)


def _between(low: float, high: float) -> str:
    if high == FLOAT32_MAX:
        return f"a number of at least {low:g}"
    return f"a number from {low:g} to {high:g}"
