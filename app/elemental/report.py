"""The report of a headless run: what was drawn, by which driver, at what cost.

``Report`` is the schema of the JSON file; a key is never left out. Times are milliseconds, sizes
bytes. ``docs/report.md`` explains it for readers of the file.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, TypedDict

from elemental.core.errors import InputError
from elemental.core.files import atomic_file
from elemental.gpu.device import Device
from elemental.scene.model import Scene
from elemental.settings import Settings

SCHEMA = "elemental.report/1"


class DriverEntry(TypedDict):
    """Who drew it. ``software`` is true for a driver that renders on the CPU."""

    renderer: str
    version: str
    vendor: str
    software: bool


class PassEntry(TypedDict):
    """One pass of the newest frame: time on the GPU and time spent issuing it."""

    name: str
    gpu_ms: float
    cpu_ms: float


class FrameEntry(TypedDict):
    """The newest frame: sums over its passes, and from its first call until the GPU was done."""

    gpu_ms: float
    cpu_ms: float
    wall_ms: float


class BytesEntry(TypedDict):
    """Memory of GPU objects by what they are for; ``total`` is the sum of the others."""

    targets: int
    octree: int
    meshes: int
    textures: int
    other: int
    total: int


class SceneEntry(TypedDict):
    """What was drawn. ``triangles`` counts each instance's."""

    name: str
    file: str
    triangles: int
    instances: int
    lights: int


class Report(TypedDict):
    """The whole report. ``settings`` holds every setting, not only the changed ones."""

    schema: str
    elemental: str
    scene: SceneEntry
    view: str
    size: list[int]
    frames: int
    time_s: float
    seed: int
    settings: dict[str, Any]
    gl: DriverEntry
    passes: list[PassEntry]
    frame: FrameEntry
    counters: dict[str, int]
    bytes: BytesEntry
    gl_messages: list[str]
    warnings: list[str]
    notes: list[str]


def driver_entry(device: Device) -> DriverEntry:
    """The driver's own words."""
    info = device.info
    return {
        "renderer": info.renderer,
        "version": info.version,
        "vendor": info.vendor,
        "software": info.software,
    }


def scene_entry(scene: Scene) -> SceneEntry:
    """The scene's identity and size."""
    return {
        "name": scene.name,
        "file": str(scene.path),
        "triangles": scene.triangle_count,
        "instances": len(scene.instances),
        "lights": len(scene.lights),
    }


def bytes_entry(device: Device) -> BytesEntry:
    """Bytes by category; a category that the schema does not know counts as ``other``."""
    counted = device.bytes()
    entry: BytesEntry = {
        "targets": counted.pop("targets", 0),
        "octree": counted.pop("octree", 0),
        "meshes": counted.pop("meshes", 0),
        "textures": counted.pop("textures", 0),
        "other": sum(counted.values()),
        "total": sum(device.bytes().values()),
    }
    return entry


def settings_entry(settings: Settings) -> dict[str, Any]:
    """Every setting by its key; a colour is a list."""
    return {key: list(v) if isinstance(v, tuple) else v for key, v in settings.items()}


def overflow_warnings(counters: Mapping[str, int]) -> list[str]:
    """One line for each counter of dropped things that is not zero, with what helps."""
    remedies = {
        "octree_bricks_dropped": "; raise gi.memory_budget_mb or lower gi.resolution",
        "octree_levels_dropped": ", since neither budget nor driver hold them; raise "
        "gi.memory_budget_mb or lower gi.resolution",
        "lights_without_shadow": "; raise shadow.budget",
    }
    return [
        f"{count:,} {name.replace('_', ' ')}{remedies.get(name, '')}"
        for name, count in counters.items()
        if count and ("dropped" in name or name in remedies)
    ]


def write_json(path: Path, content: Mapping[str, Any]) -> None:
    """Write JSON whole or not at all; keys keep their order. Raises InputError."""
    text = json.dumps(content, indent=2, allow_nan=False)
    try:
        with atomic_file(path) as temporary:
            temporary.write_text(text + "\n", encoding="utf-8")
    except OSError as error:
        raise InputError(path, "", f"can't be written ({error.strerror})") from error


def say(warnings: Iterable[str], notes: Iterable[str] = ()) -> None:
    """Warnings and notes, a line each, on stderr."""
    for kind, lines in (("warning", warnings), ("note", notes)):
        for line in lines:
            print(f"elemental: {kind}: {' '.join(line.split())}", file=sys.stderr)
