"""From scene-referred radiance to display codes: the film, and all that can go in one pass with it.

[Mittring12 "Eye Adaptation (Auto-Exposure)"]: the exposure is read in the vertex shader.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache

from elemental.core.layout import Block
from elemental.gpu.formats import RGBA8
from elemental.gpu.graph import Graph
from elemental.gpu.refs import AnyTexture, Ref, Sampled, TextureHandle
from elemental.gpu.shaders import Raster
from elemental.passes.post.exposure import Exposed
from elemental.passes.post.textures import Lut, Mask

SCREEN = "post/screen.vert.glsl"


@cache
def _shader(bloom: bool, dirt: bool, resample: bool, luts: tuple[int, ...]) -> Raster:
    defines = {"BLOOM": int(bloom), "DIRT": int(dirt), "RESAMPLE": int(resample)}
    defines |= dict(zip(("LUT", "LUT2"), luts, strict=False))
    return Raster(SCREEN, "post/tonemap.frag.glsl", defines=defines)


def tonemap(
    g: Graph,
    exposed: Exposed,
    film: Block,
    scene_color: AnyTexture,
    *,
    bloom: AnyTexture | None = None,
    dirt: Mask | None = None,
    luts: Sequence[Lut] = (),
) -> TextureHandle:
    """(H, W) RGBA8, sRGB encoded, of radiance (H, W).

    bloom: exposed light to add, of half the size rounded up; dirt: mask that adds it once more;
    luts: up to two, as in ``film``.
    """
    dirt = dirt if bloom is not None else None
    image = g.texture("tonemap", size=scene_color.size, format=RGBA8)
    resample = bool(film["fringe"] > 0.0 or film["grain_jitter_px"] > 0.0)
    reads: dict[str, Ref] = {**exposed.reads, "u_scene_color": Sampled(scene_color, "linear")}
    if bloom is not None:
        reads["u_bloom"] = bloom
    if dirt is not None:
        reads["u_dirt"] = Sampled(dirt.texture, "linear")
    for name, lut in zip(("u_lut", "u_lut2"), luts, strict=False):
        reads[name] = Sampled(lut.texture, "linear")
    kinds = tuple(3 if lut.table.is_cube else 1 for lut in luts)
    g.raster(
        _shader(bloom is not None, dirt is not None, resample, kinds),
        color=image,
        reads=reads,
        params={**exposed.params, "Film": film},
    )
    return image
