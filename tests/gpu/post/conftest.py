"""The darkroom, emptied after each test."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import pytest

from elemental.gpu.device import Device
from gpu.post.darkroom import Darkroom

MakeDarkroom = Callable[..., Darkroom]


@pytest.fixture
def darkroom(device: Device) -> Iterator[MakeDarkroom]:
    """``darkroom(exposure=1.0, bloom__intensity=0.0)``: settings over those of PLAIN."""
    made: list[Darkroom] = []

    def make(**settings: Any) -> Darkroom:
        made.append(Darkroom(device, **settings))
        return made[-1]

    yield make
    for room in made:
        room.history.release()
