"""The frame graph on a driver: names, order, pooling, parameters, errors. PP-01, PP-02"""

from __future__ import annotations

import numpy as np
import pytest

from elemental.core.layout import layouts, pack
from elemental.gpu import gl as c
from elemental.gpu.binding import GraphError
from elemental.gpu.device import Device
from elemental.gpu.formats import R32F, R32UI, RGBA8, RGBA16F, RGBA32F
from elemental.gpu.graph import Graph
from elemental.gpu.plan import PlanError
from elemental.gpu.refs import Sampled, TextureHandle
from elemental.gpu.shaders import Compute, Raster, ShaderError
from gpu.sources import Sources

STORE = "layout(rgba16f) writeonly uniform image2D o_image;"
LOCAL = (8, 8, 1)


@pytest.fixture
def fill(sources: Sources) -> Compute:
    """Stores (0.25, 0.5, 0.75, 1) in o_image."""
    return sources.compute(
        "imageStore(o_image, ivec2(gl_GlobalInvocationID.xy), vec4(0.25, 0.5, 0.75, 1.0));",
        STORE,
        LOCAL,
    )


@pytest.fixture
def double(sources: Sources) -> Raster:
    """Draws twice u_image."""
    return sources.full_screen(
        "o_color = 2.0 * texture(u_image, v_uv);",
        "uniform sampler2D u_image; layout(location = 0) out vec4 o_color;",
    )


def chain(graph: Graph, fill: Compute, double: Raster, length: int) -> TextureHandle:
    """fill, then ``length`` doublings, each into a target of its own."""
    image = graph.texture("filled", (16, 16), RGBA16F)
    graph.compute(fill, writes={"o_image": image}, threads=(16, 16))
    for number in range(length):
        target = graph.texture(f"doubled {number}", like=image)
        graph.raster(double, color=target, reads={"u_image": image})
        image = target
    return image


def test_compute_then_raster_by_name(device: Device, fill: Compute, double: Raster) -> None:
    graph = device.begin_frame()
    image = chain(graph, fill, double, 2)
    graph.keep(image)
    graph.execute()
    assert image.physical
    np.testing.assert_array_equal(image.physical.read(), np.full((16, 16, 4), (1, 2, 3, 4)))


def test_unread_passes_do_not_run(device: Device, fill: Compute, double: Raster) -> None:
    graph = device.begin_frame()
    kept = chain(graph, fill, double, 1)
    chain(graph, fill, double, 3)
    graph.keep(kept)
    graph.execute()
    device.finish()
    assert len(device.timings) == 2


def test_targets_are_shared_along_a_chain_and_a_steady_frame_allocates_nothing(
    device: Device, fill: Compute, double: Raster
) -> None:
    pool = device.executor.pool
    device.begin_frame()
    pool.clear()
    before = pool.stats.allocations
    serials = set()
    for _ in range(5):
        graph = device.begin_frame()
        image = chain(graph, fill, double, 10)
        graph.keep(image)
        graph.execute()
        assert image.physical
        serials.add(image.physical.serial)
        assert pool.stats.allocations - before == 2
    assert len(serials) == 1


def test_an_idle_target_is_freed_and_its_bytes_are_gone(device: Device, fill: Compute) -> None:
    size = (61, 67)  # no other test's
    graph = device.begin_frame()
    image = graph.texture("odd", size, RGBA16F)
    graph.compute(fill, writes={"o_image": image}, threads=(*size, 1))
    graph.keep(image)
    graph.execute()
    physical = image.physical
    assert physical
    held = device.bytes()["targets"]
    for _ in range(device.executor.pool.idle_frames + 1):
        assert physical.glo
        device.begin_frame()
    assert not physical.glo
    assert image.physical is None
    assert device.bytes().get("targets", 0) <= held - 61 * 67 * 8


def test_kept_targets_survive_until_the_next_frame(device: Device, fill: Compute) -> None:
    graph = device.begin_frame()
    first = graph.texture("first", (8, 8), RGBA16F)
    second = graph.texture("second", (8, 8), RGBA16F)
    for image in (first, second):
        graph.compute(fill, writes={"o_image": image}, threads=(8, 8))
        graph.keep(image)
    graph.execute()
    assert first.physical
    assert second.physical
    assert first.physical is not second.physical


