"""Fixtures of the GPU tests."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from elemental.frame import Renderer
from elemental.gpu.device import Device
from elemental.passes.scene_gpu import GpuScene
from elemental.scene.model import Scene
from gpu.artist import HALVES, Artist
from gpu.moving import SETTINGS as MOVING
from gpu.moving import SIZE
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


@pytest.fixture
def renderers(device: Device) -> Iterator[Any]:
    """Maker of renderers that are released after the test."""
    made: list[Renderer] = []

    def make(world: Scene, **settings: Any) -> Renderer:
        made.append(Renderer(device, world, MOVING.replace(settings), SIZE))
        return made[-1]

    yield make
    for renderer in made:
        renderer.release()


@pytest.fixture
def on_device(device: Device) -> Iterator[Any]:
    """Maker of GPU scenes that are released after the test."""
    made: list[GpuScene] = []

    def make(world: Scene) -> GpuScene:
        made.append(GpuScene(device, world))
        return made[-1]

    yield make
    for gpu in made:
        gpu.release()


@pytest.fixture
def artist(tmp_path: Path, device: Device) -> Iterator[Artist]:
    """Whose last word compiles, since all tests share a device."""
    made = Artist(tmp_path / "draft.glsl")
    yield made
    made.save(HALVES + "vec3 displace(MaterialInput m, Parameters p) { return vec3(0.0); }\n")
    device.reload_changed_shaders()
    assert device.library.problems() == []
