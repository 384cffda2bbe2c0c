# PP-01, PP-02
"""What frames that declare alike share, and what a steady frame costs in Python.

The cost is counted in calls, since clocks differ from machine to machine.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from cli.small_scene import write_corner
from elemental.frame import Renderer
from elemental.gpu import execute
from elemental.gpu import graph as graphs
from elemental.gpu.device import Device
from elemental.gpu.formats import R32F
from elemental.gpu.graph import GraphError
from elemental.gpu.refs import AnyTexture, Mip, TextureHandle
from elemental.gpu.shaders import Compute
from elemental.session import Viewpoint, set_stage
from frame_graph_cost import Workload
from gpu.sources import Sources

CALLS_A_PASS = 75
"""Python and C functions called for a pass of tools/frame_graph_cost.py, declared and run: 62 with
Python 3.11, and 160 where each frame is bound and planned anew."""
CALLS_A_PASS_OF_A_FRAME = 110
"""The same of a whole frame, with what computes the passes' arguments: 90, and 151."""
SIZE = (64, 36)


@pytest.fixture
def made(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """What was worked out anew since: "plan", "uses"."""
    seen: list[str] = []

    class FramePlan(execute.FramePlan):
        def __init__(self, *arguments: Any) -> None:
            seen.append("plan")
            super().__init__(*arguments)

    class Uses(graphs.Uses):
        __slots__ = ()

        def __init__(self, *arguments: Any) -> None:
            seen.append("uses")
            super().__init__(*arguments)

    monkeypatch.setattr(execute, "FramePlan", FramePlan)
    monkeypatch.setattr(graphs, "Uses", Uses)
    return seen


@pytest.fixture
def one_more(sources: Sources) -> Compute:
    """o_image = u_image + 1."""
    return sources.compute(
        "ivec2 p = ivec2(gl_GlobalInvocationID.xy);"
        "imageStore(o_image, p, imageLoad(u_image, p) + 1.0);",
        "layout(r32f) readonly uniform image2D u_image;"
        "layout(r32f) writeonly uniform image2D o_image;",
        local=(1, 1, 1),
    )


def counted_up(
    device: Device, one_more: Compute, length: int, start: AnyTexture | None = None, side: int = 4
) -> TextureHandle:
    """A frame of `length` passes from `start` on, else from a cleared target."""
    graph = device.begin_frame()
    image = start
    if image is None:
        image = graph.texture("start", (side, side), R32F)
        graph.clear_texture(image)
    for _ in range(length):
        target = graph.texture("next", like=image)
        reads, writes = {"u_image": image}, {"o_image": target}
        graph.compute(one_more, reads=reads, writes=writes, threads=(side, side))
        image = target
    assert isinstance(image, TextureHandle)
    graph.keep(image)
    graph.execute()
    return image


def value(image: TextureHandle) -> float:
    """What all its texels are."""
    assert image.physical is not None
    texels = image.physical.read()
    assert (texels == texels[0, 0]).all()
    return float(texels[0, 0])


def test_frames_alike_share_one_plan_and_others_have_their_own(
    device: Device, one_more: Compute, made: list[str]
) -> None:
    assert value(counted_up(device, one_more, 3)) == 3
    assert made == ["uses", "uses", "uses", "uses", "plan"]
    made.clear()
    assert value(counted_up(device, one_more, 3)) == 3
    assert made == []
    assert value(counted_up(device, one_more, 5)) == 5
    assert made == ["uses", "uses", "plan"]
    made.clear()
    assert [value(counted_up(device, one_more, n)) for n in (3, 5, 3)] == [3, 5, 3]
    assert made == []
    assert value(counted_up(device, one_more, 3, side=8)) == 3
    assert made.count("plan") == 1


def test_handles_of_a_known_frame_may_get_other_targets(
    device: Device, one_more: Compute, made: list[str]
) -> None:
    first = counted_up(device, one_more, 3).physical
    for _ in range(3):
        device.begin_frame()
        device.executor.pool.clear()
        made.clear()
        image = counted_up(device, one_more, 3)
        assert value(image) == 3
        assert image.physical is not first
        assert made == []


def test_a_texture_that_was_made_anew_is_the_one_that_is_read(
    device: Device, one_more: Compute
) -> None:
    for number in range(4):
        start = device.texture("start", (4, 4), R32F, data=np.full((4, 4), number, np.float32))
        assert value(counted_up(device, one_more, 2, start)) == number + 2
        start.release()


def test_a_part_of_a_texture_is_told_from_its_other_parts(
    device: Device, one_more: Compute
) -> None:
    levels = device.texture("levels", (4, 4), R32F, mips=2)
    for number, level in enumerate((0, 1, 0, 1)):
        graph = device.begin_frame()
        graph.clear_texture(levels, (float(number),))
        target = graph.texture("target", (2, 2), R32F)
        reads, writes = {"u_image": target}, {"o_image": Mip(levels, level)}
        graph.clear_texture(target, (10.0,))
        graph.compute(one_more, reads=reads, writes=writes, threads=(2, 2))
        graph.execute()
        assert levels.read(level)[0, 0] == 11
        assert levels.read(1 - level).max() == number
    levels.release()


def test_an_edited_shader_is_bound_by_its_own_names(device: Device, one_more: Compute) -> None:
    assert value(counted_up(device, one_more, 2)) == 2
    path = Path(one_more.stages[0][1])
    edited = path.read_text().replace("+ 1.0", "+ 2.0")
    first, second = "uniform image2D u_image;", "uniform image2D o_image;"
    head, _, tail = edited.partition(f"layout(r32f) readonly {first}")
    path.write_text(f"{head}{tail}".replace(second, f"{second} layout(r32f) readonly {first}"))
    assert device.reload_changed_shaders() == []
    assert value(counted_up(device, one_more, 2)) == 4


def test_a_handle_of_an_earlier_frame_is_refused(device: Device, one_more: Compute) -> None:
    stale = counted_up(device, one_more, 1)
    graph = device.begin_frame()
    target = graph.texture("target", (4, 4), R32F)
    with pytest.raises(GraphError, match="'next' is no resource of this frame"):
        graph.compute(
            one_more, reads={"u_image": stale}, writes={"o_image": target}, threads=(4, 4)
        )


def test_nor_is_it_taken_where_its_pass_is_known(device: Device, one_more: Compute) -> None:
    graph = device.begin_frame()
    image = graph.texture("image", (4, 4), R32F)
    graph.clear_texture(image)
    graph.keep(image)
    graph.execute()
    graph = device.begin_frame()
    graph.clear_texture(image)
    graph.kept.append(image)
    with pytest.raises(GraphError, match="'image' is no resource of this frame"):
        graph.execute()


def test_passes_are_debug_groups_where_somebody_looks_on(
    device: Device, one_more: Compute, monkeypatch: pytest.MonkeyPatch
) -> None:
    pushed: list[str] = []
    push = device.executor._push
    monkeypatch.setattr(device.executor, "_push", lambda name: (pushed.append(name), push(name)))
    counted_up(device, one_more, 1)
    assert pushed == ["clear start", one_more.name]
    monkeypatch.setattr(device, "names_passes", False)
    assert value(counted_up(device, one_more, 1)) == 1
    assert len(pushed) == 2


def calls(run: Callable[[], Any]) -> int:
    """How many functions ``run`` calls, those that they call included."""
    seen = 0

    def count(_frame: object, event: str, _argument: object) -> None:
        nonlocal seen
        seen += event in {"call", "c_call"}

    sys.setprofile(count)
    try:
        run()
    finally:
        sys.setprofile(None)
    return seen


@pytest.fixture
def unwatched(device: Device) -> Iterator[Device]:
    """The device as artists have it: no debug group around each pass."""
    device.names_passes = False
    yield device
    device.names_passes = True


def test_a_pass_of_a_steady_frame_calls_few_functions(unwatched: Device, tmp_path: Path) -> None:
    counted = []
    for passes in (20, 60):
        workload = Workload(unwatched, tmp_path, passes)
        for _ in range(3):
            workload.declare().execute()
        counted.append(calls(lambda workload=workload: workload.declare().execute()))
        workload.values.release()
    assert (counted[1] - counted[0]) / 40 < CALLS_A_PASS


def test_a_steady_frame_is_not_planned_and_calls_few_functions(
    unwatched: Device, tmp_path: Path, made: list[str]
) -> None:
    stage = set_stage(str(write_corner(tmp_path)), ("gi.resolution=64",), Viewpoint(), SIZE)
    renderer = Renderer(unwatched, stage.scene, stage.settings, SIZE)
    for frame in range(6):
        renderer.render(stage.camera, 0.0, frame)
        unwatched.finish()
    made.clear()
    counted = [calls(lambda n=n: renderer.render(stage.camera, 0.0, n)) for n in range(6, 9)]
    unwatched.finish()
    assert made == []
    assert min(counted) / len(unwatched.timings) < CALLS_A_PASS_OF_A_FRAME
    renderer.release()