def test_parameters_arrive_and_equal_ones_are_uploaded_once(
    device: Device, sources: Sources
) -> None:
    shader = sources.compute(
        "seconds[slot()] = u_view.time_s;",
        '#include "shared/view.glsl"\nlayout(std430) buffer Seconds { float seconds[]; };\n'
        "int slot() { return int(u_view.frame); }",
        local=(1, 1, 1),
    )
    view = layouts().block("View")
    rest = {
        name: np.zeros(view.metadata["members"][name].given)  # type: ignore[index]
        for name in view.names or ()
        if name not in ("time_s", "frame")
    }
    seconds = device.buffer("seconds", np.zeros(4, np.float32))
    for repeat in range(4):  # past the ring's three segments
        graph = device.begin_frame()
        for slot in range(4):
            block = pack(view, time_s=slot * 1.5 + repeat, frame=slot, **rest)
            graph.compute(shader, writes={"Seconds": seconds}, params={"View": block}, groups=1)
            graph.compute(shader, writes={"Seconds": seconds}, params={"View": block}, groups=1)
        step = -(-view.itemsize // device.params.alignment) * device.params.alignment
        assert device.params.used == 4 * step
        graph.execute()
        assert seconds.read(np.float32).tolist() == [s * 1.5 + repeat for s in range(4)]
    seconds.release()


def test_the_parameter_ring_turns(device: Device) -> None:
    """A frame in flight may still read its blocks, so they are not overwritten."""
    device.params.upload()
    places = [device.params.upload() for _ in range(6)]
    assert len(set(places[:3])) == 3
    assert places[:3] == places[3:]


def test_names_are_checked(device: Device, fill: Compute, double: Raster) -> None:
    graph = device.begin_frame()
    image = graph.texture("image", (8, 8), RGBA16F)
    with pytest.raises(GraphError, match=r"no o_imag \(in writes\); it declares o_image"):
        graph.compute(fill, writes={"o_imag": image}, threads=8)
    with pytest.raises(GraphError, match="o_image not bound"):
        graph.compute(fill, threads=8)
    with pytest.raises(GraphError, match="o_image is given in reads, but it is writeonly"):
        graph.compute(fill, reads={"o_image": image}, threads=8)
    with pytest.raises(GraphError, match="u_image is given in writes, but a sampler"):
        graph.raster(double, color=image, writes={"u_image": image})
    volume = graph.texture("volume", (8, 8, 8), RGBA16F)
    with pytest.raises(GraphError, match="u_image: volume is 3D, the shader wants 2D"):
        graph.raster(double, color=image, reads={"u_image": volume})
    with pytest.raises(GraphError, match="one of threads, groups and indirect"):
        graph.compute(fill, writes={"o_image": image})
    with pytest.raises(GraphError, match="is no resource of this frame"):
        device.begin_frame().keep(image)


def test_a_name_that_the_compiler_dropped_is_no_error(device: Device, sources: Sources) -> None:
    shader = sources.compute(
        "if (false) { values[0] = texelFetch(u_unused, ivec2(0), 0).x; values[0] = spare[0]; }",
        "uniform sampler2D u_unused; layout(std430) buffer Spare { float spare[]; };"
        "layout(std430) buffer Values { float values[]; };",
    )
    graph = device.begin_frame()
    image = device.texture("image", (4, 4), R32F)
    values, spare = device.buffer("values", 16), device.buffer("spare", 16)
    reads = {"u_unused": image, "Spare": spare}
    graph.compute(shader, reads=reads, writes={"Values": values}, groups=1)
    graph.execute()
    for resource in (image, values, spare):
        resource.release()


def test_a_block_of_the_wrong_size_is_refused(device: Device, sources: Sources) -> None:
    shader = sources.compute(
        "values[0] = u_view.time_s;",
        '#include "shared/view.glsl"\nlayout(std430) buffer Values { float values[]; };',
    )
    values = device.buffer("values", 16)
    small = np.zeros((), [("x", "f4", 4)])
    size = layouts().block("View").itemsize
    with pytest.raises(GraphError, match=f"block View has {size} bytes, 16 given"):
        device.begin_frame().compute(
            shader, writes={"Values": values}, params={"View": small}, groups=1
        )
    values.release()


def test_a_loose_uniform_is_refused(device: Device, sources: Sources) -> None:
    shader = sources.compute(
        "values[0] = u_scale;",
        "uniform float u_scale; layout(std430) buffer Values { float values[]; };",
    )
    with pytest.raises(ShaderError, match="u_scale stands alone"):
        device.program(shader)


def test_reading_what_nobody_wrote_is_refused(device: Device, double: Raster) -> None:
    graph = device.begin_frame()
    empty, target = graph.texture("empty", (8, 8), RGBA8), graph.texture("target", (8, 8), RGBA8)
    graph.raster(double, "show", color=target, reads={"u_image": empty})
    graph.keep(target)
    with pytest.raises(PlanError, match="pass show reads empty"):
        graph.execute()


def test_a_broken_frame_leaves_the_device_usable(
    device: Device, fill: Compute, double: Raster
) -> None:
    def fail(_: object) -> None:
        raise KeyError("draw")

    pool = device.executor.pool
    graph = device.begin_frame()
    in_use = pool.stats.in_use
    image = chain(graph, fill, double, 1)
    target = graph.texture("broken", like=image)
    graph.raster(double, color=target, reads={"u_image": image}, draw=fail)
    graph.keep(target)
    with pytest.raises(KeyError):
        graph.execute()
    assert pool.stats.in_use == in_use
    test_compute_then_raster_by_name(device, fill, double)


def test_copy_of_a_layer(device: Device) -> None:
    graph = device.begin_frame()
    four, other = (graph.texture(name, (4, 4), R32UI, layers=3) for name in ("four", "other"))
    graph.clear_texture(four, (4,))
    graph.clear_texture(other, (9,))
    graph.copy_texture(four, other, layer=1)
    with pytest.raises(GraphError, match="no layer 3"):
        graph.copy_texture(four, other, layer=3)
    graph.keep(other)
    graph.execute()
    assert other.physical
    assert other.physical.read()[:, 0, 0].tolist() == [9, 4, 9]


def test_copy_of_a_tile(device: Device) -> None:
    graph = device.begin_frame()
    four, other = (graph.texture(name, (4, 4), R32UI, layers=2) for name in ("four", "other"))
    graph.clear_texture(four, (4,))
    graph.clear_texture(other, (9,))
    graph.copy_texture(four, other, layer=1, tile=(1, 2, 2, 1))
    graph.keep(other)
    graph.execute()
    assert other.physical
    wanted = np.full((2, 4, 4), 9)
    wanted[1, 2, 1:3] = 4
    np.testing.assert_array_equal(other.physical.read(), wanted)


def test_clear_and_copy(device: Device) -> None:
    graph = device.begin_frame()
    color = graph.texture("color", (8, 4), RGBA16F, mips=2)
    ids = graph.texture("ids", (4, 4, 4), R32UI)
    copy = graph.texture("copy", like=ids)
    numbers = graph.buffer("numbers", 64)
    part = graph.buffer("part", 32)
    graph.clear_texture(color, (0.5, 1, 2, 4))
    graph.clear_texture(ids, (7,))
    graph.copy_texture(ids, copy)
    graph.clear_buffer(numbers, 3)
    graph.clear_buffer(numbers, 9, offset=8, size=16)
    graph.clear_buffer(numbers, (0, 1, 1, 7), offset=32)
    graph.copy_buffer(numbers, part, size=16, src_offset=16, dst_offset=16)
    for handle in (color, copy, numbers, part):
        graph.keep(handle)
    graph.execute()
    assert color.physical
    assert copy.physical
    assert numbers.physical
    assert part.physical
    for level in range(2):
        assert (color.physical.read(level) == (0.5, 1, 2, 4)).all()
    assert (copy.physical.read() == 7).all()
    assert numbers.physical.read(np.uint32).tolist() == [3, 3, 9, 9, 9, 9, 3, 3] + [0, 1, 1, 7] * 2
    assert part.physical.read(np.uint32).tolist()[4:] == [9, 9, 3, 3]


def test_clears_without_gl_44(device: Device, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(device.gl, "has_clear_tex_image", False)
    test_clear_and_copy(device)


def test_sampler_arrays_and_explicit_sampling(device: Device, sources: Sources) -> None:
    shader = sources.compute(
        "values[0] = texture(u_images[0], vec2(1.25, 0.25)).r;"
        "values[1] = texture(u_images[1], vec2(0.5)).r;"
        "values[2] = texture(u_border, vec2(-1.0)).r;",
        "uniform sampler2D u_images[2]; uniform sampler2D u_border;"
        "layout(std430) buffer Values { float values[]; };",
        local=(1, 1, 1),
    )
    texels = np.array([[1, 2], [3, 4]], np.float32)
    image = device.texture("image", (2, 2), R32F, data=texels)
    values = device.buffer("values", 12)
    graph = device.begin_frame()
    reads = {
        "u_images": (Sampled(image, "nearest", "repeat"), image),
        "u_border": Sampled(image, wrap="border", border=8.0),
    }
    graph.compute(shader, reads=reads, writes={"Values": values}, groups=1)
    graph.execute()
    assert values.read(np.float32).tolist() == [1, 2.5, 8]
    image.release()
    values.release()


def test_moderngl_calls_between_frames_do_no_harm(
    device: Device, fill: Compute, double: Raster
) -> None:
    """moderngl and ImGui change bindings and state behind the graph's back."""
    test_compute_then_raster_by_name(device, fill, double)
    ctx = device.ctx
    other = ctx.texture((4, 4), 4)
    frame = ctx.framebuffer([other])
    frame.use()
    frame.clear(1, 0, 0, 1)
    for unit in range(8):
        other.use(unit)
        other.bind_to_image(unit)
    ctx.enable_only(ctx.BLEND | ctx.DEPTH_TEST | ctx.CULL_FACE)
    ctx.scissor = (0, 0, 1, 1)
    device.gl.glEnable(0x0C11)
    test_compute_then_raster_by_name(device, fill, double)
    frame.release()
    other.release()


def test_integer_results_of_image_atomics(device: Device, sources: Sources) -> None:
    shader = sources.compute(
        "imageAtomicAdd(u_counts, ivec2(gl_GlobalInvocationID.x % 4u, 0), 1u);",
        "layout(r32ui) uniform uimage2D u_counts;",
    )
    graph = device.begin_frame()
    counts = graph.texture("counts", (4, 1), R32UI)
    graph.clear_texture(counts)
    graph.compute(shader, writes={"u_counts": counts}, threads=128)
    graph.keep(counts)
    graph.execute()
    assert counts.physical
    assert counts.physical.read().tolist() == [[32, 32, 32, 32]]


def test_an_rgba8_texture_bound_as_the_shader_s_r32ui(device: Device, sources: Sources) -> None:
    shader = sources.compute(
        "imageStore(o_texel, ivec2(0), uvec4(0x04030201u));",
        "layout(r32ui) writeonly uniform uimage2D o_texel;",
        local=(1, 1, 1),
    )
    graph = device.begin_frame()
    texel = graph.texture("texel", (1, 1), RGBA8)
    graph.compute(shader, writes={"o_texel": texel}, groups=1)
    graph.keep(texel)
    graph.execute()
    assert texel.physical
    assert texel.physical.read().ravel().tolist() == [1, 2, 3, 4]


def test_bare_float32_images_filter(device: Device, double: Raster) -> None:
    image = device.texture("image", (2, 1), RGBA32F, data=np.array([[[0] * 4, [1] * 4]], "f4"))
    graph = device.begin_frame()
    target = graph.texture("target", (4, 1), RGBA32F)
    graph.raster(double, color=target, reads={"u_image": image})
    graph.keep(target)
    graph.execute()
    assert target.physical
    assert target.physical.read()[0, :, 0].tolist() == [0, 0.5, 1.5, 2]
    image.release()


def test_objects_carry_the_names_of_resources_and_passes(device: Device, fill: Compute) -> None:
    """What a capture shows reads like the source, also where a pooled target is reused."""
    label = device.ctx.mglo.get_label
    for name in ("albedo", "normal"):
        graph = device.begin_frame()
        image = graph.texture(name, (24, 24), RGBA16F)
        graph.compute(fill, writes={"o_image": image}, threads=(24, 24))
        graph.keep(image)
        graph.execute()
        assert image.physical
        assert label(c.LABEL_TEXTURE, image.physical.glo) == name
    nodes = device.buffer("octree.nodes", 16)
    assert nodes.mgl.label == "octree.nodes"
    assert label(c.LABEL_PROGRAM, device.program(fill).mgl.glo) == repr(fill)
    nodes.release()
