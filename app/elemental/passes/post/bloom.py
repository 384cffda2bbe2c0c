"""Bloom: five downsamples, recombined with rising resolution. [Mittring12 "Bloom"]"""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import lru_cache
from typing import Any

import numpy as np

from elemental.core.layout import Block, layouts, pack
from elemental.gpu.formats import RGBA16F
from elemental.gpu.graph import Graph
from elemental.gpu.refs import AnyTexture, Ref, Sampled, TextureHandle
from elemental.gpu.shaders import Raster
from elemental.passes.post.exposure import Exposed
from elemental.passes.post.scale import TRIANGLE, half_size

THRESHOLD = Raster("post/screen.vert.glsl", "post/bloom_threshold.frag.glsl")
DOWNSAMPLE = Raster(TRIANGLE, "post/downsample_tent.frag.glsl")
BLUR = Raster(TRIANGLE, "post/blur.frag.glsl")
BLUR_AND_ADD = Raster(TRIANGLE, "post/blur.frag.glsl", defines={"COARSER": 1})

KERNELS = (
    ("bloom.size1", "bloom.tint1"),
    ("bloom.size2", "bloom.tint2"),
    ("bloom.size3", "bloom.tint3"),
    ("bloom.size4", "bloom.tint4"),
    ("bloom.size5", "bloom.tint5"),
    ("bloom.size6", "bloom.tint6"),
)
"""One a level: half the picture's size, and five downsamples of that."""
WHOLE = 8.0
"""Intensity, the end of its range, at which white tints spread all light above the threshold: at 1
and the tints' defaults it is a sixteenth, about what an eye scatters [Spencer95]."""
DEVIATIONS = 3.0
"""Standard deviations of a Gaussian in its radius; 0.3 % of it lie beyond."""
NARROWEST_TEXELS = 0.5
"""Kernels of a smaller radius stay inside their texel."""


def bloom(
    g: Graph, exposed: Exposed, half: AnyTexture, s: Mapping[str, Any], width: int
) -> TextureHandle | None:
    """Exposed light to add to the picture, like ``half`` (its halved size): RGBA16F.

    Light above the threshold, spread over six kernels of a sixth of it each, times intensity and
    tints.
    ``width``: the picture's, px. None where it is off.
    """
    levels = [n for n, (_, tint) in enumerate(KERNELS) if max(s[tint]) > 0.0]
    if s["bloom.intensity"] == 0.0 or not levels:
        return None
    sources = [_threshold(g, exposed, half, s["bloom.threshold"])]
    for level in range(1, levels[-1] + 1):
        sources.append(_downsample(g, sources[-1], level))
    spread: TextureHandle | None = None
    for level in range(levels[-1], -1, -1):
        size, tint = KERNELS[level]
        share = s["bloom.intensity"] / WHOLE / len(KERNELS)
        red, green, blue = s[tint]
        radius = 0.5 * s[size] / 100.0 * width / 2 ** (level + 1)
        factor = (share * red, share * green, share * blue)
        spread = _blur(g, sources[level], spread, radius, factor, level)
    return spread


def _threshold(g: Graph, exposed: Exposed, half: AnyTexture, threshold: float) -> TextureHandle:
    bright = g.texture("bloom.bright", like=half, format=RGBA16F)
    block = pack(layouts().block("BloomThreshold"), threshold=threshold)
    g.raster(
        THRESHOLD,
        color=bright,
        reads={**exposed.reads, "u_picture": half},
        params={**exposed.params, "BloomThreshold": block},
    )
    return bright


def _downsample(g: Graph, finer: TextureHandle, level: int) -> TextureHandle:
    coarser = g.texture(f"bloom.{level}", size=half_size(finer.size), format=RGBA16F)
    g.raster(
        DOWNSAMPLE,
        f"bloom.down{level}",
        color=coarser,
        reads={"u_picture": Sampled(finer, "linear")},
    )
    return coarser


def _blur(
    g: Graph,
    source: TextureHandle,
    coarser: TextureHandle | None,
    radius: float,
    factor: tuple[float, float, float],
    level: int,
) -> TextureHandle:
    """blur(source) x factor + coarser, enlarged; ``radius`` in texels."""
    if radius >= NARROWEST_TEXELS:
        along = g.texture(f"bloom.along{level}", like=source)
        g.raster(
            BLUR,
            f"bloom.along{level}",
            color=along,
            reads={"u_picture": Sampled(source, "linear")},
            params={"Blur": blur_block(radius, (1.0, 0.0), (1.0, 1.0, 1.0))},
        )
        source = along
    across = g.texture(f"bloom.spread{level}", like=source)
    reads: dict[str, Ref] = {"u_picture": Sampled(source, "linear")}
    if coarser is not None:
        reads["u_coarser"] = Sampled(coarser, "linear")
    g.raster(
        BLUR if coarser is None else BLUR_AND_ADD,
        f"bloom.spread{level}",
        color=across,
        reads=reads,
        params={"Blur": blur_block(radius, (0.0, 1.0), factor)},
    )
    return across


@lru_cache(maxsize=128)
def blur_block(
    radius: float, axis: tuple[float, float], factor: tuple[float, float, float]
) -> Block:
    """The block Blur of a Gaussian that ends ``radius`` texels from its centre."""
    most = int(layouts().constant("BLUR_PAIRS"))
    pairs = np.zeros((most, 4), np.float32)
    reach = min(math.ceil(radius), 2 * most) if radius >= NARROWEST_TEXELS else 0
    count = (reach + 1) // 2
    offsets = np.arange(2 * count + 1)
    deviation = max(min(radius, 2.0 * most) / DEVIATIONS, 1e-3)
    weights = np.exp(-0.5 * (offsets / deviation) ** 2)
    weights /= 2.0 * weights.sum() - weights[0]
    nearer, farther = weights[1::2], weights[2::2]
    pairs[:count, 0] = offsets[1::2] + farther / np.maximum(nearer + farther, 1e-30)
    pairs[:count, 1] = nearer + farther
    return pack(
        layouts().block("Blur"),
        pairs=pairs,
        factor=factor,
        center=weights[0],
        axis=axis,
        count=count,
    )
