"""Indirect light by pixel: traced by cones, or held from the last frame that traced them."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass

from elemental.core.layout import Block
from elemental.frame.request import Request, Systems
from elemental.frame.views import HELD_VIEWS, SPECULAR_VIEWS
from elemental.gpu.graph import Graph
from elemental.gpu.refs import AnyTexture
from elemental.passes.cone_trace.area_lights import trace_area_lights
from elemental.passes.cone_trace.diffuse import SHARED_SPLIT, combine_diffuse, trace_diffuse
from elemental.passes.cone_trace.held import HeldLight
from elemental.passes.cone_trace.interleave import SUB_IMAGES
from elemental.passes.cone_trace.specular import Specular, trace_specular
from elemental.passes.gbuffer import GBuffer
from elemental.passes.sky import Sky
from elemental.passes.voxel.octree import Octree
from elemental.settings import Settings
from elemental.settings.values import LIGHT_KEYS


@dataclass(frozen=True)
class Gathered:
    """Indirect light by pixel: diffuse (H, W) irradiance / pi, and glossy. None: not asked for."""

    diffuse: AnyTexture | None = None
    specular: Specular | None = None

    def image(self, name: str) -> AnyTexture | None:
        """What the view of that name shows of it, if it does."""
        if name == "diffuse_gi":
            return self.diffuse
        if name in SPECULAR_VIEWS and self.specular is not None:
            return self.specular.traced or self.specular.radiance
        return None


def gather(
    g: Graph,
    view: Block,
    gb: GBuffer,
    systems: Systems,
    request: Request,
    octree: Octree | None,
    sky: Sky,
) -> Gathered:
    """The light that cones bring to every pixel, if there is an octree. ``sky``: as they see it."""
    if octree is None:
        return Gathered()
    if request.view not in HELD_VIEWS:
        return _trace(g, view, gb, systems, request, octree, sky, None)
    held, (width, height) = systems.held, gb.depth.size[:2]
    if not held.stands(g, (width, height), _grounds(g, view, systems, request)):
        return _trace(g, view, gb, systems, request, octree, sky, held)
    glossy = request.settings["gi.specular"]
    return Gathered(held.diffuse, Specular(held.specular, None) if glossy else None)


def cone_split(settings: Settings) -> int:
    """Narrower cones that each diffuse cone is traced as."""
    return int(settings["gi.diffuse_cones"]) // SUB_IMAGES


def _grounds(g: Graph, view: Block, systems: Systems, request: Request) -> Hashable:
    """All that the light of a view depends on: equal for two frames that gather the same.

    The octree changes with the scene, with its lights and with the sky.
    """
    seen = view.copy()
    seen["frame"], seen["time_s"] = 0, 0.0  # read by what comes after the light alone
    assert systems.voxels is not None, "there is an octree"
    return (
        seen.tobytes(),
        systems.voxels.version,
        systems.meshes.materials.version,  # decals that leave voxels alone wear some
        g.device.library.version,
        tuple(request.settings[key] for key in LIGHT_KEYS),
    )


def _trace(
    g: Graph,
    view: Block,
    gb: GBuffer,
    systems: Systems,
    request: Request,
    octree: Octree,
    sky: Sky,
    into: HeldLight | None,
) -> Gathered:
    """Trace the cones of every pixel, ``into`` targets that outlive the frame or its own."""
    s, name = request.settings, request.view
    split = cone_split(s)
    block = systems.area_lights.block
    shared = split == SHARED_SPLIT and s["gi.diffuse_pattern"] == 6
    radiance = trace_diffuse(g, view, gb, octree, sky, split, shared)
    area = None
    if systems.area_lights.lights:
        area = (trace_area_lights(g, view, gb, octree, block, systems.shadows), block)
    diffuse, broad = combine_diffuse(
        g, view, gb, radiance, split, area, into=None if into is None else into.diffuse
    )
    glossy = s["gi.specular"] and name != "diffuse_gi"
    if not glossy and name not in SPECULAR_VIEWS:
        return Gathered(diffuse)
    specular = trace_specular(
        g,
        view,
        gb,
        octree,
        sky,
        block,
        broad,
        systems.specular,
        adaptive=s["gi.specular_adaptive"],
        show=name == "specular_traced",
        into=None if into is None else into.specular,
    )
    return Gathered(diffuse, specular)
