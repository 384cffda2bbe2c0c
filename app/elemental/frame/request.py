"""What a frame is made with and what it is to show."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from elemental.passes.area_lights import AreaLightBlock
from elemental.passes.cone_trace.held import HeldLight
from elemental.passes.cone_trace.specular import SpecularCounters
from elemental.passes.decal import Decals
from elemental.passes.post.history import PostHistory
from elemental.passes.scene_gpu import GpuScene
from elemental.passes.shadow import ShadowMaps
from elemental.passes.sky import Sky
from elemental.passes.voxel.lighting import VoxelLighting
from elemental.scene.lights import Environment
from elemental.scene.model import Camera, Light
from elemental.settings import Settings


@dataclass(frozen=True)
class Systems:
    """What lives between frames. ``voxels``: None where nothing asks for indirect light."""

    meshes: GpuScene
    decals: Decals
    shadows: ShadowMaps
    sky: Sky
    area_lights: AreaLightBlock
    voxels: VoxelLighting | None
    held: HeldLight
    specular: SpecularCounters
    post: PostHistory


@dataclass(frozen=True)
class Request:
    """What a frame shows: ``view`` is one of VIEWS, ``size`` (width, height) the picture's in px.

    ``settings`` are this frame's, volumes blended in; ``spreads_gathers``: as `VoxelLighting`
    means it.
    """

    camera: Camera
    lights: Sequence[Light]
    environment: Environment | None
    settings: Settings
    time_s: float
    frame: int
    view: str
    size: tuple[int, int]
    spreads_gathers: bool
