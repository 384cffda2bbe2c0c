"""Indirect glossy light. [Mittring12 "Specular Sampling 1/2", "2/2"]"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from elemental.core.layout import Block, layouts
from elemental.gpu.formats import RGBA8, RGBA16F
from elemental.gpu.graph import Graph
from elemental.gpu.refs import BufferHandle, Ref, TextureHandle
from elemental.gpu.shaders import Compute
from elemental.passes.gbuffer import GBuffer
from elemental.passes.sky import Sky
from elemental.passes.voxel.octree import Octree

COARSE = Compute("cone_trace/specular_coarse.comp.glsl")
UPSAMPLE = {
    (adaptive, show): Compute(
        "cone_trace/specular_upsample.comp.glsl",
        defines={"ADAPTIVE": int(adaptive), "SHOW_TRACED": int(show)},
    )
    for adaptive in (False, True)
    for show in (False, True)
}
TRACE = Compute("cone_trace/specular.comp.glsl")


@dataclass(frozen=True)
class Specular:
    """Glossy light of one frame.

    radiance (H, W) RGBA16F along the mirrored eye vector, a: visibility of the sky; traced (H, W)
    RGBA8, which pixels have a cone of their own, where that was asked for.
    """

    radiance: TextureHandle
    traced: TextureHandle | None


@dataclass
class SpecularCounters:
    """What the GPU counted, frames later: pixels with glossy light, and cones traced for them."""

    pixels: int = 0
    coarse: int = 0
    listed: int = 0

    def receive_coarse(self, raw: bytes) -> None:
        """Take the SpecularCounts of the coarse grid."""
        self.coarse = int(_counts(raw)["listed"])

    def receive(self, raw: bytes) -> None:
        """Take the SpecularCounts of the up-sampling."""
        self.pixels, self.listed = (int(_counts(raw)[name]) for name in ("pixels", "listed"))

    def counters(self) -> dict[str, int]:
        """By the names of the report."""
        return {"specular_pixels": self.pixels, "specular_traced": self.coarse + self.listed}


def _counts(raw: bytes) -> np.void:
    counts: np.void = np.frombuffer(raw, layouts().struct("SpecularCounts"), count=1)[0]
    return counts


def coarse_size(size: tuple[int, ...]) -> tuple[int, int]:
    """(width, height) of the coarse grid of a picture: as in lib/specular_grid.glsl."""
    side = int(layouts().constant("COARSE_PIXELS"))
    width, height = (max((length - side // 2 + side - 1) // side, 1) for length in size[:2])
    return width, height


def trace_specular(
    g: Graph,
    view: Block,
    gb: GBuffer,
    octree: Octree,
    sky: Sky,
    area_lights: Block,
    broad_gi: TextureHandle,
    counters: SpecularCounters,
    *,
    adaptive: bool,
    show: bool = False,
) -> Specular:
    """One cone a pixel, as wide as the surface's specular lobe, but where its neighbours' will do.

    A broad lobe on a dim surface takes ``broad_gi``. With ``adaptive``, the pixels of a coarse
    grid are traced first and the others interpolated where these agree. What is to be traced is
    listed and dispatched indirectly, so that every thread has a cone. ``show`` asks for `traced`.
    """
    specular = g.texture("specular_gi", like=gb.depth, format=RGBA16F)
    pixels = g.buffer("specular.pixels", 4 * math.prod(gb.depth.size[:2]))
    surface: dict[str, Ref] = {
        "u_depth": gb.depth,
        "u_gbuffer_a": gb.a,
        "u_gbuffer_b": gb.b,
        "u_gbuffer_d": gb.d,
    }

    def trace(name: str, counts: BufferHandle) -> None:
        lists: dict[str, Ref] = {"SpecularState": counts, "SpecularPixels": pixels}
        g.compute(
            TRACE,
            name,
            reads={**surface, **lists, **octree.tracing_reads(), **sky.reads()},
            writes={"o_specular_gi": specular},
            params={"View": view, "AreaLights": area_lights, **octree.params, **sky.params()},
            indirect=(counts, 0),
        )

    if adaptive:
        first = _no_pixels(g, "specular.coarse_counts")
        g.compute(
            COARSE,
            "cones.specular_coarse",
            reads=surface,
            writes={"SpecularState": first, "SpecularPixels": pixels},
            params={"View": view},
            threads=coarse_size(gb.depth.size),
        )
        trace("cones.specular_first", first)
        g.read_later(first, counters.receive_coarse)
    rest = _no_pixels(g, "specular.counts")
    writes: dict[str, Ref] = {
        "u_specular_gi": specular,
        "SpecularState": rest,
        "SpecularPixels": pixels,
    }
    traced = None
    if show:
        writes["o_traced"] = traced = g.texture("specular.traced", like=gb.depth, format=RGBA8)
    g.compute(
        UPSAMPLE[adaptive, show],
        "cones.specular_upsample",
        reads={**surface, "u_broad_gi": broad_gi},
        writes=writes,
        params={"View": view},
        threads=gb.depth.size[:2],
    )
    trace("cones.specular", rest)
    g.read_later(rest, counters.receive)
    return Specular(specular, traced)


def _no_pixels(g: Graph, name: str) -> BufferHandle:
    """A SpecularCounts of an empty list; its dispatch grows in x alone."""
    counts = g.buffer(name, int(layouts().struct("SpecularCounts").itemsize))
    g.clear_buffer(counts, 0)
    g.clear_buffer(counts, 1, offset=4, size=8)
    return counts
