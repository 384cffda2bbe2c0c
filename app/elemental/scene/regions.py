"""Regions of finer or coarser voxels: out of a scene file, and back into it."""

from __future__ import annotations

from collections.abc import Sequence
from difflib import SequenceMatcher
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from elemental.core.errors import InputError
from elemental.scene import toml_edit
from elemental.scene.model import FloatArray, Region
from elemental.scene.scene_file import parse_scene_file
from elemental.scene.tables.regions import RegionTable

CELLS_REACH = 0.571
"""From the scene's middle to the farthest side of its 8^3 cells, in its longest sides: where the
octree has 64 points along the scene, the fewest (`Grid.fit`); with more, cells reach less far."""


def regions_of(tables: Sequence[RegionTable]) -> list[Region]:
    """The regions of a scene file's checked tables."""
    return [
        Region(np.array(table.min, np.float32), np.array(table.max, np.float32), table.level_offset)
        for table in tables
    ]


def is_outside(region: Region, bounds: tuple[FloatArray, FloatArray]) -> bool:
    """Whether a region overlaps none of the 8^3 cells that regions take hold of: they fill a cube
    around the scene, whose bounds are (min, max), m."""
    low, high = (corner.astype(np.float64) for corner in bounds)
    middle, reach = (low + high) / 2, CELLS_REACH * (high - low).max()
    return bool((region.maximum < middle - reach).any() or (region.minimum > middle + reach).any())


def idle_regions(
    regions: Sequence[Region], bounds: tuple[FloatArray, FloatArray], path: Path
) -> list[str]:
    """A line for each region that has no effect."""
    low, high = (", ".join(f"{part:.4g}" for part in corner) for corner in bounds)
    reason = f"has no effect: it lies outside the scene, which reaches from {low} to {high} m"
    return [
        str(InputError(path, f"regions[{number}]", reason))
        for number, region in enumerate(regions)
        if is_outside(region, bounds)
    ]


def with_regions(text: str, regions: Sequence[Region], path: Path) -> str:
    """A scene file's text with these regions in it, comments kept. Raises InputError."""
    before = regions_of(parse_scene_file(text, path).regions)
    wanted = [_table_of(region) for region in regions]
    known = [_table_of(region) for region in before]
    if wanted == known:
        return text
    # The first keeps more comments, and not every layout bears it.
    edits = (
        partial(_merge, before=known, after=wanted),
        partial(toml_edit.replace_tables, name="regions", contents=wanted),
    )
    made = toml_edit.edited_as(text, edits, partial(_reads_as, wanted=wanted, path=path))
    if made is None:
        raise InputError(path, "regions", "can't be changed in this file's layout")
    return made


def _reads_as(text: str, wanted: Sequence[dict[str, Any]], path: Path) -> bool:
    try:
        found = regions_of(parse_scene_file(text, path).regions)
    except InputError:
        return False
    return [_table_of(region) for region in found] == list(wanted)


def _merge(doc: Any, before: Sequence[Any], after: Sequence[Any]) -> None:
    """Change what differs in the tables that are there, drop and append others."""
    tables = doc.get("regions", [])
    matcher = SequenceMatcher(None, [repr(t) for t in before], [repr(t) for t in after])
    gone: list[int] = []
    new: list[Any] = []
    for _, first, end, start, stop in matcher.get_opcodes():
        changed = min(end - first, stop - start)
        for k in range(changed):
            _update(tables[first + k], before[first + k], after[start + k])
        gone += range(first + changed, end)
        new += after[start + changed : stop]
    for number in reversed(gone):
        del tables[number]
    for table in new:
        toml_edit.append_table(doc, "regions", table)
    if not after and "regions" in doc:
        del doc["regions"]


def _update(table: Any, before: dict[str, Any], after: dict[str, Any]) -> None:
    for key, value in after.items():
        if value != before[key]:
            toml_edit.assign(table, key, value)


def _table_of(region: Region) -> dict[str, Any]:
    return {
        "min": _plain(region.minimum),
        "max": _plain(region.maximum),
        "level_offset": region.level_offset,
    }


def _plain(corner: FloatArray) -> list[float]:
    """With the fewest digits that are the same 32-bit numbers."""
    return [float(str(np.float32(part))) for part in corner]
