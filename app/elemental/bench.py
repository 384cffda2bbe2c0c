"""``elemental bench``: frames from one camera, timed pass by pass."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypedDict

import numpy as np
from rich.console import Console
from rich.measure import Measurement
from rich.table import Table

from elemental import __version__
from elemental.frame import Renderer
from elemental.gpu.device import Device
from elemental.report import (
    BytesEntry,
    DriverEntry,
    SceneEntry,
    bytes_entry,
    driver_entry,
    overflow_warnings,
    say,
    scene_entry,
    settings_entry,
    write_json,
)
from elemental.scene.model import Camera
from elemental.session import Viewpoint, check_output, headless_device, set_stage

SCHEMA = "elemental.bench/1"
WIDEST_TABLE = 1000
"""Columns of text that a table may take where no terminal bounds it."""


@dataclass(frozen=True)
class Bench:
    """The words of one ``elemental bench``; ``size`` in pixels, ``time`` in s, ``fps`` in 1/s.

    What moves in the scene starts at ``time`` and goes on by 1/``fps`` a frame, the warm-up among
    them; with 0 it stands.
    """

    scene: str | None
    size: tuple[int, int]
    frames: int
    warmup: int
    rebuild: str
    time: float
    fps: float
    assignments: list[str]
    json: Path | None


class Spread(TypedDict):
    """How a time in ms spreads over the measured frames."""

    median: float
    min: float
    p95: float


class PassSpread(TypedDict):
    """One pass: GPU and issuing time over the measured frames that ran it."""

    name: str
    frames: int
    gpu_ms: Spread
    cpu_ms: Spread


class BenchReport(TypedDict):
    """The JSON of a benchmark. ``frame_wall_ms`` is until the GPU was done with the frame."""

    schema: str
    elemental: str
    scene: SceneEntry
    gl: DriverEntry
    size: list[int]
    frames: int
    warmup: int
    rebuild: str
    time_s: float
    fps: float
    settings: dict[str, object]
    passes: list[PassSpread]
    frame_wall_ms: Spread
    frame_gpu_ms: Spread
    frame_cpu_ms: Spread
    counters: dict[str, int]
    bytes: BytesEntry


def spread(samples_ms: Sequence[float]) -> Spread:
    """Median, minimum and 95th percentile of times in ms; zeros where there is none."""
    if not samples_ms:
        return {"median": 0.0, "min": 0.0, "p95": 0.0}
    median, low, high = np.percentile(np.asarray(samples_ms), [50, 0, 95])
    return {"median": float(median), "min": float(low), "p95": float(high)}


@dataclass
class Samples:
    """Times in ms of the measured frames, one list entry a frame that ran the pass."""

    gpu: dict[str, list[float]]
    cpu: dict[str, list[float]]
    frame_gpu: list[float]
    frame_wall: list[float]
    frame_cpu: list[float]

    def passes(self) -> list[PassSpread]:
        """The passes in the order of their first run."""
        return [
            {"name": n, "frames": len(t), "gpu_ms": spread(t), "cpu_ms": spread(self.cpu[n])}
            for n, t in self.gpu.items()
        ]


def time_of(bench: Bench, frame: int) -> float:
    """Scene time of a frame in s."""
    return bench.time + (frame / bench.fps if bench.fps > 0.0 else 0.0)


def measure(renderer: Renderer, device: Device, camera: Camera, bench: Bench) -> Samples:
    """Render the warm-up, then time ``bench.frames`` frames, each until the GPU is done.

    ``frame_cpu`` is the time of ``Renderer.render`` alone: what Python and the driver spend before
    the GPU is waited for. On a driver that renders on the CPU the two overlap.
    """
    samples = Samples({}, {}, [], [], [])
    for index in range(bench.warmup + bench.frames):
        if bench.rebuild != "none":
            renderer.invalidate(bench.rebuild)
        began = time.perf_counter()
        renderer.render(camera, time_of(bench, index), index)
        issued = time.perf_counter()
        device.ctx.finish()
        done = time.perf_counter()
        device.finish()
        if index >= bench.warmup:
            samples.frame_cpu.append(1e3 * (issued - began))
            samples.frame_wall.append(1e3 * (done - began))
            _collect(samples, device)
    return samples


def _collect(samples: Samples, device: Device) -> None:
    samples.frame_gpu.append(sum(timing.gpu_ms for timing in device.timings))
    for timing in device.timings:
        samples.gpu.setdefault(timing.name, []).append(timing.gpu_ms)
        samples.cpu.setdefault(timing.name, []).append(timing.cpu_ms)


def bench(words: Bench) -> None:
    """Measure, print the table, write the JSON. Raises InputError before anything is rendered."""
    if words.json is not None:
        check_output("--json", words.json, (".json",))
    stage = set_stage(words.scene, words.assignments, Viewpoint(), words.size)
    device = headless_device()
    renderer = Renderer(device, stage.scene, stage.settings, words.size)
    camera, last = stage.camera_at(words.time), words.warmup + words.frames
    samples = measure(renderer, device, camera, words)
    frame = renderer.render(camera, time_of(words, last), last)
    device.finish()
    counters = {name: int(count) for name, count in frame.counters.items()}
    report: BenchReport = {
        "schema": SCHEMA,
        "elemental": __version__,
        "scene": scene_entry(stage.scene),
        "gl": driver_entry(device),
        "size": list(words.size),
        "frames": words.frames,
        "warmup": words.warmup,
        "rebuild": words.rebuild,
        "time_s": words.time,
        "fps": words.fps,
        "settings": settings_entry(stage.settings),
        "passes": samples.passes(),
        "frame_wall_ms": spread(samples.frame_wall),
        "frame_gpu_ms": spread(samples.frame_gpu),
        "frame_cpu_ms": spread(samples.frame_cpu),
        "counters": counters,
        "bytes": bytes_entry(device),
    }
    if words.json is not None:
        write_json(words.json, report)
    problems = [*renderer.problems(), *overflow_warnings(counters)]
    say(stage.scene.warnings + problems, stage.scene.notes)
    print_tables(report, Console())


def print_tables(report: BenchReport, console: Console) -> None:
    """The figures as a table: one line a pass, then the frame, counters and bytes."""
    width, height = report["size"]
    title = f"{report['scene']['name']}, {width}x{height}, {report['frames']} frames"
    table = Table(title=title, caption=report["gl"]["renderer"], show_footer=False)
    table.add_column("pass", no_wrap=True)
    for heading in ("GPU median", "min", "p95", "CPU median", "frames"):
        table.add_column(heading + (" ms" if heading != "frames" else ""), justify="right")
    for entry in report["passes"]:
        cpu = f"{entry['cpu_ms']['median']:.3f}"
        table.add_row(entry["name"], *_cells(entry["gpu_ms"]), cpu, str(entry["frames"]))
    table.add_section()
    cpu = f"{report['frame_cpu_ms']['median']:.3f}"
    measured = str(report["frames"])
    table.add_row("all passes", *_cells(report["frame_gpu_ms"]), cpu, measured)
    table.add_row("frame, wall clock", *_cells(report["frame_wall_ms"]), "", measured)
    if not console.is_terminal:  # in a file or a pipe nothing is too wide
        unbounded = console.options.update(max_width=WIDEST_TABLE)
        console.width = max(console.width, Measurement.get(console, unbounded, table).maximum)
    console.print(table)
    for name, count in report["counters"].items():
        console.print(f"{name}: {count:,}")
    mebibytes: Mapping[str, int] = {k: v for k, v in report["bytes"].items() if isinstance(v, int)}
    line = ", ".join(f"{k} {v / 2**20:.1f} MiB" for k, v in mebibytes.items())
    console.print(line, soft_wrap=True)


def _cells(times: Spread) -> tuple[str, str, str]:
    return f"{times['median']:.3f}", f"{times['min']:.3f}", f"{times['p95']:.3f}"
