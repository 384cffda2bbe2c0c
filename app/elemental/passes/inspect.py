"""Looking at any target of the frame: as a picture, texel by texel, and as an array.

[Mittring12 "Compositing Graph"], "tools to look at intermediate buffers". Nothing runs and nothing
is held while nobody looks.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from elemental.core.layout import Block, layouts, pack
from elemental.gpu.device import Device
from elemental.gpu.formats import RGBA8
from elemental.gpu.graph import Graph
from elemental.gpu.refs import AnyTexture, Layer, Mip, Resource, Sampled, TextureHandle
from elemental.gpu.resources import Buffer, Texture
from elemental.gpu.shaders import Compute, Raster
from elemental.passes.texels import Pixels, texels

KINDS = ("FLOAT", "UINT", "FLOAT_3D", "UINT_3D")
PICTURE = {
    kind: Raster("ui/present.vert.glsl", "views/inspect.frag.glsl", defines={"SOURCE": number})
    for number, kind in enumerate(KINDS)
}
PROBE = {
    kind: Compute("views/inspect_probe.comp.glsl", defines={"SOURCE": number})
    for number, kind in enumerate(KINDS)
}
CHANNELS = ("RGB", "R", "G", "B", "A", "Luminance")
COLORS = ("Plain", "sRGB", "False colour")
STENCIL = "Stencil"
"""One more channel of targets that hold one."""
PICTURE_NAME = "picture"
"""What the frame's output is called by the pixel inspector."""
PROBE_BYTES = 32


@dataclass(frozen=True)
class Target:
    """What is looked at: the ``occurrence``-th texture of this name and shape in the frame."""

    name: str
    size: tuple[int, ...]
    format: str
    occurrence: int = 0


@dataclass(frozen=True)
class Look:
    """How: a level, a layer or slice, a channel over a range, which texels at which size."""

    target: Target
    level: int = 0
    layer: int = 0
    channel: str = "RGB"
    low: float = 0.0
    high: float = 1.0
    colors: str = "sRGB"
    corner: tuple[float, float] = (0.0, 0.0)
    """Texel at the picture's bottom left corner."""
    step: float = 1.0
    """Texels a pixel."""
    probe: tuple[int, int] = (0, 0)
    """Texel whose values are told; (0, 0) is at the bottom left."""


@dataclass(frozen=True)
class Probed:
    """Values of a texel as shaders read them; ``words`` where they are unsigned integers."""

    texel: tuple[int, int]
    values: tuple[float, ...]
    words: tuple[int, ...] | None


class Inspector:
    """Adds the passes that look, as ``Renderer.looker``."""

    def __init__(self, device: Device) -> None:
        self.device = device
        self.look: Look | None = None
        self.size = (1, 1)
        """Of the picture to make, px."""
        self.picture: Texture | None = None
        self.probed: Probed | None = None
        self.found = False
        """Whether the last frame had the target."""
        self.frozen = False
        self._copy: Texture | None = None
        self._probed: Buffer | None = None
        self._wanted: Callable[[Pixels], None] | None = None

    def freeze(self, frozen: bool) -> None:
        """Keep what the target holds in the next frame, or follow it again."""
        self.frozen = frozen
        if not frozen:
            self._drop_copy()

    def capture(self, receive: Callable[[Pixels], None]) -> None:
        """Have the level and layer looked at handed over as (H, W, C) float32, row 0 on top."""
        self._wanted = receive

    def add(self, g: Graph) -> None:
        """The passes of one frame."""
        look = self.look
        if look is None:
            return
        source = self._source(g, look.target)
        self.found = source is not None
        if source is None:
            return
        if (self.frozen or self._wanted) and self._copy is None:
            self._copy = self._copied(g, source)
        if self._copy is not None:
            source = self._copy
        self._show(g, source, look)

    def after_frame(self) -> None:
        """Hand over what ``capture`` asked for; waits for the GPU then."""
        wanted = self._wanted
        if wanted is None or self._copy is None or self.look is None:
            return
        self._wanted = None
        pixels = texels(self._copy, self.look.level, self.look.layer)
        if not self.frozen:
            self._drop_copy()
        wanted(pixels)

    def release(self) -> None:
        """Free everything on the device."""
        self.look = None
        self._drop_copy()
        for held in (self.picture, self._probed):
            if held is not None:
                held.release()
        self.picture = self._probed = None

    def _source(self, g: Graph, target: Target) -> AnyTexture | None:
        if self.frozen and self._copy is not None:
            return self._copy
        number = 0
        written = _written(g)
        for resource in g.resources():
            if not _is(resource, target):
                continue
            assert isinstance(resource, (Texture, TextureHandle))
            if number == target.occurrence:
                ready = isinstance(resource, Texture) or resource in written
                return resource if ready else None
            number += 1
        return None

    def _copied(self, g: Graph, source: AnyTexture) -> Texture:
        desc = source.desc
        copy = Texture(self.device, f"{source.name} (looked at)", desc, "targets")
        g.copy_texture(source, copy)
        return copy

    def _show(self, g: Graph, source: AnyTexture, look: Look) -> None:
        if self.picture is None or self.picture.size != self.size:
            if self.picture is not None:
                self.picture.release()
            self.picture = self.device.texture(
                "inspect.picture", self.size, RGBA8, category="targets"
            )
        if self._probed is None:
            self._probed = self.device.buffer("inspect.probe", PROBE_BYTES)
        kind, read = _read(source, look)
        block = _block(look)
        g.raster(
            PICTURE[kind],
            "inspect",
            color=[self.picture],
            reads={"u_source": read},
            params={"Inspect": block},
        )
        _probe(g, kind, read, block, self._probed)
        is_uint = kind.startswith("UINT")
        g.read_later(self._probed, lambda raw: self._take(raw, look.probe, is_uint))

    def _take(self, raw: bytes, texel: tuple[int, int], is_uint: bool) -> None:
        self.probed = _received(raw, texel, is_uint)

    def _drop_copy(self) -> None:
        if self._copy is not None:
            self._copy.release()
            self._copy = None


