"""That the barriers the plan asks for are issued, where they are due, and no others."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

from elemental.gpu import gl as c
from elemental.gpu.device import Device
from elemental.gpu.encode import Encoder
from elemental.gpu.formats import R32F, RGBA8
from elemental.gpu.graph import Graph
from elemental.gpu.resources import Buffer, Texture, VertexInput
from gpu.sources import Sources

WRITE = "layout(std430) buffer Out { uint o[]; };"
READ = "layout(std430) readonly buffer In { uint i[]; };"


@pytest.fixture
def issued(device: Device, monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Bits of every glMemoryBarrier, in order."""
    bits: list[int] = []
    real = device.gl.glMemoryBarrier

    def spy(value: int) -> None:
        bits.append(value)
        real(value)

    monkeypatch.setattr(device.gl, "glMemoryBarrier", spy)
    return bits


@pytest.fixture
def buffer(device: Device) -> Iterator[Buffer]:
    """256 bytes without history."""
    made = device.buffer("shared", 256)
    yield made
    made.release()


@pytest.fixture
def image(device: Device) -> Iterator[Texture]:
    """An R32F image without history."""
    made = device.texture("shared", (8, 8), R32F)
    yield made
    made.release()


class Steps:
    """Passes by name over one buffer and one image; each writes a new buffer without history."""

    def __init__(self, device: Device, sources: Sources, buffer: Buffer, image: Texture) -> None:
        self.device, self.sources, self.buffer, self.image = device, sources, buffer, image
        self.made: list[Buffer | Texture | VertexInput] = []

    def run(self, names: str) -> None:
        """One pass for each word of ``names``, in one frame."""
        graph = self.device.begin_frame()
        for name in names.split():
            getattr(self, name)(graph)
        graph.execute()
        self.device.flush_reads()
        for resource in self.made:
            resource.release()
        self.made.clear()

    def _out(self) -> Buffer:
        made = self.device.buffer("out", 256)
        self.made.append(made)
        return made

    def _target(self) -> Texture:
        made = self.device.texture("target", (4, 4), RGBA8)
        self.made.append(made)
        return made

    def write(self, graph: Graph) -> None:
        shader = self.sources.compute("o[gl_GlobalInvocationID.x] = 1u;", WRITE)
        graph.compute(shader, writes={"Out": self.buffer}, groups=1)

    def read(self, graph: Graph) -> None:
        shader = self.sources.compute("o[0] = i[0];", READ + WRITE)
        graph.compute(shader, reads={"In": self.buffer}, writes={"Out": self._out()}, groups=1)

    def uniform(self, graph: Graph) -> None:
        head = "layout(std140) uniform U { uvec4 v; } u;" + WRITE
        shader = self.sources.compute("o[0] = u.v.x;", head)
        graph.compute(shader, reads={"U": self.buffer}, writes={"Out": self._out()}, groups=1)

    def texels(self, graph: Graph) -> None:
        head = "uniform usamplerBuffer u_b;" + WRITE
        shader = self.sources.compute("o[0] = texelFetch(u_b, 0).x;", head)
        graph.compute(shader, reads={"u_b": self.buffer}, writes={"Out": self._out()}, groups=1)

    def clear(self, graph: Graph) -> None:
        graph.clear_buffer(self.buffer)

    def send(self, graph: Graph) -> None:
        graph.read_later(self.buffer, lambda _: None)

    def indirect(self, graph: Graph) -> None:
        shader = self.sources.compute("o[gl_GlobalInvocationID.x] = 1u;", WRITE)
        graph.compute(shader, writes={"Out": self._out()}, indirect=(self.buffer, 0))

    def vertex(self, graph: Graph) -> None:
        shader = self.sources.mesh(
            "in vec4 a_p; void main() { gl_Position = a_p; }",
            "out vec4 o_c; void main() { o_c = vec4(1); }",
        )
        points = self.device.vertex_input([(self.buffer, "4f", ("a_p",))], self.buffer)
        self.made.append(points)

        def draw(encoder: Encoder) -> None:
            encoder.draw(points, 3)

        graph.raster(shader, color=self._target(), draw=draw)

    def indirect_draw(self, graph: Graph) -> None:
        shader = self.sources.full_screen("o_color = vec4(1);")
        index = self.device.buffer("index", np.zeros(3, np.uint32))
        empty = self.device.vertex_input([], index)
        self.made += [empty, index]

        def draw(encoder: Encoder) -> None:
            encoder.draw_indirect(empty, self.buffer)

        graph.raster(shader, color=self._target(), draw=draw)

    def store(self, graph: Graph) -> None:
        head = "layout(r32f) writeonly uniform image2D o_i;"
        shader = self.sources.compute("imageStore(o_i, ivec2(0), vec4(1));", head)
        graph.compute(shader, writes={"o_i": self.image}, groups=1)

    def load(self, graph: Graph) -> None:
        head = "layout(r32f) readonly uniform image2D u_i;" + WRITE
        shader = self.sources.compute("o[0] = uint(imageLoad(u_i, ivec2(0)).x);", head)
        graph.compute(shader, reads={"u_i": self.image}, writes={"Out": self._out()}, groups=1)

    def fetch(self, graph: Graph) -> None:
        head = "uniform sampler2D u_t;" + WRITE
        shader = self.sources.compute("o[0] = uint(texelFetch(u_t, ivec2(0), 0).x);", head)
        graph.compute(shader, reads={"u_t": self.image}, writes={"Out": self._out()}, groups=1)

    def render(self, graph: Graph) -> None:
        graph.raster(self.sources.full_screen("o_color = vec4(1);"), color=self.image)

    def clear_image(self, graph: Graph) -> None:
        graph.clear_texture(self.image)


