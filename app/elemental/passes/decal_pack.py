"""Decals as the arrays that the GPU reads, in the order of their draws; no GL here."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import groupby
from typing import Any

import numpy as np
import numpy.typing as npt

from elemental.core import transforms
from elemental.core.layout import layouts, pack_array
from elemental.passes.material_pack import draw_state
from elemental.passes.scene_pack import Batch
from elemental.scene.decals import CHANNELS
from elemental.scene.model import Scene

Array = npt.NDArray[Any]

LEAST_FADE = 1e-3
"""Least difference of cosines over which a decal fades out: keeps the slope finite."""


@dataclass(frozen=True)
class DecalRun:
    """Decals `first` .. first + count in draw order, of one material."""

    batch: Batch
    first: int
    count: int


def pack_decals(scene: Scene) -> Array:
    """(decals,) of the GLSL struct Decal, in the scene's order."""
    decals = scene.decals
    matrices = [decal.world_from_decal for decal in decals]
    ends = [math.cos(decal.fade_end) for decal in decals]
    begins = [math.cos(decal.fade_begin) for decal in decals]
    return pack_array(
        layouts().struct("Decal"),
        len(decals),
        decal_from_world=[transforms.inverse(matrix) for matrix in matrices],
        world_from_decal=matrices,
        material=[decal.material for decal in decals],
        channels=[_channels(decal.channels) for decal in decals],
        opacity=[decal.opacity for decal in decals],
        fade_end=ends,
        fade_scale=[1.0 / max(b - e, LEAST_FADE) for b, e in zip(begins, ends, strict=True)],
    )


def _channels(names: tuple[str, ...]) -> int:
    constant = layouts().constant
    return sum(int(constant(f"DECAL_{name.upper()}")) for name in CHANNELS if name in names)


def decal_boxes(scene: Scene) -> tuple[Array, Array]:
    """(low, high), each (decals, 3) m, of every decal's world box."""
    matrices = np.array([decal.world_from_decal for decal in scene.decals], np.float64)
    reach = 0.5 * np.abs(matrices[:, :3, :3]).sum(axis=2)
    center = matrices[:, :3, 3]
    return center - reach, center + reach


def draw_order(scene: Scene) -> list[int]:
    """Decal numbers, the lowest first: by `order`, then by material, then as they stand."""
    decals = scene.decals
    first: dict[tuple[int, int], int] = {}
    for number, decal in enumerate(decals):
        first.setdefault((decal.order, decal.material), number)
    keys = [(d.order, first[d.order, d.material], n) for n, d in enumerate(decals)]
    return sorted(range(len(decals)), key=keys.__getitem__)


def runs_of(scene: Scene, order: list[int]) -> list[DecalRun]:
    """The draws of decals in their order: neighbours of one order and material share one."""
    runs = []
    drawn = 0
    decals = scene.decals
    for (_, material), numbers in groupby(order, lambda n: (decals[n].order, decals[n].material)):
        count = len(list(numbers))
        _, double_sided, textures, transforms_uv, _, own = draw_state(scene.materials[material])
        batch = Batch(
            first=drawn,
            count=count,
            alpha_mode="blend",
            dynamic=False,
            receives_decals=False,
            double_sided=double_sided,
            textures=textures,
            uv_transforms=transforms_uv,
            definition=scene.materials[material].definition,
            own_textures=own,
            instance=-1,
        )
        runs.append(DecalRun(batch, drawn, count))
        drawn += count
    return runs
