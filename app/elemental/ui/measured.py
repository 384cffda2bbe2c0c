"""What frames took: averages by pass, and the last frames. Nothing is told before it is known."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from elemental.gpu.timers import PassTiming
from elemental.ui.averages import Averages

HISTORY_FRAMES = 240


@dataclass(frozen=True)
class Times:
    """Averaged times, ms; ``frame`` and ``panel`` are None until one is known."""

    gpu: Mapping[str, float]
    """By pass, in the order of the frame."""
    cpu: Mapping[str, float]
    frame: float | None
    panel: float | None
    history: npt.NDArray[np.float32]
    """Of the last frames, oldest first."""


class Measured:
    """Times of frames and of their passes, ms."""

    def __init__(self) -> None:
        self.gpu, self.cpu = Averages(), Averages()
        self.panel_ms: float | None = None
        """Python and the driver's calls for the panel, in the last frame."""
        self._frame = Averages()
        self._history = np.zeros(HISTORY_FRAMES, np.float32)
        self._known = 0

    @property
    def frame_ms(self) -> float | None:
        """From one frame to the next, averaged; None before the second."""
        return self._frame.values.get("frame")

    @property
    def history(self) -> npt.NDArray[np.float32]:
        """Times from frame to frame, oldest first."""
        return self._history[HISTORY_FRAMES - self._known :]

    def update(self, timings: Sequence[PassTiming], frame_ms: float | None) -> None:
        """Take over the newest times; ``frame_ms`` since the frame before, None for the first."""
        seconds = 1e-3 * (frame_ms or 0.0)
        self.gpu.update([(timing.name, timing.gpu_ms) for timing in timings], seconds)
        self.cpu.update([(timing.name, timing.cpu_ms) for timing in timings], seconds)
        if frame_ms is None:
            return
        self._frame.update([("frame", frame_ms)], seconds)
        self._history[:-1] = self._history[1:]
        self._history[-1] = frame_ms
        self._known = min(self._known + 1, HISTORY_FRAMES)

    def times(self) -> Times:
        """As the timeline shows them."""
        return Times(self.gpu.values, self.cpu.values, self.frame_ms, self.panel_ms, self.history)
