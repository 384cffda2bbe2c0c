"""``elemental list graph``: the passes, edges and targets of one frame. [Mittring12]"""

from __future__ import annotations

from dataclasses import asdict, dataclass, fields, replace
from pathlib import Path
from typing import Any

from elemental import __version__
from elemental.core.text import columns
from elemental.frame import VIEWS, Renderer
from elemental.gpu.graph_report import GraphReport, GraphResource
from elemental.report import driver_entry, say, scene_entry, settings_entry, write_json
from elemental.session import Viewpoint, check_output, headless_device, known_name, set_stage

SCHEMA = "elemental.graph/1"
SETTLING_FRAMES = 3
"""Frames before the one that is told: the first makes the voxels, and pools settle."""
KIB = 1024


@dataclass(frozen=True)
class GraphListing:
    """The words of one ``elemental list graph``; ``size`` in pixels."""

    scene: str | None
    size: tuple[int, int]
    assignments: list[str]
    view: str
    json: Path | None


def list_graph(words: GraphListing) -> list[str]:
    """The lines; the JSON is written too where it is asked for. Raises InputError."""
    known_name("--view", words.view, list(VIEWS))
    if words.json is not None:
        check_output("--json", words.json, (".json",))
    stage = set_stage(words.scene, words.assignments, Viewpoint(), words.size)
    device = headless_device()
    renderer = Renderer(device, stage.scene, stage.settings, words.size)
    for frame in range(SETTLING_FRAMES + 1):
        device.report_next_frame()
        renderer.render(stage.camera_at(0.0), 0.0, frame, words.view)
        device.finish()
    assert device.graph_report is not None, "a report was asked for and a graph has run"
    report = device.graph_report.with_timings(device.timings)
    if words.json is not None:
        head: dict[str, Any] = {
            "schema": SCHEMA,
            "elemental": __version__,
            "scene": scene_entry(stage.scene),
            "view": words.view,
            "size": list(words.size),
            "settings": settings_entry(stage.settings),
            "gl": driver_entry(device),
        }
        write_json(words.json, {**head, **graph_json(report)})
    say(stage.scene.warnings, stage.scene.notes)
    return graph_lines(report)


def graph_json(report: GraphReport) -> dict[str, Any]:
    """The report as JSON has it; numbers of passes and resources are places in their lists."""
    bare = replace(report, pool=replace(report.pool, held=()))  # descriptions are not copied
    content = asdict(bare)
    content["pool"]["held"] = [
        {
            **{f.name: getattr(held, f.name) for f in fields(held)},
            "description": repr(held.description),
        }
        for held in report.pool.held
    ]
    content["transient_bytes"] = report.transient_bytes
    content["shared_bytes"] = report.shared_bytes
    return content


def graph_lines(report: GraphReport) -> list[str]:
    """Tables of passes and of resources, and a line on the pool."""
    pool = report.pool
    return [
        *_passes(report),
        "",
        *_resources(report),
        "",
        f"not needed: {', '.join(report.culled) or 'none'}",
        f"edges: {len(report.edges)}; sums: {sum(p.gpu_ms for p in report.passes):.2f} ms GPU, "
        f"{sum(p.cpu_ms for p in report.passes):.2f} ms CPU",
        f"targets: {_kib(report.transient_bytes)} in {_kib(report.shared_bytes)} of memory",
        f"pool: {_kib(pool.bytes)} held, {_kib(pool.high_water)} at most, {pool.allocations} "
        f"allocations, {pool.reuses} reuses, {pool.freed} freed",
    ]


def _passes(report: GraphReport) -> list[str]:
    """Each pass with the passes it waits for."""
    before: dict[int, set[int]] = {}
    for edge in report.edges:
        before.setdefault(edge.consumer, set()).add(edge.producer)
    rows = [("#", "pass", "kind", "extent", "GPU ms", "CPU ms", "after", "writes")]
    for number, item in enumerate(report.passes):
        rows.append(
            (
                str(number),
                item.name,
                item.kind,
                "x".join(map(str, item.extent)),
                f"{item.gpu_ms:.3f}",
                f"{item.cpu_ms:.3f}",
                ",".join(map(str, sorted(before.get(number, ())))),
                ", ".join(report.resources[k].name for k in item.writes),
            )
        )
    return columns(rows, right=(0, 4, 5))


def _resources(report: GraphReport) -> list[str]:
    """The pool's first, in the order of their birth; then what outlives the frame."""
    places = {m: k for k, m in enumerate(dict.fromkeys(
        r.memory for r in report.resources if r.transient
    ))}  # fmt: skip
    rows = [("target", "size", "format", "mips", "size KiB", "passes", "memory")]
    for resource in sorted(report.resources, key=lambda r: (not r.transient, r.first_pass)):
        last = "kept" if resource.kept else str(resource.last_pass)
        rows.append(
            (
                resource.name,
                _size(resource),
                resource.format or "buffer",
                str(resource.mips) if resource.kind == "texture" else "",
                f"{resource.nbytes / KIB:,.1f}",
                f"{resource.first_pass}-{last}",
                f"pool {places[resource.memory]}" if resource.transient else "own",
            )
        )
    return columns(rows, right=(3, 4))


def _size(resource: GraphResource) -> str:
    text = "x".join(map(str, resource.size))
    layered = len(resource.size) == 2 and resource.layers > 1
    return f"{text} ({resource.layers})" if layered else text


def _kib(nbytes: int) -> str:
    return f"{nbytes / KIB:,.0f} KiB"
