"""Regions of finer or coarser voxels: where each is, and by how much."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
from imgui_bundle import imgui

from elemental.scene.model import FloatArray, Region
from elemental.scene.regions import is_outside
from elemental.scene.volumes import Volume
from elemental.settings import Setting
from elemental.ui import icons
from elemental.ui.document import Document
from elemental.ui.rows import list_height, property_row, vector_row
from elemental.ui.widgets import Widgets

LEVEL = Setting(
    "level_offset", "int", 0, "each level halves a voxel's side, or doubles it below 0",
    lo=-2, hi=2,
)  # fmt: skip
MEANINGS = {-2: "4 x coarser", -1: "2 x coarser", 0: "as the rest", 1: "2 x finer", 2: "4 x finer"}
GIZMOS = ("Move", "Scale")
NEW_SHARE = 0.25
"""Of the scene's longest side, for a new region: two of the eight cells."""
LEAST_SIDE = (1e-3, 1e-5)
"""Of a region: m, and as a part of how far off it is, so that six digits (`_three`) hold it."""

Bounds = tuple[FloatArray, FloatArray]
Corner = npt.NDArray[np.floating]


@dataclass
class RegionView:
    """What the page keeps."""

    chosen: int = 0
    gizmo: str = "Move"


def regions_page(w: Widgets, view: RegionView, document: Document, bounds: Bounds) -> None:
    """Draw the page. ``bounds``: (min, max) of the scene, m."""
    view.chosen = min(view.chosen, max(len(document.state.regions) - 1, 0))
    _list(w, view, document, bounds)
    regions = document.state.regions
    if not regions:
        w.hint("A region has finer or coarser voxels than the rest of the scene. Add one here.")
        return
    if imgui.begin_child("region"):
        _fields(w, view, document, regions[view.chosen])
        if is_outside(regions[view.chosen], bounds):
            w.hint("It lies outside the scene: no effect.")
        w.hint("It takes hold of whole cells, an eighth of the scene's longest side each; the view "
               "'regions' shows them. Where regions overlap, the last one counts.")  # fmt: skip
    imgui.end_child()


def as_box(region: Region, number: int) -> Volume:
    """A region as what outlines and the gizmo are drawn of."""
    low, high = region.minimum.astype(float), region.maximum.astype(float)
    return Volume(
        f"{number}", center=_three((low + high) / 2), size=_three(high - low), blend_radius=0.0
    )


def from_box(box: Volume, level_offset: int) -> Region:
    """The region that a dragged box stands for."""
    center, half = np.array(box.center), np.array(box.size) / 2
    return _region(center - half, center + half, level_offset)


def _list(w: Widgets, view: RegionView, document: Document, bounds: Bounds) -> None:
    regions = document.state.regions
    if w.button(f"{icons.PLUS} Region", "add", help="in the middle of the scene, twice as fine"):
        _add(view, document, _new(bounds))
    w.flow(4.0 * imgui.get_font_size())
    if w.button("Copy", enabled=bool(regions), help="another one like this"):
        _add(view, document, regions[view.chosen])
    w.flow(2.0 * imgui.get_font_size())
    if w.button(icons.TRASH, "delete", bool(regions), "take this region out"):
        left = regions[: view.chosen] + regions[view.chosen + 1 :]
        document.set_regions(left, f"delete region {view.chosen + 1}")
        view.chosen = max(view.chosen - 1, 0)
    regions = document.state.regions
    if not regions:
        return
    if imgui.begin_child("list", imgui.ImVec2(0.0, list_height(len(regions)))):
        for number, region in enumerate(regions):
            label = f"{icons.VOLUME}  {number + 1}: {MEANINGS[region.level_offset]}##{number}"
            if imgui.selectable(label, number == view.chosen)[0]:
                view.chosen = number
            w.note(f"region {number + 1}")
    imgui.end_child()


def _add(view: RegionView, document: Document, region: Region) -> None:
    regions = document.state.regions
    view.chosen = len(regions)
    document.set_regions((*regions, region), "add region")


def _new(bounds: Bounds) -> Region:
    low, high = (corner.astype(float) for corner in bounds)
    half = NEW_SHARE * float((high - low).max()) / 2
    return _region((low + high) / 2 - half, (low + high) / 2 + half, 1)


def _fields(w: Widgets, view: RegionView, document: Document, region: Region) -> None:
    saved_all = document.saved.regions
    saved = saved_all[view.chosen] if view.chosen < len(saved_all) else region
    changed, gesture = region, None
    edit = property_row(w, LEVEL.key, "Level", LEVEL, region.level_offset, saved.level_offset)
    if edit is not None:
        changed, gesture = replace(changed, level_offset=int(edit.value)), edit.gesture
    low, high = _three(region.minimum), _three(region.maximum)
    edit = vector_row(w, "minimum", "Min", low, _three(saved.minimum), unit="m")
    if edit is not None:
        least = np.minimum(edit.value, np.array(high) - _least(high))
        changed, gesture = replace(changed, minimum=_corner(least)), edit.gesture
    edit = vector_row(w, "maximum", "Max", high, _three(saved.maximum), unit="m")
    if edit is not None:
        most = np.maximum(edit.value, np.array(low) + _least(low))
        changed, gesture = replace(changed, maximum=_corner(most)), edit.gesture
    w.row("Gizmo", "what a drag in the picture changes")
    view.gizmo = w.choose("gizmo", view.gizmo, GIZMOS)
    if changed is not region:
        document.set_region(view.chosen, changed, gesture)


def _region(low: Corner, high: Corner, level_offset: int) -> Region:
    low = np.array(_three(low))
    high = np.maximum(_three(high), low + _least(low))
    return Region(_corner(low), _corner(high), level_offset)


def _least(corner: Sequence[float] | Corner) -> float:
    least, share = LEAST_SIDE
    return max(least, share * float(np.abs(corner).max()))


def _corner(vector: Corner) -> FloatArray:
    return np.array(_three(vector), np.float32)


def _three(vector: Corner) -> tuple[float, float, float]:
    x, y, z = (float(f"{part:.6g}") for part in vector)
    return x, y, z
