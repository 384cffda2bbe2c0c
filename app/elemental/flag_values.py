"""Values of flags: a text of the command line to a value, or argparse.ArgumentTypeError.

Also the parser that refuses by InputError; the command line and the tools share both.
"""

from __future__ import annotations

import argparse
import math
import re
from collections.abc import Callable
from typing import Any, NoReturn

from elemental.core.errors import InputError

MAX_FRAME = 10**6
"""Last frame of a sequence, nine hours at 30 a second."""
MAX_SIDE_PX = 16384
"""Largest image side; the texture limit of common drivers."""

MAX_COORDINATE_M = 1e9
"""Farthest camera; beyond it 32-bit positions hold no scene."""

VECTOR_FLAGS = frozenset({"--eye", "--target"})


class Parser(argparse.ArgumentParser):
    """Refuses by InputError instead of a usage page, and takes no abbreviated flags."""

    def __init__(self, **options: Any) -> None:
        super().__init__(**options, allow_abbrev=False)

    def error(self, message: str) -> NoReturn:
        raise InputError("", "", message.removeprefix("argument "))

    def flag(self, name: str, metavar: str, kind: Any, default: Any, text: str) -> None:
        """A flag with a value; ``kind`` makes the value of a text or raises ArgumentTypeError."""
        self.add_argument(name, metavar=metavar, type=kind, default=default, help=text)


def join_vectors(words: list[str]) -> list[str]:
    """``--eye -1,2,3`` as ``--eye=-1,2,3``: argparse takes the former's value for a flag."""
    joined: list[str] = []
    for word in words:
        if joined and joined[-1] in VECTOR_FLAGS and re.match(r"-[\d.]", word):
            joined[-1] += f"={word}"
        else:
            joined.append(word)
    return joined


def size(text: str) -> tuple[int, int]:
    """(width, height) in pixels of 1280x720."""
    match = re.fullmatch(r"(\d{1,5})[xX](\d{1,5})", text, re.ASCII)
    sides = (int(match[1]), int(match[2])) if match else (0, 0)
    if not all(1 <= side <= MAX_SIDE_PX for side in sides):
        raise argparse.ArgumentTypeError(f"{text!r} is not WIDTHxHEIGHT, 1 to {MAX_SIDE_PX} pixels")
    return sides


def vector(text: str) -> tuple[float, float, float]:
    """(x, y, z) in metres of X,Y,Z."""
    try:
        x, y, z = (float(part) for part in text.split(","))
    except ValueError:
        x = y = z = math.nan
    if any(math.isnan(component) for component in (x, y, z)):
        raise argparse.ArgumentTypeError(f"{text!r} is not X,Y,Z in metres")
    if not all(abs(component) <= MAX_COORDINATE_M for component in (x, y, z)):
        lo, hi = -MAX_COORDINATE_M, MAX_COORDINATE_M
        raise argparse.ArgumentTypeError(f"{text!r}: coordinates are {lo:g} to {hi:g} metres")
    return x, y, z


def whole(lo: int, hi: int) -> Callable[[str], int]:
    """A kind of whole numbers, ``lo`` to ``hi``."""

    def parse_whole(text: str) -> int:
        value = int(text) if re.fullmatch(r"-?\d{1,12}", text, re.ASCII) else None
        if value is None or not lo <= value <= hi:
            raise argparse.ArgumentTypeError(f"{text!r} is not a whole number, {lo} to {hi}")
        return value

    return parse_whole


def frame_span(text: str) -> tuple[int, int]:
    """(first, last + 1) of A:B."""
    match = re.fullmatch(r"(\d{1,7}):(\d{1,7})", text, re.ASCII)
    first, end = (int(match[1]), int(match[2])) if match else (0, 0)
    if not first < end <= MAX_FRAME:
        raise argparse.ArgumentTypeError(f"{text!r} is not A:B with A < B, up to {MAX_FRAME}")
    return first, end


def port(text: str) -> int:
    """A port of this machine."""
    try:
        return whole(0, 65535)(text)
    except argparse.ArgumentTypeError:
        raise argparse.ArgumentTypeError(f"{text!r} is not a port, 0 to 65535") from None


def number(lo: float, hi: float) -> Callable[[str], float]:
    """A kind of finite numbers, ``lo`` to ``hi``."""

    def parse_number(text: str) -> float:
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not lo <= value <= hi:
            raise argparse.ArgumentTypeError(f"{text!r} is not a number, {lo:g} to {hi:g}")
        return value

    return parse_number
