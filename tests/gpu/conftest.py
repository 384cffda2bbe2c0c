"""Fixtures of the GPU tests."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from elemental.gpu.device import Device
from gpu.rig import MakeRig, Rig
from gpu.sources import Sources


@pytest.fixture
def sources(tmp_path: Path) -> Sources:
    """Writer of shader files that live as long as the test."""
    return Sources(tmp_path)


@pytest.fixture
def rig(device: Device) -> Iterator[MakeRig]:
    """Maker of rigs that are released after the test."""
    made = []

    def make(*args: Any, **fields: Any) -> Rig:
        made.append(Rig(device, *args, **fields))
        return made[-1]

    yield make
    for item in made:
        item.release()
