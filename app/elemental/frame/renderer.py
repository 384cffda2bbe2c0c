"""What lives between frames: a scene on the device, its live edits, and frames made of it."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from elemental.core.errors import InputError
from elemental.frame.declare import declare_frame
from elemental.frame.request import Request, Systems
from elemental.frame.shadow_needs import SHADOW_KEYS, cutoff, shadow_settings
from elemental.frame.views import LINEAR_VIEWS, OCTREE_VIEWS
from elemental.gpu.device import Device
from elemental.gpu.graph import Graph
from elemental.gpu.refs import TextureHandle
from elemental.gpu.resources import Buffer, Texture
from elemental.passes.area_lights import AreaLightBlock
from elemental.passes.cone_trace.held import HeldLight
from elemental.passes.cone_trace.specular import SpecularCounters
from elemental.passes.decal import Decals
from elemental.passes.post.history import PostHistory
from elemental.passes.post.lens_flare import SpriteCounters
from elemental.passes.scene_gpu import GpuScene
from elemental.passes.shadow import ShadowMaps
from elemental.passes.sky import Sky
from elemental.passes.view_draws import CullCounters
from elemental.passes.voxel import sizing
from elemental.passes.voxel.grid import Grid
from elemental.passes.voxel.lighting import VoxelLighting
from elemental.scene.deform import posed
from elemental.scene.evaluate import LastPose, Pose
from elemental.scene.light_masks import MaskDrift
from elemental.scene.lights import checked
from elemental.scene.model import Camera, Light, Material, Region, Scene
from elemental.scene.sky_sun import SkySun
from elemental.scene.volumes import blend
from elemental.settings import Settings

MIB = 1 << 20

OCTREE_KEYS = frozenset({"gi.resolution", "gi.memory_budget_mb", "gi.area_lights"})
"""Settings that the octree is made for."""


@dataclass
class Frame:
    """A rendered frame. ``image`` stays valid until the next one; row 0 is at the bottom."""

    image: Texture
    is_linear: bool
    lights: Mapping[str, int]
    culled: CullCounters
    voxels: VoxelLighting | None
    specular: SpecularCounters
    sprites: SpriteCounters

    @property
    def counters(self) -> dict[str, int]:
        """Shadow maps, and what the GPU has told of so far: complete after Device.finish."""
        counted = {**self.lights, **self.culled.counters(), **self.sprites.counters()}
        if self.voxels is None:
            return counted
        return {**counted, **self.voxels.counters(), **self.specular.counters()}


class Renderer:
    """A scene on the device, and how a frame of it is made. ``size``: (width, height), px.

    Raises InputError for a size that the driver can't draw.
    """

    def __init__(
        self, device: Device, scene: Scene, settings: Settings, size: tuple[int, int]
    ) -> None:
        if size[0] * size[1] > max_pixels(device):
            reason = f"this driver draws at most {max_pixels(device):,} pixels"
            raise InputError("--size", f"{size[0]}x{size[1]}", reason)
        self.device = device
        self.scene = scene
        self.settings = settings
        self.size = size
        self._area_lights = AreaLightBlock(scene, *_area_lights(settings))
        self._last_pose = LastPose(scene)
        self._mask_drift = MaskDrift()
        self._sky_sun = SkySun()
        self._post = PostHistory(device, settings, scene.folder)
        self._meshes = GpuScene(device, scene, self._area_lights.lights)
        self._decals = Decals(device, scene, self._meshes)
        self._shadows = ShadowMaps(device, shadow_settings(settings, scene.volumes))
        self._sky = Sky(device)
        self._voxels: VoxelLighting | None = None
        self._held = HeldLight(device)
        self._specular = SpecularCounters()
        self.spreads_gathers = False
        """Whether further gathers of a moving scene are spread over frames, to keep up with it."""
        self.looker: Callable[[Graph], None] | None = None
        """Adds passes that look at the frame's targets, once all others are declared."""

    def resize(self, size: tuple[int, int]) -> None:
        """Draw the next frame at ``size``, or smaller where the driver can't."""
        width, height = max(size[0], 1), max(size[1], 1)
        scale = min(1.0, math.sqrt(max_pixels(self.device) / (width * height)))
        self.size = (max(int(scale * width), 1), max(int(scale * height), 1))

    def invalidate(self, what: str) -> None:
        """Have the next frame do what it could spare: rebuild the voxels of the "geometry", only
        their "light", or gather the light of the "view" alone."""
        self._held.forget()
        if self._voxels is not None and what != "view":
            self._voxels.invalidate(what)

    def set_material(self, index: int, material: Material) -> None:
        """Replace one of the scene's materials from the next frame on."""
        self._meshes.set_material(index, material)
        if self._area_lights.lights or material.emits:
            self._update_area_lights()
        self._fit_emission()

    def set_lights(self, lights: Sequence[Light]) -> None:
        """Replace the scene's lights from the next frame on. Raises InputError for what none is."""
        self.scene.lights = [checked(light) for light in lights]

    def set_settings(self, settings: Settings) -> None:
        """Take these settings from the next frame on; what was made for others is made anew."""
        before, self.settings = self.settings, settings
        changed = {key for key in settings if settings[key] != before[key]}
        if changed & SHADOW_KEYS:
            self._shadows.release()
            volumes = self.scene.volumes
            self._shadows = ShadowMaps(self.device, shadow_settings(settings, volumes))
            self.invalidate("light")
        if changed & {"gi.area_lights", "gi.area_shadows"}:
            self._update_area_lights()
        if changed & OCTREE_KEYS:
            self._drop_voxels()

    def set_regions(self, regions: Sequence[Region]) -> None:
        """Replace the scene's regions, and with them leaf levels, from the next frame on."""
        self.scene.regions = list(regions)
        grid, *coarser = self._grids()
        if self._voxels is not None and not self._voxels.set_grid(grid, coarser):
            self._drop_voxels()  # made anew

    def _update_area_lights(self) -> None:
        self._area_lights.choose(*_area_lights(self.settings))
        self._meshes.set_area_lights(self._area_lights.lights)

    def _drop_voxels(self) -> None:
        if self._voxels is not None:
            self._voxels.release()
            self._voxels = None
            self._held.release()

    def _fit_emission(self) -> None:
        """Have voxels made anew where materials emit more than they have room for."""
        brightest = sizing.max_emission(self.scene, self._area_lights.lights)
        if self._voxels is not None and brightest > self._voxels.octree.max_emission:
            self._drop_voxels()

    def _grids(self) -> tuple[Grid, ...]:
        """Of the scene's octree: the one that is asked for, and what it may fall back to."""
        resolution = self.settings["gi.resolution"]
        return Grid.ladder(self._meshes.bounds, resolution, self.scene.regions)

    def _move(self, time_s: float, pose: Pose | None) -> Sequence[Light]:
        """Bring the scene to its pose at a time, or to the given one. Returns its lights."""
        if pose is None:
            pose = self._last_pose.at(time_s)
        if self._meshes.update(pose, time_s):
            self._fit_emission()
        if self._decals.voxels is not None and self._decals.voxels.changed():
            self.invalidate("geometry")
        lights = self.scene.lights
        if pose is not None:
            self._area_lights.follow(pose)
            lights = pose.lights
        return self._mask_drift.at(lights, time_s)

    def render(
        self,
        camera: Camera,
        time_s: float,
        frame: int,
        view: str = "final",
        pose: Pose | None = None,
    ) -> Frame:
        """One frame as seen by ``camera``; ``view`` is one of VIEWS.

        What moves is where it is at ``time_s``, or as a ``pose`` says. Poses and lights are taken
        for what they were while they are the same objects: replace them, don't edit them.
        """
        lights = self._move(time_s, pose)
        self._shadows.planner.set_cutoff(cutoff(self.settings, self.scene.volumes))
        systems = self._systems(view, time_s)
        request = Request(
            camera=camera,
            lights=self._sky_sun.joined(lights, self.scene.environment, self.settings),
            environment=self.scene.environment,
            settings=blend(self.settings, self.scene.volumes, camera.world_from_view[:3, 3]),
            time_s=time_s,
            frame=frame,
            view=view,
            size=self.size,
            spreads_gathers=self.spreads_gathers,
        )
        g = self.device.begin_frame()
        self._meshes.deform(g)
        image = declare_frame(g, systems, request)
        self._meshes.materials.watch_faults(g)
        g.keep(image)
        if self.looker is not None:
            self.looker(g)
        g.execute()
        assert isinstance(image, TextureHandle), "what is held between frames is no picture"
        assert image.physical is not None, "a kept handle has a texture once its graph has run"
        culled = self._meshes.in_view.counters
        counted = (systems.voxels, self._specular, self._post.sprites)
        shadowed = {**self._shadows.counts, "area_lights_without_maps": self._area_lights.unmapped}
        return Frame(image.physical, view in LINEAR_VIEWS, shadowed, culled, *counted)

    def _systems(self, view: str, time_s: float) -> Systems:
        """What a frame's passes work on; voxels only where its view asks for indirect light."""
        return Systems(
            meshes=self._meshes,
            decals=self._decals,
            shadows=self._shadows,
            sky=self._sky,
            area_lights=self._area_lights,
            voxels=self._prepare_voxels(view, time_s),
            held=self._held,
            specular=self._specular,
            post=self._post,
        )

    def _prepare_voxels(self, view: str, time_s: float) -> VoxelLighting | None:
        """The octree, counted and allocated when it is first needed, for the scene at a time."""
        gathers = self.settings["gi.enabled"] and self.settings["gi.bounces"] > 0
        if not gathers and view not in OCTREE_VIEWS:
            return None
        if self._voxels is None:
            s = self.settings
            present = posed(self.scene, time_s) if self.scene.motion else self.scene
            grid, *coarser = self._grids()
            self._voxels = VoxelLighting(
                self.device,
                self._meshes,
                grid,
                area_m2=sizing.projected_area(present),
                max_emission=sizing.max_emission(self.scene, self._area_lights.lights),
                budget_bytes=s["gi.memory_budget_mb"] * MIB,
                decals=self._decals.voxels,
                coarser=coarser,
            )
        self._voxels.refit()
        return self._voxels

    @property
    def eye(self) -> Buffer:
        """What the eye has adapted to: an ``Eye`` of glsl/shared/exposure.glsl."""
        return self._post.eye.state

    def problems(self) -> list[str]:
        """What is wrong with materials and effects, a line each: code that does not compile, values
        that are no numbers, textures that can't be loaded; as far as the GPU has told."""
        own = (*self._meshes.materials.faults(), *self._post.problems())
        return [*self.device.library.problems(), *own]

    def history(self) -> bytes:
        """What later frames of a still scene depend on; waits for the GPU."""
        return self._post.save()

    def restore_history(self, raw: bytes) -> None:
        """Go on as after the frame at whose end ``raw`` was had. Raises ValueError."""
        self._post.restore(raw)

    def read(self, frame: Frame) -> npt.NDArray[Any]:
        """(H, W, 4) float32 of a linear frame, uint8 display codes of another; row 0 on top."""
        pixels = np.flipud(frame.image.read())
        return pixels.astype(np.float32) if frame.is_linear else pixels

    def release(self) -> None:
        """Free everything on the device."""
        self._drop_voxels()
        self._held.release()
        self._post.release()
        self._decals.release()
        self._sky.release()
        self._shadows.release()
        self._meshes.release()


def max_pixels(device: Device) -> int:
    """The largest picture: the list of glossy pixels, a word each, is one storage block."""
    return device.storage_limit // 4


def _area_lights(settings: Settings) -> tuple[bool, bool]:
    """Whether there are area lights, and whether these get shadow maps."""
    return settings["gi.area_lights"], settings["gi.area_shadows"] == "maps"
