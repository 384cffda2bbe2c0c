"""What happened, newest last: the scene's warnings, the driver's messages, shaders, actions."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Literal

Kind = Literal["note", "warning", "error"]

LONGEST = 2000
"""Entries kept."""


@dataclass
class Entry:
    """One line, and how often it came in a row."""

    kind: Kind
    text: str
    time_s: float
    """Since the program's start."""
    count: int = 1


class Log:
    """Entries, and what has been taken over from elsewhere so far."""

    def __init__(self) -> None:
        self.entries: deque[Entry] = deque(maxlen=LONGEST)
        self._driver = 0
        self._problems: tuple[str, ...] = ()

    def add(self, kind: Kind, text: str, time_s: float) -> None:
        """A line; the same one again only counts."""
        last = self.entries[-1] if self.entries else None
        if last is not None and (last.kind, last.text) == (kind, text):
            last.count += 1
            last.time_s = time_s
        else:
            self.entries.append(Entry(kind, text, time_s))

    def add_all(self, kind: Kind, texts: Iterable[str], time_s: float) -> None:
        """Several lines."""
        for text in texts:
            self.add(kind, text, time_s)

    def follow(self, driver: Sequence[object], problems: Sequence[str], time_s: float) -> None:
        """Take over what the driver has said since, and which shaders fail to compile now."""
        if len(driver) != self._driver:
            self.add_all("warning", map(str, driver[min(self._driver, len(driver)) :]), time_s)
            self._driver = len(driver)
        standing = tuple(problems)
        if standing != self._problems:
            new = [problem for problem in standing if problem not in self._problems]
            self.add_all("error", new, time_s)
            if not standing:
                self.add("note", "all shaders compile again", time_s)
            self._problems = standing

    def count(self, kind: Kind) -> int:
        """How many entries of a kind there are."""
        return sum(entry.kind == kind for entry in self.entries)
