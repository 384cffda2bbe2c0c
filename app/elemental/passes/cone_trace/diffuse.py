"""Indirect diffuse light. [Mittring12 "Diffuse Sampling 2/2"], [Segovia06]"""

from __future__ import annotations

from elemental.core.layout import Block
from elemental.gpu.formats import RGBA16F
from elemental.gpu.graph import Graph
from elemental.gpu.refs import AnyTexture, Ref, TextureHandle
from elemental.gpu.shaders import Compute
from elemental.passes.cone_trace.interleave import part_groups, sub_image_groups, sub_images_size
from elemental.passes.gbuffer import GBuffer
from elemental.passes.sky import Sky
from elemental.passes.voxel.octree import Octree

SPLITS = (1, 4, 7)
"""Narrower cones that each of them may be traced as."""
SHARED_SPLIT = 4
"""As many as 2x2 patterns can deal out, one a pixel."""
TRACE = {n: Compute("cone_trace/diffuse.comp.glsl", defines={"CONE_SPLIT": n}) for n in SPLITS}
TRACE_PART = Compute(
    "cone_trace/diffuse.comp.glsl", defines={"CONE_SPLIT": SHARED_SPLIT, "SHARED": 1}
)
SHARE = Compute("cone_trace/share.comp.glsl", defines={"CONE_SPLIT": SHARED_SPLIT})
COMBINE = {
    (split, area): Compute(
        "cone_trace/combine.comp.glsl", defines={"CONE_SPLIT": split, "AREA_LIGHTS": int(area)}
    )
    for split in SPLITS
    for area in (False, True)
}


def trace_diffuse(
    g: Graph, view: Block, gb: GBuffer, octree: Octree, sky: Sky, split: int, shared: bool
) -> TextureHandle:
    """Nine sub-images of incoming radiance, one cone each: (3 ceil(H/3), 3 ceil(W/3)) RGBA16F.

    rgb: W/(m^2 sr); a: visibility of the sky, -1 where the cone is behind the surface.
    ``split``: of SPLITS. ``shared``: of SHARED_SPLIT narrower cones a pixel traces one, and takes
    the others from the pixels around it.
    """
    radiance = g.texture("cones.diffuse", size=sub_images_size(gb), format=RGBA16F)
    g.compute(
        TRACE_PART if shared else TRACE[split],
        "cones.diffuse",
        reads={
            "u_depth": gb.depth,
            "u_gbuffer_a": gb.a,
            **octree.tracing_reads(),
            **sky.reads(),
        },
        writes={"o_radiance": radiance},
        params={"View": view, **octree.params, **sky.params()},
        groups=part_groups(gb) if shared else sub_image_groups(gb),
    )
    return share_cones(g, view, gb, radiance) if shared else radiance


def share_cones(g: Graph, view: Block, gb: GBuffer, parts: TextureHandle) -> TextureHandle:
    """Sub-images of each group's mean, as `trace_diffuse` gives them, from one part a pixel."""
    groups = g.texture("cones.shared", like=parts)
    g.compute(
        SHARE,
        "cones.share",
        reads={"u_parts": parts, "u_depth": gb.depth, "u_gbuffer_a": gb.a},
        writes={"o_radiance": groups},
        params={"View": view},
        groups=sub_image_groups(gb),
    )
    return groups


def combine_diffuse(
    g: Graph,
    view: Block,
    gb: GBuffer,
    radiance: TextureHandle,
    split: int,
    area: tuple[TextureHandle, Block] | None,
    into: AnyTexture | None = None,
) -> tuple[AnyTexture, AnyTexture]:
    """(irradiance / pi, radiance in a broad specular lobe), (H, W) RGBA16F.

    a: visibility of the sky. They differ by the light of ``area``: what `trace_area_lights` made,
    and its AreaLights. ``split``: as for `trace_diffuse`; ``into``: what takes the first.
    """
    reads: dict[str, Ref] = {"u_radiance": radiance, "u_depth": gb.depth, "u_gbuffer_a": gb.a}
    params = {"View": view}
    diffuse = broad = into or g.texture("diffuse_gi", like=gb.depth, format=RGBA16F)
    writes: dict[str, Ref] = {"o_diffuse_gi": diffuse}
    if area is not None:
        reads["u_area_irradiance"], params["AreaLights"] = area
        reads["u_gbuffer_d"] = gb.d
        writes["o_broad_gi"] = broad = g.texture("broad_gi", like=gb.depth, format=RGBA16F)
    g.compute(
        COMBINE[split, area is not None],
        "cones.combine",
        reads=reads,
        writes=writes,
        params=params,
        threads=gb.depth.size[:2],
    )
    return diffuse, broad
