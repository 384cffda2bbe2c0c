"""One frame on one page, in the talk's order. The only file that sees every pass. [Mittring12]"""

from __future__ import annotations

from elemental.core.layout import Block
from elemental.frame.gather import cone_split, gather
from elemental.frame.request import Request, Systems
from elemental.gpu.graph import Graph
from elemental.gpu.refs import AnyTexture
from elemental.passes.camera_view import pack_view
from elemental.passes.cone_trace.steps import STEP_VIEWS, step_view
from elemental.passes.cone_trace.through import light_from_behind
from elemental.passes.forward import draw_translucent
from elemental.passes.gbuffer import draw_gbuffer
from elemental.passes.light_cells import cull_to_view
from elemental.passes.post.develop import develop
from elemental.passes.post.scale import drawn_size
from elemental.passes.scene_gpu import GpuScene
from elemental.passes.shade import shade
from elemental.passes.shadow import ShadowMaps, update_shadows
from elemental.passes.sky import Sky
from elemental.passes.ssao import SSAO_VIEWS, ssao_view
from elemental.passes.surfaces import settle_surfaces
from elemental.passes.views import CHANNELS, LIGHT_VIEWS, light_view, surface_view
from elemental.passes.voxel.octree import Octree
from elemental.passes.voxel.view import VOXEL_VIEWS, voxel_view
from elemental.settings import Settings


def declare_frame(g: Graph, systems: Systems, request: Request) -> AnyTexture:
    """The passes of a frame. What the asked-for image does not need, the graph leaves out."""
    s, camera, name = request.settings, request.camera, request.view
    meshes = systems.meshes
    size = drawn_size(request.size, s["screen.percentage"] if name == "final" else 100.0)
    view = _view(request, meshes, size)
    environment = request.environment if s["sky.enabled"] else None
    sky = systems.sky.update(g, environment, s["sky.intensity"], without_sun=s["sky.sun"])
    ambient = sky.tinted(_tint(s, "ambient_cubemap.intensity", "ambient_cubemap.tint"))
    emitters = systems.area_lights.mapped if systems.voxels is not None else ()
    shadows = update_shadows(
        g, systems.shadows, meshes, request.lights, camera=camera, size=size, emitters=emitters
    )
    octree = _light_voxels(g, systems, request, shadows, sky)
    if name in VOXEL_VIEWS and octree is not None:
        return voxel_view(g, view, octree, size, name, s["voxels.level"], s["voxels.side"])

    gb = draw_gbuffer(g, view, meshes, size, s["gbuffer.culling"])
    systems.decals.draw(g, view, gb)
    if name in CHANNELS:
        return surface_view(g, view, gb, name)
    voxel_m = octree.grid.voxel_m if octree is not None else None
    if name in SSAO_VIEWS:
        return ssao_view(g, view, gb, s, voxel_m)
    gb = settle_surfaces(g, view, gb, s, voxel_m)
    cells = cull_to_view(g, view, shadows, camera, size)
    if name in LIGHT_VIEWS:
        return light_view(g, view, gb, shadows, name, cells)

    if octree is not None and name in STEP_VIEWS:
        block, split = systems.area_lights.block, cone_split(s)
        return step_view(g, view, gb, octree, sky, block, split, name)
    gathered = gather(g, view, gb, systems, request, octree, ambient)
    image = gathered.image(name)
    if image is not None:
        return image
    models = meshes.materials.lighting_models
    scene_color = shade(
        g,
        view,
        gb,
        shadows,
        cells=cells,
        models=models,
        sky=sky.drawn() if environment is not None else None,
        diffuse_gi=gathered.diffuse,
        specular_gi=gathered.specular.radiance if gathered.specular is not None else None,
    )
    if octree is not None and gathered.diffuse is not None and "subsurface" in models:
        light_from_behind(g, view, gb, octree, ambient, gathered.diffuse)
    scene_color = draw_translucent(
        g,
        view,
        gb,
        meshes,
        shadows,
        sky=ambient,
        cells=cells,
        gathered=None if octree is None else (octree, systems.area_lights.block),
    )
    if name == "scene_color":
        return scene_color
    return develop(g, view, scene_color, gb, s, systems.post, meshes, request.size)


def _view(request: Request, meshes: GpuScene, size: tuple[int, int]) -> Block:
    """The block View of a frame that is drawn at ``size``, (width, height) px."""
    s = request.settings
    return pack_view(
        request.camera,
        size,
        meshes.bounds,
        exposure=2.0 ** s["exposure"],
        time_s=request.time_s,
        frame=request.frame,
        indirect=_tint(s, "indirect.intensity", "indirect.color"),
        subsurface_reach=s["shading.subsurface_reach"],
    )


def _light_voxels(
    g: Graph, systems: Systems, request: Request, shadows: ShadowMaps, sky: Sky
) -> Octree | None:
    """The octree, brought up to date with the scene and its lights."""
    if systems.voxels is None:
        return None
    return systems.voxels.update(
        g,
        shadows,
        sky,
        systems.area_lights.block,
        (shadows.lamp_key, sky.key),
        request.settings["gi.bounces"],
        request.spreads_gathers,
    )


def _tint(settings: Settings, intensity: str, color: str) -> tuple[float, float, float]:
    """A colour times an intensity, by their keys."""
    factor = settings[intensity]
    red, green, blue = settings[color]
    return factor * red, factor * green, factor * blue
