"""Image-based lens flares: sprites for very bright texels, and mirrored copies of them.

[Mittring12 "Image Based Lens Flares"]
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from elemental.core.layout import Block, layouts, pack
from elemental.gpu.device import Device
from elemental.gpu.encode import Encoder
from elemental.gpu.formats import RGBA16F, RGBA32F
from elemental.gpu.graph import Graph
from elemental.gpu.refs import AnyTexture, BufferHandle, Sampled, TextureHandle
from elemental.gpu.resources import Buffer, VertexInput
from elemental.gpu.shaders import Compute, Raster
from elemental.gpu.state import RasterState
from elemental.passes.post.exposure import Exposed
from elemental.passes.post.scale import downsample
from elemental.passes.post.textures import Mask

COUNT = Compute("post/sprite_count.comp.glsl")
APPEND = Compute("post/sprite_append.comp.glsl")
SPRITE = Raster("post/sprite.vert.glsl", "post/sprite.frag.glsl")
GHOSTS = Raster("post/ghosts.vert.glsl", "post/ghosts.frag.glsl")
ADD = RasterState(blend="add")

REFLECTIONS = (
    ("lens_flare.tint1", "lens_flare.position1"),
    ("lens_flare.tint2", "lens_flare.position2"),
    ("lens_flare.tint3", "lens_flare.position3"),
    ("lens_flare.tint4", "lens_flare.position4"),
    ("lens_flare.tint5", "lens_flare.position5"),
    ("lens_flare.tint6", "lens_flare.position6"),
    ("lens_flare.tint7", "lens_flare.position7"),
    ("lens_flare.tint8", "lens_flare.position8"),
)
MOST_SPRITES = 1 << 15
"""Sprites of a frame; brighter texels in later rows than they have room for go without."""
SMALLEST_RADIUS = 1.0
"""Of a sprite, px of the picture's quarter: a texel's light always spreads a little [inferred]."""
SMALLEST_COPY = 0.02
"""Least size of a copy, share of the picture [inferred]."""
REFLECTED = 0.0016
"""Share of the light in each copy at intensity 1: two reflections at plain glass, 4 % each."""
HALF_MAX = float(np.finfo(np.float16).max)
SIZE_PER_POSITION = 4.0
"""A position of 0.5 is the centre, 0.75 the picture itself, 0.25 its mirror image [inferred]."""


@dataclass
class SpriteCounters:
    """What the GPU counted, frames later; None until lens flares were drawn."""

    drawn: int | None = None
    bright: int = 0

    def receive(self, raw: bytes) -> None:
        """Take the SpriteCounts of a frame."""
        counts = np.frombuffer(raw, layouts().struct("SpriteCounts"), count=1)[0]
        self.drawn, self.bright = int(counts["sprites"]), int(counts["bright"])

    def counters(self) -> dict[str, int]:
        """By the names of the report."""
        if self.drawn is None:
            return {}
        return {
            "flare_sprites": self.drawn,
            "flare_sprites_dropped": self.bright - self.drawn,
        }


class Quad:
    """The indices of a sprite's two triangles, made when first drawn."""

    def __init__(self, device: Device) -> None:
        self._device = device
        self._indices: Buffer | None = None
        self._input: VertexInput | None = None

    def vertices(self) -> VertexInput:
        """Four vertices without attributes."""
        if self._input is None:
            corners = np.array([0, 1, 2, 2, 1, 3], np.uint32)
            self._indices = self._device.buffer("quad.indices", corners, category="meshes")
            self._input = self._device.vertex_input([], index=self._indices)
        return self._input

    def release(self) -> None:
        """Free them."""
        if self._input is not None:
            self._input.release()
        if self._indices is not None:
            self._indices.release()


