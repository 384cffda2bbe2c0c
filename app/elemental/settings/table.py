"""The rows of the one table, but for the post-processing effects' (post_table.py)."""

from __future__ import annotations

from elemental.settings.setting import Setting

TABLE = (
    Setting(
        "gi.enabled", "bool", True,
        "indirect light by voxel cone tracing, the sky's too; off leaves direct light and emission",
        source="[Mittring12] [Crassin11]",
    ),
    Setting(
        # 128: the finest grid that a two-core software driver still rebuilds several times a
        # second; one step up costs four times the bricks.
        "gi.resolution", "choice", 128,
        "lattice points a side of the voxel octree at its leaves",
        unit="voxels", choices=(64, 128, 256, 512), source="[Mittring12] [Crassin11]",
    ),
    Setting(
        "gi.area_lights", "bool", True,
        "emissive faces and balls light by closed form, shadowed; off: as voxels",
        source="[Mittring12] [Heitz18]",
    ),
    Setting(
        "gi.area_shadows", "choice", "maps",
        "what shadows those: maps, of the strongest four that stand, cones for the others; cones",
        choices=("maps", "cones"), source="[Mittring12] [Fernando05]",
    ),
    Setting(
        "gi.specular", "bool", True,
        "glossy indirect light, one cone a pixel along the mirrored eye vector",
        source="[Mittring12]",
    ),
    Setting(
        "gi.specular_adaptive", "bool", True,
        "trace a quarter of the glossy pixels first, interpolate where they agree",
        source="[Mittring12]",
    ),
    Setting(
        # 9: the talk's. 36 that pixels share cost 1.3 times as much, without clouds (docs/gi.md).
        "gi.diffuse_cones", "choice", 36,
        "cones over the sphere that gather diffuse light; more cost more and err less",
        unit="cones", choices=(9, 36, 63), source="[Mittring12] [Segovia06]",
    ),
    Setting(
        "gi.diffuse_pattern", "choice", 6,
        "side of the squares of pixels that share the diffuse cones: 3, a ninth each; 6, one each "
        "of 36 cones",
        unit="pixels", choices=(3, 6), source="[Segovia06]",
    ),
    Setting(
        "gi.bounces", "int", 1,
        "gathers of indirect light; with n, voxels hold light gathered n-1 times; 2 where a "
        "file has no light but emission",
        unit="gathers", lo=0, hi=8, source="[Mittring12] [Crassin11]",
    ),
    Setting(
        "gi.memory_budget_mb", "int", 1024,
        "most memory that the octree's pools may grow to",
        unit="MiB", lo=16, hi=16384,
    ),
    Setting(
        "scene.default_lights", "choice", "auto",
        "a sun and a sky that no file names; auto: for scenes without any light or emission",
        choices=("auto", "on", "off"),
    ),
    Setting(
        "scene.animation", "text", "all",
        "which of the scene's animations plays: its name, all or none",
        unit="name",
    ),
    Setting("sky.enabled", "bool", True, "draw the environment and light the scene by it"),
    Setting("sky.intensity", "float", 1.0, "factor on the environment's radiance", lo=0, hi=1000),
    Setting(
        "sky.image", "text", "",
        "equirectangular .hdr or .exr that replaces the scene's environment; empty keeps it",
        unit="file",
    ),
    Setting(
        "sky.sun", "bool", True,
        "light the scene by the sun of the environment's image as by a sun: with sharp shadows",
    ),
    Setting(
        "indirect.color", "color", (1.0, 1.0, 1.0),
        "tint of the indirect light that surfaces in view receive",
        lo=0, hi=1, volume=True,
    ),
    Setting("indirect.intensity", "float", 1.0, "factor on that light", lo=0, hi=4, volume=True),
    Setting(
        "ambient_cubemap.intensity", "float", 1.0,
        "factor on the environment's light on surfaces in view, not on the sky behind them",
        lo=0, hi=4, volume=True,
    ),
    Setting("ambient_cubemap.tint", "color", (1.0, 1.0, 1.0), "tint of that light",
            lo=0, hi=1, volume=True),
    Setting(
        "shading.subsurface_reach", "float", 0.03,
        "thickness of the thickest bodies that light shines through",
        unit="m", lo=0, hi=1000, source="[Mittring12]",
    ),
    Setting(
        "lights.culling", "bool", True,
        "find out which of many point and spot lights reach which part of view and scene",
        source="[Olsson12]",
    ),
    Setting(
        "lights.cutoff", "float", 1e-3,
        "irradiance, times 2^exposure, where one of many lights without a range ends",
        unit="lux", lo=1e-6, hi=1.0,
    ),
    Setting(
        "shadow.resolution", "choice", 1024,
        "texels a side of each shadow map and of each cascade",
        unit="texels", choices=(256, 512, 1024, 2048, 4096),
    ),
    Setting("shadow.cascades", "int", 3, "shadow maps of a directional light along the view",
            unit="maps", lo=1, hi=4),
    Setting(
        "shadow.budget", "int", 32,
        "shadow maps of that size that all lights share; four of half the side count as one",
        unit="maps", lo=0, hi=1024,
    ),
    Setting(
        "shadow.penumbras", "bool", True,
        "lights that have a size cast penumbras; off: their shadows are as sharp as a point's",
        source="[Fernando05]",
    ),
    Setting(
        "shadow.distance", "float", 0.0,
        "reach of fine directional shadows from the camera; 0 goes by the scene and the view",
        unit="m", lo=0, hi=100000,
    ),
    Setting("voxels.level", "int", 0,
            "level above the leaves that the views 'voxels' and 'occupancy' show",
            unit="level", lo=0, hi=9),
    Setting("voxels.side", "choice", "all",
            "side of the voxels that the view 'voxels' shows; all: those towards the eye",
            choices=("all", "+x", "-x", "+y", "-y", "+z", "-z")),
)  # fmt: skip
