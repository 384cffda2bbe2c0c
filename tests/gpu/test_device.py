"""The device: reload, timings, read-back, memory, the driver's messages, contexts."""

from __future__ import annotations

import gc
import os
import subprocess
import sys
import textwrap
import time
from pathlib import Path

import numpy as np
import pytest

from elemental.gpu import gl as c
from elemental.gpu import library, screen
from elemental.gpu.device import FRAMES_IN_FLIGHT, Device, GpuMemoryError
from elemental.gpu.formats import R8, RGBA8, RGBA32F
from elemental.gpu.graph import Graph
from elemental.gpu.messages import GlError
from elemental.gpu.resources import Buffer
from elemental.gpu.shaders import Compute, ShaderError
from gpu.sources import Sources

VALUES = "layout(std430) buffer Values { float values[]; };"


def _touch(path: Path, text: str) -> None:
    """Write ``text`` with a time stamp that differs from the last one."""
    before = path.stat().st_mtime_ns
    path.write_text(text)
    os.utime(path, ns=(before + 10**9, before + 10**9))


def _value(device: Device, shader: Compute) -> float:
    values = device.buffer("values", 64 * 4)
    graph = device.begin_frame()
    graph.compute(shader, writes={"Values": values}, groups=1)
    graph.execute()
    value = float(values.read(np.float32)[0])
    values.release()
    return value


def test_reload_takes_a_good_edit_and_survives_a_bad_one(device: Device, sources: Sources) -> None:
    lib = sources.folder / "brightness.glsl"
    lib.write_text("float brightness() { return 1.0; }\n")
    other = sources.compute("values[0] = 5.0;", VALUES)
    shader = sources.compute("values[0] = brightness();", f'#include "{lib}"\n{VALUES}')
    assert (_value(device, shader), _value(device, other)) == (1, 5)
    assert device.reload_changed_shaders() == []
    unchanged, replaced = device.program(other), device.program(shader)

    _touch(lib, "float brightness() { return 2.0; }\n")
    before = device.library.version
    assert device.reload_changed_shaders() == []
    assert device.library.version > before
    assert _value(device, shader) == 2
    assert device.program(other) is unchanged
    assert type(replaced.mgl.mglo).__name__ == "InvalidObject"  # released

    _touch(lib, "\nfloat brightness() { return oops; }\n")
    (error,) = device.reload_changed_shaders()
    assert "brightness.glsl:2: error: " in error
    assert "oops" in error
    assert _value(device, shader) == 2
    assert device.reload_changed_shaders() == []

    _touch(lib, "float brightness() { return 3.0; }\n")
    assert device.reload_changed_shaders() == []
    assert _value(device, shader) == 3


def test_a_file_that_vanishes_keeps_the_program(device: Device, sources: Sources) -> None:
    lib = sources.folder / "gone.glsl"
    lib.write_text("float f() { return 4.0; }\n")
    shader = sources.compute("values[0] = f();", f'#include "{lib}"\n{VALUES}')
    assert _value(device, shader) == 4
    lib.unlink()
    (error,) = device.reload_changed_shaders()
    assert "can't read" in error
    assert _value(device, shader) == 4
    lib.write_text("float f() { return 6.0; }\n")
    assert device.reload_changed_shaders() == []
    assert _value(device, shader) == 6


def test_an_include_that_a_reload_brings_in_is_watched(device: Device, sources: Sources) -> None:
    lib = sources.folder / "new.glsl"
    shader = sources.compute("values[0] = 1.0;", VALUES)
    assert _value(device, shader) == 1
    entry = Path(shader.stages[0][1])
    lib.write_text("float f() { return 2.0; }\n")
    _touch(entry, f'#include "{lib}"\n' + entry.read_text().replace("= 1.0", "= f()"))
    assert device.reload_changed_shaders() == []
    assert _value(device, shader) == 2
    _touch(lib, "float f() { return 3.0; }\n")
    assert device.reload_changed_shaders() == []
    assert _value(device, shader) == 3


