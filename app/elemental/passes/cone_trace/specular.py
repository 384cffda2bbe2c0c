"""Indirect glossy light. [Mittring12 "Specular Sampling 1/2", "2/2"]"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial

import numpy as np

from elemental.core.layout import Block, layouts
from elemental.gpu.formats import RGBA8, RGBA16F
from elemental.gpu.graph import Graph
from elemental.gpu.refs import AnyTexture, BufferHandle, Ref, TextureHandle
from elemental.gpu.shaders import Compute
from elemental.passes.gbuffer import GBuffer
from elemental.passes.sky import Sky
from elemental.passes.voxel.octree import Octree

SELECT = {
    (adaptive, show): Compute(
        "cone_trace/specular_select.comp.glsl",
        defines={"ADAPTIVE": int(adaptive), "SHOW_TRACED": int(show)},
    )
    for adaptive in (False, True)
    for show in (False, True)
}
UPSAMPLE = {
    show: Compute("cone_trace/specular_upsample.comp.glsl", defines={"SHOW_TRACED": int(show)})
    for show in (False, True)
}
TRACE = Compute("cone_trace/specular.comp.glsl")
NOTHING_LISTED = (0, 1, 1, 0)
"""struct SpecularCounts: work groups along x, y and z, pixels."""


@dataclass(frozen=True)
class Specular:
    """Glossy light of one frame.

    radiance (H, W) RGBA16F along the mirrored eye vector, a: visibility of the sky; traced (H, W)
    RGBA8, which pixels have a cone of their own, where that was asked for.
    """

    radiance: AnyTexture
    traced: TextureHandle | None


@dataclass
class SpecularCounters:
    """What the GPU counted, frames later: cones of the pixels traced first, pixels between them,
    and cones of those of them that interpolation would not do for."""

    first: int = 0
    undecided: int = 0
    rest: int = 0

    def receive(self, name: str, raw: bytes) -> None:
        """Take the SpecularCounts of one of the lists above."""
        counts = np.frombuffer(raw, layouts().struct("SpecularCounts"), count=1)[0]
        setattr(self, name, int(counts["listed"]))

    def counters(self) -> dict[str, int]:
        """By the names of the report."""
        return {
            "specular_pixels": self.first + self.undecided,
            "specular_traced": self.first + self.rest,
        }


@dataclass(frozen=True)
class PixelList:
    """A list of pixels that the GPU fills and dispatches over: see shared/specular_list.glsl."""

    counts: BufferHandle
    pixels: BufferHandle

    @classmethod
    def empty(cls, g: Graph, name: str, capacity: int) -> PixelList:
        """Nothing listed yet; the dispatch over it grows in x, then in y."""
        counts = g.buffer(f"{name}.counts", int(layouts().struct("SpecularCounts").itemsize))
        g.clear_buffer(counts, NOTHING_LISTED)
        return cls(counts, g.buffer(f"{name}.pixels", 4 * capacity))

    def refs(self, block: str = "Specular") -> dict[str, Ref]:
        """The list by its GLSL names: SpecularState, SpecularPixels."""
        return {f"{block}State": self.counts, f"{block}Pixels": self.pixels}


def trace_specular(
    g: Graph,
    view: Block,
    gb: GBuffer,
    octree: Octree,
    sky: Sky,
    area_lights: Block,
    broad_gi: AnyTexture,
    counters: SpecularCounters,
    *,
    adaptive: bool,
    show: bool = False,
    into: AnyTexture | None = None,
) -> Specular:
    """One cone a pixel, as wide as the surface's specular lobe, but where its neighbours' will do.

    A broad lobe on a dim surface takes ``broad_gi``. With ``adaptive``, the pixels of a coarse
    grid are traced first and the others interpolated where these agree. What is to be traced is
    listed and dispatched indirectly, so that every thread has a cone. ``show`` asks for `traced`;
    ``into``: what takes `radiance`.
    """
    size = gb.depth.size[:2]
    specular = into or g.texture("specular_gi", like=gb.depth, format=RGBA16F)
    traced = g.texture("specular.traced", like=gb.depth, format=RGBA8) if show else None
    shown: dict[str, Ref] = {} if traced is None else {"o_traced": traced}
    surface: dict[str, Ref] = {
        "u_depth": gb.depth,
        "u_gbuffer_a": gb.a,
        "u_gbuffer_b": gb.b,
        "u_gbuffer_d": gb.d,
    }

    def trace(pixels: PixelList, name: str) -> None:
        g.compute(
            TRACE,
            f"cones.specular_{name}",
            reads={**surface, **pixels.refs(), **octree.tracing_reads(), **sky.reads()},
            writes={"o_specular_gi": specular},
            params={"View": view, "AreaLights": area_lights, **octree.params, **sky.params()},
            indirect=(pixels.counts, 0),
        )

    lists = {
        name: PixelList.empty(g, f"specular.{name}", math.prod(size))
        for name in ("first", "undecided", "rest")
    }
    first, undecided, rest = lists.values()
    g.compute(
        SELECT[adaptive, show],
        "cones.specular_select",
        reads={**surface, "u_broad_gi": broad_gi},
        writes={
            "o_specular_gi": specular,
            **first.refs(),
            **(undecided.refs("Undecided") if adaptive else {}),
            **shown,
        },
        params={"View": view},
        threads=size,
    )
    trace(first, "first")
    if adaptive:
        g.compute(
            UPSAMPLE[show],
            "cones.specular_upsample",
            reads={**surface, **undecided.refs("Undecided")},
            writes={"u_specular_gi": specular, **rest.refs(), **shown},
            params={"View": view},
            indirect=(undecided.counts, 0),
        )
        trace(rest, "rest")
    for name, pixels in lists.items():
        g.read_later(pixels.counts, partial(counters.receive, name))
    return Specular(specular, traced)
