# PP-01, PP-02
"""What a frame tells of its graph, and what a whole frame leaves in the pool."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import pytest

from cli.small_scene import write_corner
from elemental.frame import VIEWS, Renderer
from elemental.gpu.device import Device
from elemental.gpu.formats import RGBA8, RGBA16F
from elemental.gpu.graph_report import GraphEdge, GraphReport, GraphResource
from elemental.gpu.shaders import Compute
from elemental.scene.volumes import Volume
from elemental.session import Viewpoint, set_stage
from gpu.sources import Sources

SIZE = (16, 8)
STILL_FRAMES = 4


@pytest.fixture
def copy(sources: Sources) -> Compute:
    """o_image = u_image."""
    return sources.compute(
        "ivec2 at = ivec2(gl_GlobalInvocationID.xy);"
        "imageStore(o_image, at, texelFetch(u_image, at, 0));",
        "uniform sampler2D u_image; layout(rgba16f) writeonly uniform image2D o_image;",
        (8, 8, 1),
    )


def report_of(device: Device, copy: Compute, length: int) -> GraphReport:
    """Cleared, then copied ``length`` times from target to target; one more copy nobody reads."""
    device.report_next_frame()
    g = device.begin_frame()
    image = g.texture("image.0", SIZE, RGBA16F)
    g.clear_texture(image)
    for number in range(1, length + 1):
        target = g.texture(f"image.{number}", like=image)
        reads, writes = {"u_image": image}, {"o_image": target}
        g.compute(copy, f"copy.{number}", reads=reads, writes=writes, threads=SIZE)
        image = target
    unread = g.texture("unread", SIZE, RGBA16F)
    g.compute(copy, "unread", reads={"u_image": image}, writes={"o_image": unread}, threads=SIZE)
    g.keep(image)
    g.execute()
    device.finish()
    assert device.graph_report is not None
    return device.graph_report


def test_passes_edges_and_lifetimes_are_those_of_the_frame(device: Device, copy: Compute) -> None:
    report = report_of(device, copy, 3)
    assert [item.name for item in report.passes] == ["clear image.0", "copy.1", "copy.2", "copy.3"]
    assert [item.kind for item in report.passes] == ["clear", "compute", "compute", "compute"]
    assert report.passes[1].extent == (2, 1, 1)
    assert report.culled == ("unread",)
    names = [resource.name for resource in report.resources]
    assert names == ["image.0", "image.1", "image.2", "image.3"]
    assert report.edges == tuple(GraphEdge(k, k + 1, k) for k in range(3))
    assert [(r.first_pass, r.last_pass) for r in report.resources] == [
        (0, 1),
        (1, 2),
        (2, 3),
        (3, 3),
    ]
    assert [r.kept for r in report.resources] == [False, False, False, True]
    assert {(r.kind, r.size, r.format, r.mips, r.nbytes) for r in report.resources} == {
        ("texture", SIZE, "RGBA16F", 1, 16 * 8 * 8)
    }
    for item, resource in zip(report.passes[1:], report.resources, strict=False):
        assert report.resources[item.reads[0]] is resource


def test_targets_that_never_live_at_once_share_memory(device: Device, copy: Compute) -> None:
    report = report_of(device, copy, 5)
    memory = [resource.memory for resource in report.resources]
    assert len(set(memory)) == 2
    assert all(one != other for one, other in pairwise(memory))
    assert report.transient_bytes == 6 * 16 * 8 * 8
    assert report.shared_bytes == 2 * 16 * 8 * 8


def test_times_are_taken_from_a_frame_of_the_same_passes_alone(
    device: Device, copy: Compute
) -> None:
    report = report_of(device, copy, 2)
    timed = report.with_timings(device.timings)
    assert [p.name for p in timed.passes] == [t.name for t in device.timings]
    assert [p.gpu_ms for p in timed.passes] == [t.gpu_ms for t in device.timings]
    assert report_of(device, copy, 3).with_timings(device.timings[:2]).passes[0].gpu_ms == 0.0


def test_only_frames_that_were_asked_about_are_told(device: Device, copy: Compute) -> None:
    report = report_of(device, copy, 1)
    g = device.begin_frame()
    image = g.texture("other", SIZE, RGBA8)
    g.clear_texture(image)
    g.keep(image)
    g.execute()
    assert device.graph_report is report


def test_the_pool_tells_ages_and_reuses(device: Device, copy: Compute) -> None:
    device.begin_frame()
    device.executor.pool.clear()
    first = report_of(device, copy, 1)
    assert [(held.reuses, held.in_use) for held in first.pool.held] == [(0, False), (0, True)]
    second = report_of(device, copy, 1)
    assert [held.age for held in second.pool.held] == [held.age + 1 for held in first.pool.held]
    assert sum(held.reuses for held in second.pool.held) == 2
    assert second.pool.bytes == sum(held.nbytes for held in second.pool.held)


def of_the_pool(resources: tuple[GraphResource, ...]) -> set[int]:
    return {resource.memory for resource in resources if resource.transient}


@pytest.mark.parametrize("view", ["final", "scene_color", "diffuse_gi", "voxels"])
def test_a_steady_frame_allocates_nothing_and_leaks_no_target(
    device: Device, tmp_path: Path, view: str
) -> None:
    words = ("gi.resolution=64", "shadow.resolution=256")
    stage = set_stage(str(write_corner(tmp_path)), words, Viewpoint(), (40, 30))
    stage.scene.volumes = [Volume("v", unbound=True, overrides={"exposure": 1.0})]
    renderer = Renderer(device, stage.scene, stage.settings, (40, 30))
    pool, seen = device.executor.pool, []
    for frame in range(pool.idle_frames + 2 + STILL_FRAMES):  # what building needed is gone by then
        device.report_next_frame()
        renderer.render(stage.camera, 0.0, frame, view)
        device.finish()
        assert device.graph_report is not None
        assert pool.stats.in_use == 1  # the picture
        told = device.graph_report
        seen.append((pool.stats.allocations, device.bytes(), of_the_pool(told.resources)))
    assert all(state == seen[-1] for state in seen[-STILL_FRAMES:])
    held = {entry.memory for entry in device.graph_report.pool.held}
    assert held == seen[-1][2]  # nothing lies about unused
    assert told.pool.high_water >= told.pool.bytes == sum(e.nbytes for e in told.pool.held)
    renderer.release()
    assert view in VIEWS


def test_an_effect_that_is_off_neither_runs_nor_allocates(device: Device, tmp_path: Path) -> None:
    words = ("gi.resolution=64", "shadow.resolution=256")
    stage = set_stage(str(write_corner(tmp_path)), words, Viewpoint(), (40, 30))
    reports = {}
    for off in ((), ("fxaa.enabled=false",), ("gi.enabled=false",)):
        settings = stage.settings.parse(off, stage.settings)
        renderer = Renderer(device, stage.scene, settings, (40, 30))
        for frame in range(2):
            device.report_next_frame()
            renderer.render(stage.camera, 0.0, frame)
        assert device.graph_report is not None
        reports[off] = device.graph_report
        renderer.release()
    everything, no_fxaa, no_gi = (
        {item.name for item in report.passes} | {r.name for r in report.resources}
        for report in reports.values()
    )
    assert everything - no_fxaa == {"post/fxaa", "fxaa"}
    assert not [name for name in no_gi if name.startswith(("cones", "octree", "specular"))]
