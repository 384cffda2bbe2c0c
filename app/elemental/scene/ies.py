"""Photometric files of luminaires: IES LM-63 (.ies), 1986 to 2002.

[IESNA LM-63-2002 "Standard File Format for the Electronic Transfer of Photometric Data"]
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from elemental.core.errors import InputError
from elemental.core.files import read_file
from elemental.scene.arrays import FloatArray

F64 = npt.NDArray[np.float64]

TYPE_C = 1
"""Photometric type whose planes turn about the axis through nadir and zenith."""
ANGLES_MAX = 1000
"""Angles along one direction: finer than a degree is unheard of."""
BYTES_MAX = 1 << 24
NUMBER = re.compile(r"[^\s,]+")


@dataclass(frozen=True, eq=False)
class LightProfile:
    """How a luminaire spreads its light.

    vertical (V,) rad from the way it points, 0 to π, ascending; horizontal (H,) rad about that
    axis, ascending: one plane for all, or the first to the last of the symmetric part that the
    file gives; candela (H, V).
    """

    name: str
    vertical: F64
    horizontal: F64
    candela: F64

    @property
    def peak(self) -> float:
        """Largest luminous intensity, cd."""
        return float(self.candela.max())

    def intensity(self, vertical: F64, horizontal: F64) -> F64:
        """Candela at angles in rad, of any shape: linear between the file's, 0 outside them."""
        plane = _folded(horizontal, self.horizontal)
        row, along = _between(plane, self.horizontal)
        column, down = _between(vertical, self.vertical)
        next_row = np.minimum(row + 1, len(self.horizontal) - 1)
        next_column = np.minimum(column + 1, len(self.vertical) - 1)
        upper = (1 - down) * self.candela[row, column] + down * self.candela[row, next_column]
        lower = (1 - down) * self.candela[next_row, column] + (
            down * self.candela[next_row, next_column]
        )
        outside = (vertical < self.vertical[0] - 1e-9) | (vertical > self.vertical[-1] + 1e-9)
        return np.asarray(np.where(outside, 0.0, (1 - along) * upper + along * lower))

    def image(self, width: int, height: int) -> FloatArray:
        """(height, width) float32 intensity over the peak at the middles of texels: the columns
        go round the axis, the rows from the way it points to its back."""
        vertical = (np.arange(height) + 0.5) / height * math.pi
        horizontal = (np.arange(width) + 0.5) / width * 2.0 * math.pi
        values = self.intensity(*np.meshgrid(vertical, horizontal, indexing="ij"))
        return (values / self.peak).astype(np.float32)


def _folded(horizontal: F64, planes: F64) -> F64:
    """Horizontal angles brought into the symmetric part that the planes cover."""
    turned = np.mod(horizontal, 2.0 * math.pi)
    span = planes[-1] - planes[0]
    if len(planes) == 1:
        return np.full_like(turned, planes[0])
    if span < 1.5 * math.pi:  # half, mirrored at the plane through its ends
        turned = np.abs(np.mod(turned - planes[0] + math.pi, 2.0 * math.pi) - math.pi)
        if span < 0.75 * math.pi:  # a quarter
            turned = np.minimum(turned, math.pi - turned)
        return np.asarray(turned + planes[0])
    return turned


def _between(values: F64, knots: F64) -> tuple[npt.NDArray[np.int64], F64]:
    """(index of the knot below, share of the next one) for each value, held inside the knots."""
    if len(knots) == 1:
        return np.zeros(values.shape, np.int64), np.zeros(values.shape)
    below = np.clip(np.searchsorted(knots, values, side="right") - 1, 0, len(knots) - 2)
    share = (values - knots[below]) / (knots[below + 1] - knots[below])
    return below, np.clip(share, 0.0, 1.0)


def read_ies(path: Path) -> LightProfile:
    """Read a photometric file. Raises InputError."""
    raw = read_file(path)
    if len(raw) > BYTES_MAX:
        raise InputError(path, "", f"is larger than {BYTES_MAX >> 20} MiB")
    return parse_ies(raw.decode("latin-1"), path)


