"""Scene time: runs with the wall clock, stops, and steps. No window, no GL."""

from __future__ import annotations

from dataclasses import dataclass

STEP_S = 1 / 60
"""How far ``step`` goes."""
LONGEST_FRAME_S = 0.25
"""A frame that took longer (a compile, a moved window) advances the scene by no more."""


@dataclass
class SceneClock:
    """Seconds of scene time."""

    time_s: float = 0.0
    paused: bool = False

    def advance(self, wall_s: float) -> float:
        """A frame of ``wall_s`` has passed. Returns what cameras may move by, paused or not."""
        frame_s = min(max(wall_s, 0.0), LONGEST_FRAME_S)
        if not self.paused:
            self.time_s += frame_s
        return frame_s

    def toggle(self) -> None:
        """Stop or go on."""
        self.paused = not self.paused

    def step(self) -> None:
        """Stop, one step later."""
        self.paused = True
        self.time_s += STEP_S
