"""The post-processing graph on one page. What is off, or would change nothing, does not run.

[Mittring12 "New post processing graph"]
"""

from __future__ import annotations

from elemental.core.layout import Block
from elemental.gpu.graph import Graph
from elemental.gpu.refs import TextureHandle
from elemental.passes.gbuffer import GBuffer
from elemental.passes.post.bloom import bloom
from elemental.passes.post.dof import depth_of_field
from elemental.passes.post.film import film_block
from elemental.passes.post.fxaa import fxaa
from elemental.passes.post.history import PostHistory
from elemental.passes.post.lens_flare import is_on, lens_flares
from elemental.passes.post.motion_blur import motion_blur
from elemental.passes.post.scale import downsample, upscale
from elemental.passes.post.tonemap import tonemap
from elemental.passes.scene_gpu import GpuScene
from elemental.settings import Settings


def develop(
    g: Graph,
    view: Block,
    scene_color: TextureHandle,
    gb: GBuffer,
    settings: Settings,
    history: PostHistory,
    scene: GpuScene | None = None,
    size: tuple[int, int] | None = None,
) -> TextureHandle:
    """The finished picture, (H, W) RGBA8 display codes, of radiance (H, W) RGBA16F.

    ``settings``: this frame's, blended or not; ``history``: the renderer's, one step a frame;
    ``scene``: what may move in it; ``size``: of the picture, if it is enlarged.
    """
    s = settings
    history.advance(view)
    scene_color = depth_of_field(g, view, scene_color, gb.depth, s)
    scene_color = motion_blur(g, view, history.view_before, scene_color, gb.depth, s, scene)
    flares = is_on(s)
    bright = flares or s["bloom.intensity"] > 0.0
    half = downsample(g, scene_color) if bright or history.eye.is_on(s) else None
    exposed = history.eye.update(g, half, s, history.elapsed_s)
    light = bloom(g, exposed, half, s, scene_color.width) if half is not None else None
    if flares and half is not None:
        light = lens_flares(
            g,
            exposed,
            half,
            light,
            s,
            shape=history.textures.mask("lens_flare.bokeh_shape", s["lens_flare.bokeh_shape"]),
            quad=history.quad,
            counted=history.sprites,
            width=scene_color.width,
        )
    dirt = None
    if s["bloom.dirt_intensity"]:
        dirt = history.textures.mask("bloom.dirt_mask", s["bloom.dirt_mask"])
    graded = history.textures.grading(s)
    film = film_block(s, [(lut.table, share) for lut, share in graded], int(view["frame"]))
    luts = [lut for lut, _ in graded]
    image = tonemap(g, exposed, film, scene_color, bloom=light, dirt=dirt, luts=luts)
    if s["fxaa.enabled"]:
        image = fxaa(g, image)
    return upscale(g, image, size or image.size)
