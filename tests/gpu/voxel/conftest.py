"""Fixtures of the octree's tests."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from elemental.gpu.device import Device
from gpu.voxel.scenes import jumble
from gpu.voxel.stage import MakeStage, Stage


@pytest.fixture
def stage(device: Device) -> Iterator[MakeStage]:
    """Maker of stages that are released after the test."""
    made = []

    def make(*args: Any, **fields: Any) -> Stage:
        made.append(Stage(device, *args, **fields))
        return made[-1]

    yield make
    for item in made:
        item.release()


@pytest.fixture(scope="package")
def jumbled(device: Device) -> Iterator[Stage]:
    """Bodies of several shapes, colours and brightnesses at 64^3. Not to be changed."""
    made = Stage(device, jumble())
    yield made
    made.release()