def test_a_watched_edit_is_taken_up_and_idle_polls_ask_no_file(
    device: Device, sources: Sources, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(device, "shader_root", sources.folder)
    shader = sources.compute("values[0] = 1.0;", VALUES)
    assert _value(device, shader) == 1
    device.watch_shaders()
    try:
        time.sleep(0.3)  # until the watch is set up
        device.reload_changed_shaders()
        asked: list[Path] = []
        real = library._stamp

        def spy(file: Path) -> int:
            asked.append(file)
            return real(file)

        monkeypatch.setattr(library, "_stamp", spy)
        assert device.reload_changed_shaders() == []
        assert asked == []
        entry = Path(shader.stages[0][1])
        _touch(entry, entry.read_text().replace("1.0", "2.0"))
        for _ in range(100):
            device.reload_changed_shaders()
            if _value(device, shader) == 2:
                break
            time.sleep(0.05)
        assert _value(device, shader) == 2
    finally:
        device.stop_watching_shaders()


def test_compiler_errors_name_the_stage_s_file(device: Device, sources: Sources) -> None:
    shader = sources.full_screen("o_color = vec4(undefined_name);")
    with pytest.raises(ShaderError, match=r"2\.frag\.glsl:4: error: .*undefined_name"):
        device.program(shader)
    mismatch = sources.mesh(
        "out vec3 v_a; void main() { v_a = vec3(1); gl_Position = vec4(0); }",
        "in vec2 v_a; out vec4 o_c; void main() { o_c = vec4(v_a, 0, 1); }",
    )
    with pytest.raises(ShaderError, match=r"4\.frag\.glsl: error: .*v_a"):
        device.program(mismatch)


def _busy(graph: Graph, sources: Sources, values: Buffer, name: str) -> None:
    shader = sources.compute(
        "float x = 0.0; for (int i = 0; i < 20000; ++i) x = sin(x + float(i)); values[0] = x;",
        VALUES,
    )
    graph.compute(shader, name, writes={"Values": values}, groups=4)


def test_timings_name_every_pass_and_arrive_without_waiting(
    device: Device, sources: Sources
) -> None:
    values = device.buffer("values", 256)
    device.finish()
    for frame in range(4):
        graph = device.begin_frame()
        _busy(graph, sources, values, f"first {frame}")
        _busy(graph, sources, values, f"second {frame}")
        graph.execute()
    device.finish()
    assert [timing.name for timing in device.timings] == ["first 3", "second 3"]
    assert all(timing.gpu_ms > 0 and timing.cpu_ms > 0 for timing in device.timings)
    total = sum(timing.gpu_ms for timing in device.timings)
    assert device.frame_ms == pytest.approx(total, rel=1e-6)
    values.release()


def test_queries_are_reused(device: Device, sources: Sources) -> None:
    values = device.buffer("values", 256)
    shader = sources.compute("values[0] = 1.0;", VALUES)

    def frame() -> None:
        graph = device.begin_frame()
        for _ in range(5):
            graph.compute(shader, writes={"Values": values}, groups=1)
        graph.execute()

    made = device.timers.made
    for _ in range(30):
        frame()
    assert device.timers.made <= made + 6 * (FRAMES_IN_FLIGHT + 1)
    values.release()


def test_read_later_arrives_frames_later_with_its_own_frame_s_bytes(
    device: Device, sources: Sources
) -> None:
    shader = sources.compute("values[gl_GlobalInvocationID.x] += 1.0;", VALUES)
    values = device.buffer("values", np.zeros(64, np.float32))
    device.flush_reads()
    arrived: list[tuple[int, float]] = []
    for frame in range(6):
        graph = device.begin_frame()
        graph.compute(shader, writes={"Values": values}, groups=1)

        def receive(raw: bytes, frame: int = frame) -> None:
            arrived.append((frame, float(np.frombuffer(raw, np.float32)[63])))

        graph.read_later(values, receive)
        graph.execute()
        device.gl.glFinish()
        assert len(arrived) <= max(0, frame - 1)
    assert arrived
    device.flush_reads()
    assert arrived == [(frame, frame + 1.0) for frame in range(6)]
    values.release()


def test_bytes_are_counted_by_category_until_released(device: Device) -> None:
    before = device.bytes()
    texture = device.texture("t", (64, 32), RGBA8, mips=7, category="shadows")
    buffer = device.buffer("b", 1000, category="shadows")
    texels = sum(max(1, 64 >> i) * max(1, 32 >> i) for i in range(7))
    assert device.bytes()["shadows"] == 4 * texels + 1000
    texture.release()
    buffer.release()
    texture.release()
    assert device.bytes() == before


def test_a_spent_budget_is_an_error_that_names_the_resource(device: Device) -> None:
    before = device.bytes()
    device.memory_budget = sum(before.values()) + 10_000
    try:
        with pytest.raises(GpuMemoryError, match=r"atlas.*64\.0 MiB: the memory budget is spent"):
            device.texture("atlas", (4096, 4096), RGBA8)
        with pytest.raises(GpuMemoryError, match="nodes"):
            device.buffer("nodes", 20_000)
        device.buffer("small", 5_000).release()
    finally:
        device.memory_budget = None
    assert device.bytes() == before


def test_what_the_driver_can_t_hold_is_a_memory_error(device: Device) -> None:
    before = device.bytes()
    with pytest.raises(GpuMemoryError, match="the driver is out of memory"):
        device.texture("huge", (16384, 16384), RGBA32F, layers=512)
    assert device.bytes() == before


def test_uploads_of_the_wrong_size_are_refused(device: Device) -> None:
    before = device.bytes()
    with pytest.raises(ValueError, match="t: 15 bytes given, 16 needed"):
        device.texture("t", (4, 4), R8, data=bytes(15))
    assert device.bytes() == before


def test_a_gl_error_fails_the_frame_of_a_debug_device(device: Device) -> None:
    graph = device.begin_frame()
    graph.execute()
    device.gl.glBindTexture(0xBAD, 1)
    with pytest.raises(GlError, match=r"GL_INVALID_ENUM"):
        device.begin_frame().execute()
    assert any("GL_INVALID_ENUM" in message for message in device.messages)
    device.log.messages.clear()
    device.begin_frame().execute()


def test_a_high_severity_message_fails_the_frame(device: Device) -> None:
    def say(severity: int) -> None:
        kind = 0x8251  # GL_DEBUG_TYPE_OTHER
        device.gl.glDebugMessageInsert(
            c.DEBUG_SOURCE_APPLICATION, kind, 1, severity, 4, b"boom"
        )  # fmt: skip

    say(c.DEBUG_SEVERITY_LOW)
    device.check()
    say(c.DEBUG_SEVERITY_HIGH)
    with pytest.raises(GlError, match="high: boom"):
        device.check()
    device.log.messages.clear()


def test_no_target_is_dithered(device: Device) -> None:
    """GL begins with it on: codes of normals and lighting models are no colours."""
    assert device.gl.integer(c.DITHER) == 0


def test_frames_do_not_pile_up(device: Device, sources: Sources) -> None:
    """The CPU runs at most three frames ahead, so a software driver's queue stays bounded."""
    values = device.buffer("values", 256)
    for frame in range(8):
        graph = device.begin_frame()
        assert device.frames_in_flight < FRAMES_IN_FLIGHT
        _busy(graph, sources, values, str(frame))
        graph.execute()
    assert device.frames_in_flight == FRAMES_IN_FLIGHT
    values.release()


@pytest.mark.parametrize("kind", ["osmesa", "adopted"])
def test_other_contexts_draw_the_same(kind: str) -> None:
    """OSMesa where EGL is missing, and a window's context by its loader, in their own process."""
    script = """
        import numpy as np
        from elemental.gpu import headless
        from elemental.gpu.device import Device
        from elemental.gpu.formats import RGBA8
        if KIND == "osmesa":
            def missing():
                raise RuntimeError("no EGL here")
            headless._egl = missing
            device = Device.headless(debug=True)
        else:
            loader = headless._egl()
            device = Device.from_window(loader.load_opengl_function, debug=True)
        graph = device.begin_frame()
        image = graph.texture("image", (4, 4), RGBA8)
        graph.clear_texture(image, (0, 1, 0, 1))
        graph.keep(image)
        graph.execute()
        assert (image.physical.read() == (0, 255, 0, 255)).all()
        device.finish()
        device.release()
        print("drawn")
    """
    code = f"KIND = {kind!r}\n{textwrap.dedent(script)}"
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    ran = subprocess.run(
        [sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=False
    )
    if kind == "osmesa" and "libOSMesa is not installed" in ran.stderr:
        pytest.skip("no libOSMesa on this machine")
    assert ran.stdout.strip() == "drawn", ran.stderr


def test_no_context_gives_both_reasons() -> None:
    script = """
        from elemental.gpu import headless
        from elemental.gpu.device import Device
        def missing():
            raise RuntimeError("none")
        headless._egl = headless.OsMesaContext = missing
        Device.headless()
    """
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    ran = subprocess.run(
        [sys.executable, "-c", textwrap.dedent(script)], env=environment, capture_output=True,
        text=True, check=False,
    )  # fmt: skip
    assert "no OpenGL 4.3 context without a window; EGL: none; OSMesa: none" in ran.stderr


def test_frames_leave_nothing_to_the_cycle_collector(device: Device, sources: Sources) -> None:
    shader = sources.full_screen("o_color = vec4(1);")

    def frame() -> None:
        graph = device.begin_frame()
        first, second = (graph.texture(name, (4, 4), RGBA8) for name in "ab")
        graph.raster(shader, color=first)
        graph.raster(shader, color=[first, second])
        graph.keep(second)
        graph.execute()

    frame()
    gc.collect()
    for _ in range(5):
        frame()
    assert gc.collect() == 0


def test_many_frames_do_not_grow(device: Device, sources: Sources) -> None:
    shader = sources.full_screen("o_color = vec4(1);")
    device.begin_frame()
    before = None
    for frame in range(60):
        graph = device.begin_frame()
        image = graph.texture("image", (16, 16), RGBA8)
        graph.raster(shader, color=image)
        graph.keep(image)
        graph.execute()
        if frame == 20:
            before = (device.bytes(), len(device.executor.framebuffers))
    assert (device.bytes(), len(device.executor.framebuffers)) == before


@pytest.mark.parametrize("through", [False, True])
def test_present_fills_the_window_and_leaves_its_framebuffer_bound(
    device: Device, sources: Sources, monkeypatch: pytest.MonkeyPatch, through: bool
) -> None:
    """A framebuffer stands in for the window's."""
    image = device.texture("image", (2, 2), RGBA8, data=np.full((2, 2, 4), 100, np.uint8))
    window = device.texture("window", (6, 4), RGBA8, data=np.zeros((4, 6, 4), np.uint8))
    stand_in = device.executor.framebuffers.get([(window, 0, -1)], None, (0, 0))
    monkeypatch.setattr(screen, "_WINDOW", stand_in)
    half = sources.full_screen(
        "o_color = 0.5 * texture(u_image, v_uv);", "uniform sampler2D u_image; out vec4 o_color;"
    )
    device.gl.glEnable(c.SCISSOR_TEST)
    device.present(image, (0, 0, 6, 4), (half, "u_image") if through else None)
    assert (window.read() == (50 if through else 100)).all()
    assert device.gl.integer(0x8CA6) == stand_in  # GL_DRAW_FRAMEBUFFER_BINDING
    image.release()
    window.release()
