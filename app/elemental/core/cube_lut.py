"""Reader of colour look-up tables, `.cube` [Adobe13 "Cube LUT Specification 1.0"]."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from elemental.core.errors import InputError
from elemental.core.files import read_text

CUBE_SUFFIX = ".cube"
CURVE_SIZES = range(2, 65536 + 1)
CUBE_SIZES = range(2, 256 + 1)
"""Entries along an axis [Adobe13]."""
LARGEST = 1e6
"""Largest entry and domain bound that is taken: far above display range, within half floats' 16
bits once clipped [inferred]."""


@dataclass(frozen=True)
class CubeLut:
    """A look-up table over colours between ``low`` and ``high``, (3,) float32 each.

    ``table``: (N, 3) float32, three curves, or (N, N, N, 3) by blue, green, red.
    """

    table: npt.NDArray[np.float32]
    low: npt.NDArray[np.float32]
    high: npt.NDArray[np.float32]

    @property
    def size(self) -> int:
        """Entries along an axis."""
        return len(self.table)

    @property
    def is_cube(self) -> bool:
        """Whether it maps colours, not channels."""
        return self.table.ndim == 4


def read_cube_lut(path: Path) -> CubeLut:
    """Parse a `.cube` file. Raises InputError(file, line, reason)."""
    if path.suffix.lower() != CUBE_SUFFIX:
        raise InputError(path, "", f"expected a {CUBE_SUFFIX} file")
    return parse_cube_lut(read_text(path), path)


def parse_cube_lut(text: str, file: str | Path) -> CubeLut:
    """The table that a `.cube` text holds. `file`: what errors name; raises InputError."""
    parser = _Parser(file)
    for number, line in enumerate(text.splitlines(), 1):
        words = line.partition("#")[0].split()
        if words:
            parser.take(number, words)
    return parser.result()


class _Parser:
    def __init__(self, file: str | Path) -> None:
        self.file = file
        self.axes = self.size = 0
        self.low, self.high = [0.0] * 3, [1.0] * 3
        self.rows: list[list[float]] = []

    def take(self, number: int, words: list[str]) -> None:
        keyword, rest = words[0], words[1:]
        if keyword == "TITLE":
            return
        if keyword in ("LUT_1D_SIZE", "LUT_3D_SIZE"):
            self._take_size(number, 1 if "1D" in keyword else 3, rest)
        elif keyword in ("DOMAIN_MIN", "DOMAIN_MAX"):
            bound = self._numbers(number, rest)
            self.low, self.high = (bound, self.high) if "MIN" in keyword else (self.low, bound)
        elif keyword[0].isalpha() and keyword.lower() not in ("nan", "inf", "infinity"):
            self._refuse(number, f"unknown keyword {keyword[:40]!r}")
        elif not self.size:
            self._refuse(number, "colours before LUT_1D_SIZE or LUT_3D_SIZE")
        elif len(self.rows) == self.size**self.axes:
            self._refuse(number, f"more than {len(self.rows)} colours")
        else:
            self.rows.append(self._numbers(number, words))

    def result(self) -> CubeLut:
        if not self.size:
            raise InputError(self.file, "", "no LUT_1D_SIZE or LUT_3D_SIZE")
        wanted = self.size**self.axes
        if len(self.rows) != wanted:
            raise InputError(self.file, "", f"{len(self.rows)} colours, {wanted} needed")
        low, high = np.array(self.low, np.float32), np.array(self.high, np.float32)
        if not (high > low).all():
            raise InputError(self.file, "DOMAIN_MAX", "is not above DOMAIN_MIN")
        shape = (self.size,) * self.axes + (3,)
        return CubeLut(np.array(self.rows, np.float32).reshape(shape), low, high)

    def _take_size(self, number: int, axes: int, words: list[str]) -> None:
        sizes = CURVE_SIZES if axes == 1 else CUBE_SIZES
        if self.size:
            self._refuse(number, "a second size")
        text = words[0] if len(words) == 1 else ""
        if not (text.isascii() and text.isdigit()) or len(text) > 5 or int(text) not in sizes:
            self._refuse(number, f"expected a size from {sizes[0]} to {sizes[-1]}")
        self.axes, self.size = axes, int(text)

    def _numbers(self, number: int, words: list[str]) -> list[float]:
        try:
            values = [float(word) for word in words]
        except ValueError:
            values = []
        if len(values) != 3 or not all(abs(value) <= LARGEST for value in values):
            self._refuse(number, f"expected three numbers, not {' '.join(words)[:40]!r}")
        return values

    def _refuse(self, number: int, reason: str) -> None:
        raise InputError(self.file, f"line {number}", reason)