def parse_ies(text: str, path: Path) -> LightProfile:
    """The luminaire of a file's text. Raises InputError."""
    head = re.search(r"^[ \t]*TILT[ \t]*=[ \t]*([^\r\n]*)", text, re.MULTILINE)
    if head is None:
        raise InputError(path, "TILT", "is missing: not an IES LM-63 file")
    numbers = _Numbers(text[head.end() :], path)
    tilt = head[1].strip().upper()
    if tilt == "INCLUDE":
        numbers.take("lamp geometry", 1)
        numbers.take("TILT", 2 * numbers.count("TILT angles"))  # of lamps on their side
    elif tilt != "NONE":
        raise InputError(path, "TILT", f"{head[1].strip()[:60]!r} is not NONE or INCLUDE")
    _, _, multiplier = numbers.take("lamps", 3)
    vertical_count, horizontal_count = numbers.count("vertical angles"), numbers.count("planes")
    kind = numbers.take("photometric type", 1)[0]
    if kind != TYPE_C:
        raise InputError(path, "photometric type", f"{kind:g} is not {TYPE_C} (type C)")
    numbers.take("dimensions", 4)
    ballast, ballast_lamp, _ = numbers.take("ballast factor", 3)
    factor = multiplier * ballast * (ballast_lamp or 1.0)
    if not factor > 0.0:
        raise InputError(path, "multiplier", "with the ballast factor is not positive")
    vertical = numbers.angles("vertical angles", vertical_count, 180.0)
    horizontal = numbers.angles("horizontal angles", horizontal_count, 360.0)
    _check_planes(horizontal, path)
    candela = numbers.take("candela values", vertical_count * horizontal_count) * factor
    if candela.min() < 0.0 or not candela.max() > 0.0:
        reason = "are negative" if candela.min() < 0.0 else "are all 0"
        raise InputError(path, "candela values", reason)
    shape = (horizontal_count, vertical_count)
    return LightProfile(
        path.stem, np.radians(vertical), np.radians(horizontal), candela.reshape(shape)
    )


def _check_planes(degrees: F64, path: Path) -> None:
    """Refuse parts of a circle that no symmetry completes."""
    first, last = float(degrees[0]), float(degrees[-1])
    whole = {(0.0, 0.0), (0.0, 90.0), (0.0, 180.0), (0.0, 360.0), (90.0, 270.0)}
    if len(degrees) > 1 and (first, last) not in whole:
        reason = f"{first:g} to {last:g} is not 0 to 90, 180 or 360, or 90 to 270"
        raise InputError(path, "horizontal angles", reason)


class _Numbers:
    """The numbers of a file in their order, whatever its lines are."""

    def __init__(self, text: str, path: Path) -> None:
        self._words: Iterator[re.Match[str]] = NUMBER.finditer(text)
        self._path = path

    def take(self, field: str, count: int) -> F64:
        """The next `count`, finite."""
        values = np.zeros(count)
        for i in range(count):
            word = next(self._words, None)
            if word is None:
                raise InputError(self._path, field, f"the file ends after {i} of {count}")
            try:
                values[i] = float(word[0])
            except ValueError:
                raise InputError(self._path, field, f"{word[0][:60]!r} is no number") from None
            if not math.isfinite(values[i]):
                raise InputError(self._path, field, f"{word[0][:60]!r} is not finite")
        return values

    def count(self, field: str) -> int:
        """The next one as a number of things."""
        value = float(self.take(field, 1)[0])
        if not (1 <= value <= ANGLES_MAX and value == int(value)):
            raise InputError(self._path, field, f"{value:g} is not 1 to {ANGLES_MAX}")
        return int(value)

    def angles(self, field: str, count: int, most: float) -> F64:
        """The next `count` as ascending degrees."""
        degrees = self.take(field, count)
        if np.any(np.diff(degrees) <= 0.0):
            raise InputError(self._path, field, "do not ascend")
        if degrees[0] < 0.0 or degrees[-1] > most:
            raise InputError(self._path, field, f"are not within 0 to {most:g} degrees")
        return degrees
