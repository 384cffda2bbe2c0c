"""Averages of figures that change every frame."""

from __future__ import annotations

import math

import pytest

from elemental.ui.averages import SETTLE_S, Averages


def test_the_first_figure_is_taken_as_it_is() -> None:
    averages = Averages()
    averages.update([("shade", 3.0)], 0.016)
    assert averages.values == {"shade": 3.0}


def test_an_average_goes_to_a_new_value_at_its_own_pace() -> None:
    once, often = Averages(), Averages()
    for averages in (once, often):
        averages.update([("shade", 0.0)], 0.0)
    once.update([("shade", 1.0)], SETTLE_S)
    for _ in range(100):
        often.update([("shade", 1.0)], SETTLE_S / 100)
    assert once.values["shade"] == pytest.approx(1 - math.exp(-1))
    assert often.values["shade"] == pytest.approx(once.values["shade"])


def test_passes_of_one_name_add_up_and_missing_ones_go() -> None:
    averages = Averages()
    averages.update([("voxelize", 1.0), ("shade", 5.0), ("voxelize", 2.0)], 0.1)
    assert list(averages.values.items()) == [("voxelize", 3.0), ("shade", 5.0)]
    averages.update([("shade", 5.0)], 0.1)
    assert averages.values == {"shade": 5.0}
