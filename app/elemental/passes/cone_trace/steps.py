"""How long the cones of each pixel are."""

from __future__ import annotations

from elemental.core.layout import Block
from elemental.gpu.formats import RGBA8
from elemental.gpu.graph import Graph
from elemental.gpu.refs import Ref, TextureHandle
from elemental.gpu.shaders import Compute
from elemental.passes.cone_trace.diffuse import SPLITS
from elemental.passes.gbuffer import GBuffer
from elemental.passes.sky import Sky
from elemental.passes.voxel.octree import Octree

STEP_VIEWS = {
    "diffuse_steps": "samples a diffuse cone, false colour: white is 64 and more",
    "specular_steps": "samples of the specular cone, false colour: white is 192 and more",
}
"""Views of the cones' work -> help; display codes."""

DIFFUSE = {n: Compute("views/diffuse_steps.comp.glsl", defines={"CONE_SPLIT": n}) for n in SPLITS}
SPECULAR = Compute("views/specular_steps.comp.glsl")


def step_view(
    g: Graph,
    view: Block,
    gb: GBuffer,
    octree: Octree,
    sky: Sky,
    area_lights: Block,
    split: int,
    name: str,
) -> TextureHandle:
    """One of STEP_VIEWS, (H, W) RGBA8 display codes. ``split``: as for `trace_diffuse`."""
    image = g.texture(f"view.{name}", size=gb.depth.size, format=RGBA8)
    reads: dict[str, Ref] = {"u_depth": gb.depth, "u_gbuffer_a": gb.a}
    params = {"View": view, **octree.params, **sky.params()}
    shader = DIFFUSE[split]
    if name == "specular_steps":
        reads |= {"u_gbuffer_b": gb.b, "u_gbuffer_d": gb.d}
        params["AreaLights"] = area_lights
        shader = SPECULAR
    g.compute(
        shader,
        f"view.{name}",
        reads={**reads, **octree.tracing_reads(), **sky.reads()},
        writes={"o_image": image},
        params=params,
        threads=image.size[:2],
    )
    return image