@pytest.fixture
def steps(device: Device, sources: Sources, buffer: Buffer, image: Texture) -> Steps:
    """Passes by name."""
    return Steps(device, sources, buffer, image)


STORAGE, IMAGE, FETCH = (
    c.SHADER_STORAGE_BARRIER,
    c.SHADER_IMAGE_ACCESS_BARRIER,
    c.TEXTURE_FETCH_BARRIER,
)


@pytest.mark.parametrize(
    ("names", "bits"),
    [
        ("write read", [STORAGE]),
        ("write read read", [STORAGE]),
        ("read write", [STORAGE]),
        ("read read", []),
        ("write write", [STORAGE]),
        ("write uniform", [c.UNIFORM_BARRIER]),
        ("write texels", [c.TEXTURE_FETCH_BARRIER]),
        ("write clear", [c.BUFFER_UPDATE_BARRIER]),
        ("clear read", []),
        ("clear write", [STORAGE]),
        ("write vertex", [c.VERTEX_ATTRIB_ARRAY_BARRIER | c.ELEMENT_ARRAY_BARRIER]),
        ("write send", [c.BUFFER_UPDATE_BARRIER]),
        ("store fetch", [FETCH]),
        ("store load", [IMAGE]),
        ("store store", [IMAGE]),
        ("store render", [c.FRAMEBUFFER_BARRIER]),
        ("render fetch", []),
        ("render store", [IMAGE]),
        ("fetch store fetch", [IMAGE, FETCH]),
        ("clear indirect", []),
        ("clear write indirect", [STORAGE, c.COMMAND_BARRIER]),
        ("clear indirect_draw", []),
        ("write clear indirect_draw", [c.BUFFER_UPDATE_BARRIER, c.COMMAND_BARRIER]),
    ],
)
def test_bits_between_passes(steps: Steps, issued: list[int], names: str, bits: list[int]) -> None:
    steps.run(names)
    assert issued == bits


def test_a_write_in_one_frame_is_seen_by_the_next(steps: Steps, issued: list[int]) -> None:
    steps.run("write")
    steps.run("read")
    assert issued == [STORAGE]


def test_clearing_an_image_after_stores(device: Device, steps: Steps, issued: list[int]) -> None:
    """GL 4.4 clears textures; before, they are cleared by rendering."""
    native = device.gl.has_clear_tex_image
    steps.run("store clear_image")
    assert issued == [c.TEXTURE_UPDATE_BARRIER if native else c.FRAMEBUFFER_BARRIER]


def test_shader_writes_wait_for_uploads(steps: Steps, issued: list[int]) -> None:
    steps.buffer.write(bytes(256))
    steps.run("write")
    steps.image.write(bytes(256))
    steps.run("store")
    assert issued == [c.BUFFER_UPDATE_BARRIER, STORAGE, c.TEXTURE_UPDATE_BARRIER, IMAGE]


def test_reading_on_the_cpu_waits_for_shader_writes(
    device: Device, buffer: Buffer, image: Texture, issued: list[int]
) -> None:
    buffer.read()
    image.read()
    assert issued == [c.ALL_BARRIERS] * 2