class PixelProbe:
    """The values of one place of the picture in several targets: the pixel inspector."""

    def __init__(self, device: Device, names: tuple[str, ...]) -> None:
        self.device = device
        self.names = names
        """Targets that are asked, besides the frame's output."""
        self.place = (0.0, 0.0)
        """From the bottom left corner, 0..1."""
        self.values: dict[str, Probed] = {}
        """By target; the frame's output as "picture". A few frames old."""
        self._buffers: dict[str, Buffer] = {}

    def add(self, g: Graph) -> None:
        """The passes of one frame."""
        written = _written(g)
        found: dict[str, AnyTexture] = {}
        for resource in g.resources():
            if not isinstance(resource, (Texture, TextureHandle)):
                continue
            if resource in g.kept:
                found[PICTURE_NAME] = resource
            holds = isinstance(resource, Texture) or resource in written
            if holds and resource.name in self.names and len(resource.size) == 2:
                found[resource.name] = resource
        for name, source in found.items():
            width, height = source.size[:2]
            texel = (
                min(max(int(self.place[0] * width), 0), width - 1),
                min(max(int(self.place[1] * height), 0), height - 1),
            )
            look = Look(Target(name, source.size, source.format.name), probe=texel)
            kind, read = _read(source, look)
            buffer = self._buffers.get(name)
            if buffer is None:
                buffer = self.device.buffer(f"inspect.{name}", PROBE_BYTES)
                self._buffers[name] = buffer
            _probe(g, kind, read, _block(look), buffer)
            g.read_later(buffer, partial(self._take, name, texel, kind.startswith("UINT")))

    def release(self) -> None:
        """Free everything on the device."""
        for buffer in self._buffers.values():
            buffer.release()
        self._buffers.clear()
        self.values.clear()

    def _take(self, name: str, texel: tuple[int, int], is_uint: bool, raw: bytes) -> None:
        self.values[name] = _received(raw, texel, is_uint)


def _probe(g: Graph, kind: str, read: Sampled | Mip | Layer, block: Block, buffer: Buffer) -> None:
    g.compute(
        PROBE[kind],
        "inspect.probe",
        reads={"u_source": read},
        writes={"Probed": buffer},
        params={"Inspect": block},
        groups=1,
    )


def _received(raw: bytes, texel: tuple[int, int], is_uint: bool) -> Probed:
    values = np.frombuffer(raw, np.float32, 4)
    words = np.frombuffer(raw, np.uint32, 4, 16)
    return Probed(texel, tuple(map(float, values)), tuple(map(int, words)) if is_uint else None)


def _is(resource: object, target: Target) -> bool:
    return (
        isinstance(resource, (Texture, TextureHandle))
        and resource.name == target.name
        and resource.desc.size == target.size
        and resource.desc.format.name == target.format
    )


def _written(g: Graph) -> set[Resource]:
    written: set[Resource] = set()
    for item in g.passes:
        written.update(item.modifies, item.overwrites)
    return written


def _read(source: AnyTexture, look: Look) -> tuple[str, Sampled | Mip | Layer]:
    """(kind of the shader, the level or layer as it is read)."""
    desc = source.desc
    if len(desc.size) == 3:
        kind = "UINT_3D" if desc.format.kind == "uint" else "FLOAT_3D"
        return kind, Mip(source, look.level)
    if desc.format.kind == "depth_stencil" and look.channel == STENCIL:
        return "UINT", Sampled(Mip(source, look.level), stencil=True)
    part: Mip | Layer = Mip(source, look.level)
    if desc.slices > 1:
        part = Layer(source, look.layer, look.level)
    return ("UINT" if desc.format.kind == "uint" else "FLOAT"), Sampled(part, "nearest")


def _block(look: Look) -> Block:
    channel = CHANNELS.index(look.channel) if look.channel in CHANNELS else 1
    span = look.high - look.low
    return pack(
        layouts().block("Inspect"),
        corner=look.corner,
        step=look.step,
        low=look.low,
        high=look.high if span != 0.0 else look.low + 1.0,
        channel=channel,
        colors=COLORS.index(look.colors),
        slice=look.layer,
        probe=look.probe,
    )
