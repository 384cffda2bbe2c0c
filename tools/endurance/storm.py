"""What changes from frame to frame: everything that a user may turn while the program runs."""

from __future__ import annotations

import ctypes
import gc
import random
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from elemental.core import transforms
from elemental.frame import VIEWS, Renderer
from elemental.gpu.device import Device
from elemental.scene.model import Camera
from elemental.scene.volumes import Volume
from elemental.session import Stage
from elemental.settings import SETTINGS, Setting
from elemental.ui.editor import REOPENING

LARGEST = (48, 32)
"""Width and height of the largest frame, px: a software driver draws thousands of them."""
SMALL = {
    "gi.resolution": (64, 128),
    "gi.diffuse_cones": (9, 36),
    "gi.bounces": (0, 1, 2),
    "gi.memory_budget_mb": (64, 256),
    "shadow.resolution": (256, 512),
}
"""Choices of settings whose whole range would only take time."""
REBUILT_EACH = 50
"""Frames between changes of settings for which parts are made anew."""
REBUILDING = frozenset({*SMALL, "gi.area_lights", "shadow.cascades", "shadow.distance"}) - {
    "gi.diffuse_cones",
    "gi.bounces",
}
REST_FRAMES = 20
"""More than the pool keeps what lies idle, and than the octree takes to settle."""
VIEW_SHARE = 0.1
"""Share of the frames that show another view than the final picture."""


def value_of(setting: Setting, chance: random.Random) -> Any:
    """A value from anywhere in a setting's range, often from its ends."""
    if setting.key in SMALL:
        return chance.choice(SMALL[setting.key])
    if setting.kind == "bool":
        return chance.random() < 0.7
    if setting.kind == "choice":
        return chance.choice(setting.choices)
    if setting.kind == "text":
        return setting.default
    assert setting.lo is not None
    assert setting.hi is not None
    low, high = setting.lo, setting.hi
    if setting.kind == "int":
        return chance.randint(int(low), int(high))

    def number(default: float) -> float:
        return float(chance.choice([low, high, default, chance.uniform(low, high)]))

    if setting.kind == "color":
        return tuple(number(component) for component in setting.default)
    return number(setting.default)


def size_of(chance: random.Random) -> tuple[int, int]:
    """Any size, often of one pixel along an axis."""
    width, height = (chance.choice([1, 2, side, chance.randint(1, side)]) for side in LARGEST)
    return width, height


def volumes_of(chance: random.Random, center: tuple[float, float, float]) -> list[Volume]:
    """None to three volumes around a point."""
    keys = [setting for setting in SETTINGS.values() if setting.volume]
    made = []
    for number in range(chance.randint(0, 3)):
        x, y, z = (c + chance.uniform(-2.0, 2.0) for c in center)
        chosen = chance.sample(keys, chance.randint(0, len(keys)))
        volume = Volume(
            f"v{number}",
            chance.choice(["box", "sphere"]),
            center=(x, y, z),
            rotation_deg=(chance.uniform(0, 360), 0.0, 0.0),
            priority=float(chance.randint(0, 2)),
            blend_weight=chance.random(),
            unbound=chance.random() < 0.3,
            overrides={setting.key: value_of(setting, chance) for setting in chosen},
        )
        made.append(volume)
    return made


@dataclass
class Storm:
    """Frames of one scene; ``seed`` fixes all of them."""

    device: Device
    stage: Stage
    seed: int = 0

    def __post_init__(self) -> None:
        self.renderer = Renderer(self.device, self.stage.scene, self.stage.settings, LARGEST)
        self._live = [s for s in SETTINGS.values() if s.key not in REBUILDING | REOPENING]
        self._rebuilding = [SETTINGS[key] for key in sorted(REBUILDING)]

    def frames(self, count: int) -> Iterator[int]:
        """Draw the first ``count`` frames, each done before the next begins; yields its number."""
        chance = self.chance = random.Random(self.seed)
        self.renderer.set_settings(self.stage.settings)
        low, high = self.stage.scene.bounds()
        for frame in range(count):
            if frame % 5 == 0:
                self.renderer.resize(size_of(chance))
            if frame % 3 == 0:
                self._set(chance.sample(self._live, 6))
            if frame % REBUILT_EACH == REBUILT_EACH - 1:
                self._set(chance.sample(self._rebuilding, 1))
            eye = tuple(
                float(x) for x in np.array([chance.random() for _ in low]) * (high - low) + low
            )
            if frame % 7 == 0:
                self.renderer.scene.volumes = volumes_of(chance, (eye[0], eye[1], eye[2]))
            view = chance.choice(list(VIEWS)) if chance.random() < VIEW_SHARE else "final"
            time_s = frame / 24.0 if chance.random() < 0.95 else chance.uniform(0.0, 100.0)
            self.renderer.render(self._camera(eye), time_s, frame, view)
            self.device.finish()
            yield frame

    def rest(self) -> int:
        """Come back to the first state, in which two storms can be compared.

        What the storm left goes back to the driver in a few frames. Returns the resident bytes.
        """
        self.renderer.scene.volumes = []
        self.renderer.set_settings(self.stage.settings)
        self.renderer.resize(LARGEST)
        for _ in range(REST_FRAMES):
            self.renderer.render(self.stage.camera, 0.0, 0)
            self.device.finish()
        return resident_bytes()

    def release(self) -> None:
        """Free the renderer."""
        self.renderer.release()

    def _set(self, settings: list[Setting]) -> None:
        values = {setting.key: value_of(setting, self.chance) for setting in settings}
        self.renderer.set_settings(self.renderer.settings.replace(values))

    def _camera(self, eye: tuple[float, ...]) -> Camera:
        low, high = self.stage.scene.bounds()
        view_from_world = transforms.look_at(eye, (low + high) / 2)
        return Camera("storm", transforms.inverse(view_from_world), 0.9, 0.05)


def resident_bytes() -> int:
    """Memory of this process that is in RAM, after a collection.

    What the C library keeps for later goes back first, where it is glibc: it depends on what was
    freed last, by tens of MB.
    """
    gc.collect()
    trim = getattr(ctypes.CDLL(None), "malloc_trim", None)
    if trim is not None:
        trim(0)
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * 4096
