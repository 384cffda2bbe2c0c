"""GI-01: what a dragged box makes of a region."""

from __future__ import annotations

import numpy as np
import pytest

from elemental.scene.volumes import Volume
from elemental.ui.panel.regions import as_box, from_box


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("far", [1000.0, 1999.996, 9999.99, 1e4, 99999.95, 1e5, 123456.5])
def test_a_flat_box_far_off_makes_a_region_with_sides(far: float, sign: int) -> None:
    box = Volume("1", center=(sign * far, 0.5, 0.5), size=(0.0, 1.0, 1.0), blend_radius=0.0)
    for _ in range(3):  # as drags go on
        region = from_box(box, 1)
        assert region.level_offset == 1
        assert (region.minimum < region.maximum).all()
        np.testing.assert_allclose(region.maximum[0], sign * far, rtol=3e-5)
        box = as_box(region, 1)
