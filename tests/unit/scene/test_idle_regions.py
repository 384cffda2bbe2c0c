"""GI-01: which regions are said to have no effect."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from elemental.passes.voxel.grid import Grid
from elemental.scene.model import Region
from elemental.scene.regions import idle_regions, is_outside

FLAT = (np.zeros(3, np.float32), np.array([1.0, 0.1, 1.0], np.float32))


def high_region(low_y: float) -> Region:
    """Over all of `FLAT`, from a height on."""
    return Region(np.array([0, low_y, 0], np.float32), np.array([1, 11, 1], np.float32), -1)


@pytest.mark.parametrize("low_y", np.linspace(0.0, 1.0, 41))
def test_a_region_is_outside_where_it_changes_no_cell(low_y: float) -> None:
    region = high_region(low_y)
    grids = [Grid.fit(FLAT, 512, (region,), finest) for finest in range(6, 10)]
    assert is_outside(region, FLAT) == all(grid.one_leaf_level for grid in grids)


def test_a_region_over_a_flat_scene_is_warned_of_beyond_its_cells(tmp_path: Path) -> None:
    near, far = high_region(0.102), high_region(0.8)
    assert not Grid.fit(FLAT, 64, (near,)).one_leaf_level
    [told] = idle_regions((near, far), FLAT, tmp_path / "scene.toml")
    assert "regions[1]: has no effect: it lies outside the scene" in told
