"""Dispatches of any size, and work whose size only the GPU knows."""

from __future__ import annotations

import numpy as np
import pytest

from elemental.gpu.binding import GraphError
from elemental.gpu.device import Device
from elemental.gpu.encode import Encoder
from elemental.gpu.formats import R32UI
from glsl.harness import run_glsl
from gpu.sources import Sources

COUNT = 65_535 * 4 + 3
MARKS = 'layout(std430) buffer Marks { uint marks[]; };\n#include "lib/dispatch.glsl"\n'


@pytest.mark.parametrize("count", [1, 4, 5, 65_535 * 4, COUNT, 3 * 65_535 * 4 + 1])
def test_a_long_dispatch_reaches_every_item_once(
    device: Device, sources: Sources, count: int
) -> None:
    shader = sources.compute(
        "uint i = linear_thread_id(); if (i < uint(marks.length())) marks[i] += i;",
        MARKS,
        (4, 1, 1),
    )
    marks = device.buffer("marks", np.ones(count, np.uint32))
    graph = device.begin_frame()
    graph.compute(shader, writes={"Marks": marks}, threads=count)
    graph.execute()
    np.testing.assert_array_equal(marks.read(np.uint32), np.arange(1, count + 1))
    marks.release()


def test_a_long_dispatch_without_the_helper_is_refused(device: Device, sources: Sources) -> None:
    shader = sources.compute(
        "marks[gl_GlobalInvocationID.x] = 1u;",
        "layout(std430) buffer Marks { uint marks[]; };",
        (4, 1, 1),
    )
    marks = device.buffer("marks", 4 * COUNT)
    graph = device.begin_frame()
    with pytest.raises(GraphError, match=r"65536, 1, 1\) groups exceed 65535 .*linear_thread_id"):
        graph.compute(shader, writes={"Marks": marks}, threads=COUNT)
    with pytest.raises(GraphError, match="exceed 65535"):
        graph.compute(shader, writes={"Marks": marks}, groups=(1, 70_000, 1))
    marks.release()


def test_indirect_arguments_of_a_long_dispatch(device: Device) -> None:
    items = np.array([0, 1, 64, 65, 65_535 * 64, 65_535 * 64 + 1, 2**32 - 64], np.uint32)
    x, y, z = run_glsl(
        device, ["lib/dispatch.glsl"], "linear_dispatch_args(items, 64u)", {"items": items}, "uvec3"
    ).T.astype(np.int64)
    assert x.max() <= 65_535
    assert y.max() <= 65_535
    assert (z == 1).all()
    needed = -(-items.astype(np.int64) // 64)
    assert (x * y >= needed).all()
    assert (x * y < needed + y).all()
    assert x[0] * y[0] == 0


def test_appended_items_are_dispatched_indirectly(device: Device, sources: Sources) -> None:
    append = sources.compute(
        "uint i = linear_thread_id(); if (i % 3u == 0u && i < 100u) {"
        " uint at = atomicAdd(count, 1u); items[at] = i; atomicMax(args[0], at / 8u + 1u); }",
        "layout(std430) buffer Queue { uint count; uint items[]; };"
        "layout(std430) buffer Args { uint args[3]; };\n" + MARKS.partition("\n")[2],
    )
    consume = sources.compute(
        "uint i = linear_thread_id(); if (i < count) marks[items[i]] += 1u;"
        " if (gl_LocalInvocationIndex == 0u) atomicAdd(marks[100], 1u);",
        "layout(std430) readonly buffer Queue { uint count; uint items[]; };" + MARKS,
        (8, 1, 1),
    )
    marks = device.buffer("marks", np.zeros(101, np.uint32))
    args = device.buffer("args", 16)
    for repeat in range(1, 3):
        graph = device.begin_frame()
        queue = graph.buffer("queue", 4 * 101)
        graph.clear_buffer(queue)
        graph.clear_buffer(args, 1)
        graph.clear_buffer(args, 0, size=8)
        graph.compute(append, writes={"Queue": queue, "Args": args}, threads=100)
        graph.copy_buffer(args, args, size=4, dst_offset=12)
        reads = {"Queue": queue}
        graph.clear_buffer(args, 1, offset=4, size=8)
        graph.compute(consume, reads=reads, writes={"Marks": marks}, indirect=(args, 0))
        graph.execute()
        counts = marks.read(np.uint32)
        assert counts[:100].tolist() == [repeat if i % 3 == 0 else 0 for i in range(100)]
        assert counts[100] == 5 * repeat  # groups of 8 for 34 items
    marks.release()
    args.release()


def test_draws_from_commands_that_the_gpu_wrote(device: Device, sources: Sources) -> None:
    """Two commands, each with its base instance, from a compute pass of the same frame."""
    build = sources.compute(
        "uint i = gl_GlobalInvocationID.x; if (i < 2u) {"
        " commands[5 * i] = 6u; commands[5 * i + 1] = 1u; commands[5 * i + 2] = 0u;"
        " commands[5 * i + 3] = 0u; commands[5 * i + 4] = i + 1u; }",
        "layout(std430) buffer Commands { uint commands[]; };",
    )
    draw_shader = sources.mesh(
        "in vec2 a_position; in uint a_instance; flat out uint v_instance; void main() {"
        " v_instance = a_instance; float x = a_position.x * 0.5 + float(a_instance) - 1.5;"
        " gl_Position = vec4(x, a_position.y, 0.0, 1.0); }",
        "flat in uint v_instance; out uint o_id; void main() { o_id = v_instance; }",
    )
    corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]], np.float32)
    position = device.buffer("position", corners)
    instance = device.buffer("instance", np.array([9, 1, 2], np.uint32))
    index = device.buffer("index", np.array([0, 1, 2, 0, 2, 3], np.uint32))
    quad = device.vertex_input(
        [(position, "2f", ("a_position",)), (instance, "1u/i", ("a_instance",))], index
    )
    graph = device.begin_frame()
    commands = graph.buffer("commands", 40)
    image = graph.texture("image", (4, 2), R32UI)
    graph.compute(build, writes={"Commands": commands}, threads=2)

    def draw(encoder: Encoder) -> None:
        encoder.draw_indirect(quad, commands, count=2)

    graph.raster(draw_shader, color=image, clear_color=(0, 0, 0, 0), uses=[commands], draw=draw)
    graph.keep(image)
    graph.execute()
    assert image.physical
    assert image.physical.read()[0].tolist() == [1, 1, 2, 2]
    for resource in (quad, position, instance, index):
        resource.release()