def lens_flares(
    g: Graph,
    exposed: Exposed,
    half: AnyTexture,
    light: TextureHandle | None,
    s: Mapping[str, Any],
    *,
    shape: Mask | None,
    quad: Quad,
    counted: SpriteCounters,
    width: int,
) -> TextureHandle | None:
    """``light`` (exposed, like ``half``; None: black) with the reflections in it.

    ``shape``: the aperture's; without one there are none. ``width``: the picture's, px.
    """
    if shape is None or not is_on(s):
        return light
    quarter = downsample(g, half, "quarter")
    radius = max(0.5 * s["lens_flare.bokeh_size"] / 100.0 * width / 4.0, SMALLEST_RADIUS)
    block = _block(s, radius, shape, math.prod(quarter.size))
    counts, sprites = append_sprites(g, exposed, quarter, block)
    g.read_later(counts, counted.receive)
    blurred = draw_sprites(g, quarter, block, counts, sprites, shape, quad)
    target = light or g.texture("lens_flares", like=half, format=RGBA16F)
    g.raster(
        GHOSTS,
        color=target,
        reads={"u_blurred": Sampled(blurred, "linear"), "u_target_like": half, "Sprites": counts},
        params={"LensFlare": block},
        state=ADD,
        clear_color=(0.0, 0.0, 0.0, 0.0) if light is None else None,
    )
    return target


def is_on(s: Mapping[str, Any]) -> bool:
    """Whether any reflection shows."""
    if s["lens_flare.intensity"] == 0.0 or max(s["lens_flare.tint"]) == 0.0:
        return False
    return any(max(s[tint]) > 0.0 for tint, _ in REFLECTIONS)


def append_sprites(
    g: Graph, exposed: Exposed, quarter: AnyTexture, block: Block
) -> tuple[BufferHandle, TextureHandle]:
    """(SpriteCounts, (R, 256) RGBA32F light and texel) of the bright texels of ``quarter``."""
    texels = math.prod(quarter.size)
    group = int(layouts().constant("SCAN_GROUP"))
    columns = int(layouts().constant("SPRITE_COLUMNS"))
    runs = g.buffer("sprites.runs", 4 * -(-texels // group))
    counts = g.buffer("sprites.counts", int(layouts().struct("SpriteCounts").itemsize))
    rows = -(-int(block["capacity"]) // columns)
    sprites = g.texture("sprites", size=(columns, rows), format=RGBA32F)
    reads = {**exposed.reads, "u_picture": quarter}
    params = {**exposed.params, "LensFlare": block}
    g.compute(COUNT, reads=reads, writes={"RunCounts": runs}, params=params, threads=texels)
    g.compute(
        APPEND,
        reads={**reads, "RunCounts": runs},
        writes={"Sprites": counts, "o_sprites": sprites},
        params=params,
        threads=texels,
    )
    return counts, sprites


def draw_sprites(
    g: Graph,
    quarter: AnyTexture,
    block: Block,
    counts: BufferHandle,
    sprites: TextureHandle,
    shape: Mask,
    quad: Quad,
) -> TextureHandle:
    """The light of all sprites, added up, like ``quarter``: RGBA16F."""
    blurred = g.texture("sprites.light", like=quarter, format=RGBA16F)
    g.raster(
        SPRITE,
        color=blurred,
        reads={
            "u_sprites": sprites,
            "u_picture": quarter,
            "u_shape": Sampled(shape.texture, "trilinear", wrap="border"),
        },
        params={"LensFlare": block},
        state=ADD,
        clear_color=(0.0, 0.0, 0.0, 0.0),
        draw=_draw(quad, counts),
        uses=[counts],
    )
    return blurred


def _draw(quad: Quad, counts: BufferHandle) -> Callable[[Encoder], None]:
    return partial(Encoder.draw_indirect, vertex_input=quad.vertices(), commands=counts)


def _block(s: Mapping[str, Any], radius: float, shape: Mask, texels: int) -> Block:
    factor = REFLECTED * s["lens_flare.intensity"] * np.array(s["lens_flare.tint"])
    ghosts = np.zeros((len(REFLECTIONS), 4))
    for ghost, (tint, position) in zip(ghosts, REFLECTIONS, strict=True):
        size = SIZE_PER_POSITION * (s[position] - 0.5)
        ghost[:3] = factor * s[tint]
        ghost[3] = math.copysign(max(abs(size), SMALLEST_COPY), size)
    share = 1.0 / (4.0 * radius * radius * max(shape.mean, 1e-3))
    overlapping = (2.0 * radius + 1.0) ** 2  # as far as sprite.vert.glsl reaches
    return pack(
        layouts().block("LensFlare"),
        ghosts=ghosts,
        threshold=s["lens_flare.threshold"],
        sprite_radius=radius,
        sprite_share=share,
        capacity=min(texels, MOST_SPRITES),
        brightest=HALF_MAX / max(overlapping * share, 1.0),
    )
