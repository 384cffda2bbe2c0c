"""One tunable: what may be assigned to it, from text and from values."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Literal

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
    volume: bool = False
    """Whether post-process volumes may override it: then a change must not rebuild anything."""

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
            text = str(shown).strip("()") if isinstance(shown, tuple) else str(shown)
            raise ValueError(f"{text[:60]!r} is not {self.range_text()}")
        return value

    def _parse_bool(self, text: str) -> bool:
        word = text.lower()
        self._require(word in TRUE_WORDS | FALSE_WORDS, text, text)
        return word in TRUE_WORDS
