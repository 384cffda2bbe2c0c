"""What the user is told: a line over the picture for a while, and the log of all that was said."""

from __future__ import annotations

import time
from collections.abc import Sequence

from elemental.scene.model import Scene
from elemental.ui.log import Kind, Log

MESSAGE_S = 4.0
"""How long a message stays."""


class Notices:
    """The newest message and the log, whose times are s since this was made."""

    def __init__(self) -> None:
        self.log = Log()
        self.kind: Kind = "note"
        """Of the newest message."""
        self._started = time.perf_counter()
        self._message, self._message_until = "", 0.0
        self._sure_until = 0.0

    @property
    def message(self) -> str:
        """The line that shows for a while, empty if none does."""
        return self._message if time.perf_counter() < self._message_until else ""

    def say(self, message: str, kind: Kind = "note") -> None:
        """Show a line for a while, and log it."""
        self._message, self._message_until = message, time.perf_counter() + MESSAGE_S
        self.kind = kind
        self.log.add(kind, message, self._now())

    def confirms(self, question: str) -> bool:
        """Whether the user does again what asks ``question``, which is said the first time."""
        if time.perf_counter() < self._sure_until:
            return True
        self._sure_until = time.perf_counter() + MESSAGE_S
        self.say(question)
        return False

    def follow(self, driver: Sequence[object], problems: Sequence[str]) -> None:
        """Log what the driver has said since, and which shaders fail to compile now."""
        self.log.follow(driver, problems, self._now())

    def open(self, scene: Scene) -> None:
        """Log what was found in a scene's files."""
        self.log.add_all("warning", scene.warnings, self._now())
        self.log.add_all("note", scene.notes, self._now())

    def _now(self) -> float:
        return time.perf_counter() - self._started
