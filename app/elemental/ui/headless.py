"""The desk without a window: ``elemental shot --ui`` and tests."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from elemental.gpu.device import Device
from elemental.gpu.formats import RGBA8
from elemental.session import Stage
from elemental.ui.desk import Desk, Words
from elemental.ui.gui import HeadlessGui
from elemental.ui.preferences import Preferences

SETTLING_FRAMES = 3
"""At most so many more show a target: which ones there are, and its room, come to be known."""
FRAME_S = 1 / 60
"""The user's time from one frame to the next."""


class HeadlessDesk:
    """A desk on a texture of ``size`` pixels, not a window; by default in its first layout."""

    def __init__(
        self,
        device: Device,
        stage: Stage,
        words: Words,
        size: tuple[int, int],
        *,
        records: bool = False,
        scale: float = 1.0,
        preferences: Preferences | None = None,
    ) -> None:
        self.size = size
        self.canvas = device.texture("panel.canvas", size, RGBA8, category="targets")
        self.desk = Desk(
            device, HeadlessGui(), stage, words, size, preferences or Preferences(scale=scale),
            onto=self.canvas, records=records,
        )  # fmt: skip

    def draw(self) -> None:
        """One frame at the clock's time."""
        self.desk.draw(self.size, FRAME_S)

    def finish(self) -> None:
        """Show what is only known after a frame: its times, messages, a target's picture."""
        for _ in range(SETTLING_FRAMES):
            if not self.desk.observers.lacks_picture:
                break
            self.draw()
        self.desk.tell(self.size)

    def read(self) -> npt.NDArray[Any]:
        """(H, W, 4) uint8 display codes of the last frame, row 0 on top."""
        return np.flipud(self.canvas.read())

    def release(self) -> None:
        """Free everything but the device."""
        self.desk.release()
        self.canvas.release()
