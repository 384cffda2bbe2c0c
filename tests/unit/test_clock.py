"""Scene time in the window."""

from __future__ import annotations

import pytest

from elemental.ui.clock import LONGEST_FRAME_S, STEP_S, SceneClock


def test_it_runs_stops_and_steps() -> None:
    clock = SceneClock()
    assert clock.advance(0.1) == 0.1
    clock.toggle()
    assert clock.advance(0.1) == 0.1  # the camera still moves
    assert clock.time_s == pytest.approx(0.1)
    clock.step()
    assert clock.time_s == pytest.approx(0.1 + STEP_S)
    assert clock.paused
    clock.toggle()
    clock.advance(0.1)
    assert clock.time_s == pytest.approx(0.2 + STEP_S)


@pytest.mark.parametrize(("wall_s", "frame_s"), [(60.0, LONGEST_FRAME_S), (-1.0, 0.0)])
def test_a_hitch_does_not_jump(wall_s: float, frame_s: float) -> None:
    clock = SceneClock()
    assert clock.advance(wall_s) == frame_s
    assert clock.time_s == frame_s
