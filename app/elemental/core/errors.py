"""The one exception that bad input raises."""

from __future__ import annotations

from pathlib import Path


class InputError(Exception):
    """Bad input: a file, scene, setting or command line that can't be honoured.

    Prints as one line, ``file: field: reason``; the command line turns it into exit code 2.
    """

    def __init__(self, file: str | Path, field: str, reason: str) -> None:
        self.file = str(file)
        self.field = field
        self.reason = reason
        parts = (part for part in (self.file, field, reason) if part)
        super().__init__(": ".join(" ".join(part.split()) for part in parts))
