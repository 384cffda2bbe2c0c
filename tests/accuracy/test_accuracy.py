"""Seven scenes are as near to the path tracer's picture as they once were, or nearer."""

# GI-07, GI-12, GI-13, GI-15: light that bounces six times, of lamps, suns and skies
# SH-06: what glass shows, bends and mirrors

from __future__ import annotations

import numpy as np
import pytest

from accuracy.ratchet import CASES, SLACK, draw, figures, reached, read_reference, worse
from elemental.gpu.device import Device


@pytest.mark.parametrize("name", CASES)
def test_the_picture_is_no_farther_from_the_path_tracers(device: Device, name: str) -> None:
    case = CASES[name]
    now = figures(draw(device, case), *read_reference(case.file))
    print(name, {key: round(value, 4) for key, value in now.items()})
    found = worse(now, reached()["cases"][name])
    assert not found, f"{name}: {'; '.join(found)}. On purpose: tools/update_accuracy.py"


def test_a_picture_that_is_its_reference_is_off_by_nothing() -> None:
    reference, mask = read_reference(CASES["cornell_box"].file)
    assert mask.min() == 0.0
    assert mask.mean() > 0.9
    same = figures(reference, reference, mask)
    assert max(map(abs, same.values())) < 1e-6
    assert worse(same, dict.fromkeys(SLACK, 0.0)) == []


def test_a_darker_picture_is_worse_in_every_figure() -> None:
    reference, mask = read_reference(CASES["grate"].file)
    dim = figures((0.9 * reference).astype(np.float32), reference, mask)
    assert dim["energy"] == pytest.approx(-0.1, abs=1e-3)
    assert dim["p50"] == pytest.approx(0.1, abs=1e-3)
    assert len(worse(dim, dict.fromkeys(SLACK, 0.0))) == len(SLACK)


def test_a_figure_that_is_not_a_number_is_worse() -> None:
    broken = dict.fromkeys(SLACK, float("nan"))
    assert len(worse(broken, dict.fromkeys(SLACK, 1.0))) == len(SLACK)
