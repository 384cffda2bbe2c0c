# GI-04
"""The lists of triangles leave out only what the rasterizer would not have drawn."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from elemental.passes import triangle_lists
from gpu.rig import IDENTITY, scene, vector
from gpu.voxel.scenes import jumble, part, turned
from gpu.voxel.stage import MakeStage, Stage
from shapes import sphere

Array = npt.NDArray[Any]


def queue(stage: Stage) -> Array:
    """The fragments, sorted."""
    words = np.ascontiguousarray(stage.fragments).view(np.uint32).reshape(-1, 4)
    return words[np.lexsort(words.T)]


def listed(stage: Stage) -> Array:
    """(3, instances) triangles that the views draw."""
    lists = stage.gpu.lists
    counts = lists.commands.read(np.uint32).reshape(-1, 5)[:, 0] // 3
    return counts.reshape(-1, lists.instances)


def test_lists_give_the_fragments_of_all_triangles(
    stage: MakeStage, jumbled: Stage, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert jumbled.gpu.lists.selects
    monkeypatch.setattr(triangle_lists, "TRIANGLES_MAX", 0)
    whole = stage(jumble())
    assert not whole.gpu.lists.selects
    assert np.array_equal(queue(jumbled), queue(whole))
    assert listed(jumbled).max(axis=0).sum() < listed(whole).sum()


def test_triangles_smaller_than_voxels_are_mostly_left_out(stage: MakeStage) -> None:
    """Two spheres, turned against each other, of triangles a third of a voxel long."""
    shape = sphere(rings=96)
    turn = turned(vector(0.31, 0.9, 0.2), 0.7, to=(3, 0, 0))
    made = stage(scene(part(shape, 0, IDENTITY), part(shape, 0, turn)), bounces=0)
    triangles = len(shape[1]) // 3
    assert (listed(made) > 0.02 * triangles).all()
    assert (listed(made) < 0.3 * triangles).all()
    # Each line that meets a sphere crosses it twice.
    crossings = 2 * np.pi / made.own_grid.voxel_m**2
    assert made.counts.fragments == pytest.approx(2 * 3 * crossings, rel=0.05)
