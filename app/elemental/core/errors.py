"""The one exception that bad input raises."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
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

    @property
    def lines(self) -> list[str]:
        """What to print, a line for each thing that is wrong."""
        return [str(self)]


class CombinedInputError(InputError):
    """Several things wrong in one file, all found at once: a line each."""

    def __init__(self, file: str | Path, reasons: list[tuple[str, str]]) -> None:
        """`reasons`: (field, reason), at least one."""
        super().__init__(file, *reasons[0])
        self.errors = [InputError(file, field, reason) for field, reason in reasons]

    def __str__(self) -> str:
        return "\n".join(self.lines)

    @property
    def lines(self) -> list[str]:
        return [line for error in self.errors for line in error.lines]


@contextmanager
def named_by(file: str | Path, field: str, name: str) -> Iterator[None]:
    """Tell what is wrong with the file called ``name`` as wrong of the ``field`` that names it.

    Raises InputError(``file``, ``field``, reason), the reason beginning with ``name``.
    """
    try:
        yield
    except InputError as error:
        reason = ": ".join(part for part in (name, error.field, error.reason) if part)
        raise InputError(file, field, reason) from error
