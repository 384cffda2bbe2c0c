"""A checked scene file to a `Scene`: its models placed in one world, and what it adds to them."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import numpy.typing as npt

from elemental.core import transforms
from elemental.core.errors import named_by
from elemental.core.images import read_environment
from elemental.scene.gltf import load_gltf
from elemental.scene.gltf.animations import EVERY
from elemental.scene.ies import read_ies
from elemental.scene.image_sun import with_sun
from elemental.scene.light_changes import change_lights
from elemental.scene.light_masks import read_light_mask
from elemental.scene.model import (
    Camera,
    CameraPath,
    Environment,
    FloatArray,
    Light,
    Material,
    Mesh,
    Scene,
    TextureSlot,
    unique_name,
)
from elemental.scene.motion import RigBuilder
from elemental.scene.named_files import check_volume_files
from elemental.scene.photometry import solid_angle
from elemental.scene.regions import idle_regions, regions_of
from elemental.scene.scene_decals import stick
from elemental.scene.scene_file import SceneFile, read_scene_file
from elemental.scene.scene_materials import dress
from elemental.scene.scene_motions import Movers, described
from elemental.scene.scene_settings import settings_of
from elemental.scene.scene_warnings import covered_models, idle_keys
from elemental.scene.tables.cameras import CameraTable, PathTable
from elemental.scene.tables.lights import EnvironmentTable, LightTable
from elemental.scene.tables.models import ModelTable
from elemental.scene.volume_file import volumes_of

TEXTURE_SLOTS = (
    "base_color_texture",
    "metallic_roughness_texture",
    "normal_texture",
    "occlusion_texture",
    "emissive_texture",
)


def load_scene_file(path: Path, animation: str | None = None) -> Scene:
    """Read a scene file and everything that it names. Raises InputError.

    `animation`: which of the models' animations play, by name or "all"; with "none" the file's own
    motions stand still too. None: as the file's settings say.
    """
    file = read_scene_file(path)
    scene = Scene(file.name or path.stem, path)
    scene.settings = settings_of(file.settings, path)
    wanted = animation or str(scene.settings.get("scene.animation", EVERY))
    builder = RigBuilder()
    movers = Movers(builder, () if wanted == "none" else file.motions, path)
    scene.movers = [described(table) for table in file.motions]
    scene.cameras = [_camera(table) for table in file.cameras]
    scene.lights = [_light(table, i, path) for i, table in enumerate(file.lights)]
    taken = {table.name for table in file.lights if table.name is not None}
    for light, table in zip(scene.lights, file.lights, strict=True):
        light.name = table.name or unique_name(light.name, taken)
        node = movers.node_at("light", light.name, light.position)
        light.node = builder.node(node, _light_turn(light)) if node >= 0 else -1
    _place_models(scene, file, wanted, builder, movers)
    change_lights(scene, file.light_changes, len(file.lights))
    dress(scene, file.materials)
    stick(scene, file.decals)
    movers.check()
    scene.motion = builder.motion()
    scene.environment = _environment(file.environment, path) if file.environment else None
    scene.exposure_ev = file.exposure_ev
    scene.camera_path = _camera_path(file.camera_path) if file.camera_path else None
    scene.regions = regions_of(file.regions)
    scene.volumes = volumes_of(file.volumes, path)
    check_volume_files(scene.volumes, path)
    scene.warnings += [*idle_keys(file, path), *covered_models(file, path)]
    scene.warnings += idle_regions(scene.regions, scene.bounds(), path)
    return scene


def _place_models(
    scene: Scene, file: SceneFile, animation: str, builder: RigBuilder, movers: Movers
) -> None:
    """Load each named file once; a second placement shares its meshes."""
    loaded: dict[Path, tuple[Scene, int]] = {}
    for i, table in enumerate(file.models):
        path = scene.path.parent / table.file
        if path not in loaded:
            with named_by(scene.path, f"models[{i}].file", table.file):
                loaded[path] = load_gltf(path, animation), len(scene.meshes)
            _adopt(scene, loaded[path][0])
        world_from_model = _placement(table)
        mover = movers.node_at("model", table.name or path.stem, world_from_model[:3, 3])
        first = len(scene.instances)
        Placement(builder, world_from_model, mover).place(*loaded[path], scene)
        for instance in scene.instances[first:]:
            instance.receives_decals = table.receives_decals


class Placement:
    """One placing of a model: at a (4, 4) transform, moved by a node of the rig or by none (-1)."""

    def __init__(self, builder: RigBuilder, world_from_model: FloatArray, mover: int) -> None:
        self._builder, self._mover = builder, mover
        self._world_from_model = world_from_model
        self._mover_from_model = world_from_model.astype(np.float64)
        if mover >= 0:
            self._mover_from_model[:3, 3] = 0.0

    def place(self, model: Scene, first_mesh: int, scene: Scene) -> None:
        """Append the model's instances, lights and cameras to the scene."""
        first_node = first_skin = 0
        if model.motion is not None:
            first_node, first_skin = self._builder.adopt(
                model.motion, self._mover, self._mover_from_model
            )
        for item in model.instances:
            placed = replace(item, mesh=first_mesh + item.mesh)
            if item.skin >= 0:
                placed.skin = first_skin + item.skin
                placed.node = first_node + item.node if item.node >= 0 else -1
            else:
                placed.world_from_local = self._world_from_model @ item.world_from_local
                placed.node = self._node(item.node, first_node, item.world_from_local)
                placed.dynamic = item.dynamic or placed.node >= 0
            scene.instances.append(placed)
        for light in model.lights:
            moved = _moved_light(light, self._world_from_model)
            moved.node = self._node(light.node, first_node, _light_frame(light))
            scene.lights.append(moved)
        for camera in model.cameras:
            seen = _moved_camera(camera, self._world_from_model, scene.cameras)
            seen.node = self._node(camera.node, first_node, camera.world_from_view)
            scene.cameras.append(seen)

    def _node(self, node: int, first_node: int, model_from_local: FloatArray) -> int:
        """The scene's node of what has this node in the model; -1 where nothing moves it."""
        if node >= 0:
            return first_node + node
        if self._mover < 0:
            return -1
        return self._builder.node(self._mover, self._mover_from_model @ model_from_local)


def _adopt(scene: Scene, model: Scene) -> None:
    """Append a model's arrays to the scene's, renumbered."""
    first_texture, first_material = len(scene.textures), len(scene.materials)
    scene.textures += model.textures
    scene.materials += [_shifted_material(m, first_texture) for m in model.materials]
    scene.meshes += [_shifted_mesh(mesh, first_material) for mesh in model.meshes]
    scene.animations += [name for name in model.animations if name not in scene.animations]
    scene.hidden += model.hidden
    scene.warnings += model.warnings
    scene.notes += model.notes


def _shifted_mesh(mesh: Mesh, first_material: int) -> Mesh:
    return replace(mesh, material=mesh.material + first_material)


def _shifted_material(material: Material, first_texture: int) -> Material:
    def shifted(slot: TextureSlot) -> TextureSlot:
        return replace(slot, texture=slot.texture + first_texture)

    slots: dict[str, TextureSlot | None] = {name: getattr(material, name) for name in TEXTURE_SLOTS}
    moved: dict[str, object] = {name: shifted(slot) for name, slot in slots.items() if slot}
    moved["textures"] = {name: shifted(slot) for name, slot in material.textures.items()}
    return replace(material, **moved)  # type: ignore[arg-type]  # the names are its fields'


def _placement(table: ModelTable) -> FloatArray:
    """world_from_model: scale, then rotations about x, y and z, then translation."""
    turned = np.eye(4, dtype=np.float32)
    for axis, degrees in enumerate(table.rotation_deg):
        half = math.radians(degrees) / 2
        quaternion = [0.0, 0.0, 0.0, math.cos(half)]
        quaternion[axis] = math.sin(half)
        turned = transforms.rotation(quaternion) @ turned
    placed: FloatArray = turned * np.array([table.scale] * 3 + [1.0], np.float32)
    placed[:3, 3] = table.translation
    return placed


def _moved_light(light: Light, world_from_model: FloatArray) -> Light:
    return replace(
        light,
        position=transforms.transform_points(world_from_model, light.position[None])[0],
        direction=_unit(transforms.transform_vectors(world_from_model, light.direction[None])[0]),
    )


def _light_frame(light: Light) -> FloatArray:
    """world_from_light: -z is where it shines."""
    position = light.position.astype(np.float64)  # far away, a step of 1 m is none in 32 bits
    return transforms.inverse(transforms.look_at(position, position + light.direction))


def _light_turn(light: Light) -> FloatArray:
    """`_light_frame` without its place."""
    turned = _light_frame(light)
    turned[:3, 3] = 0.0
    return turned


def _moved_camera(camera: Camera, world_from_model: FloatArray, others: list[Camera]) -> Camera:
    """The camera in the world, under a name that no other has; the scale moves it only."""
    world_from_view = world_from_model @ camera.world_from_view
    world_from_view[:3, :3] /= np.linalg.norm(world_from_view[:3, :3], axis=0)
    return replace(
        camera,
        name=unique_name(camera.name, {other.name for other in others}),
        world_from_view=world_from_view,
    )


def _camera(table: CameraTable) -> Camera:
    view_from_world = transforms.look_at(table.eye, table.target, table.up)
    return Camera(
        name=table.name,
        world_from_view=transforms.inverse(view_from_world),
        fov_y=math.radians(table.fov_y_deg),
        near=table.near,
        far=table.far,
    )


def _camera_path(table: PathTable) -> CameraPath:
    return CameraPath(
        times=np.array([key.time for key in table.keys], np.float64),
        eyes=np.array([key.eye for key in table.keys], np.float32),
        targets=np.array([key.target for key in table.keys], np.float32),
        fov_y=math.radians(table.fov_y_deg),
        near=table.near,
        loop=table.loop,
    )


def _light(table: LightTable, index: int, path: Path) -> Light:
    profile = None
    if table.ies is not None:
        with named_by(path, f"lights[{index}].ies", table.ies):
            profile = read_ies(path.parent / table.ies)
    mask = None
    if table.mask is not None:
        with named_by(path, f"lights[{index}].mask", table.mask):
            mask = read_light_mask(path.parent / table.mask)
    away = [0.0, 0.0, -1.0] if profile is None else [0.0, -1.0, 0.0]
    light = Light(
        name=table.name or f"{table.kind}{index}",
        kind=table.kind,
        color=_vec(table.color),
        intensity=1.0 if table.intensity is None else table.intensity,
        position=_vec(table.position or [0.0, 0.0, 0.0]),
        direction=_unit(_vec(table.direction or away)),
        range=table.range or math.inf,
        inner_angle=math.radians(table.inner_angle_deg),
        outer_angle=math.radians(table.outer_angle_deg),
        source_radius=table.source_radius,
        casts_shadow=table.casts_shadow,
        temperature=table.temperature,
        profile=profile,
        roll=math.radians(table.roll_deg),
        mask=mask,
        mask_size=table.mask_size,
        mask_scroll=(table.mask_scroll[0], table.mask_scroll[1]),
    )
    if table.lumen is not None:
        light.intensity = table.lumen / solid_angle(light)
    elif profile is not None and table.intensity is None:
        light.intensity = profile.peak
    return light


def _environment(table: EnvironmentTable, path: Path) -> Environment:
    radiance = None
    if table.file:
        with named_by(path, "environment.file", table.file):
            radiance = read_environment(path.parent / table.file)
    return with_sun(Environment(radiance, _vec(table.tint), table.intensity))


def _vec(values: list[float]) -> FloatArray:
    return np.array(values, np.float32)


def _unit(vector: FloatArray) -> FloatArray:
    wide: npt.NDArray[np.float64] = vector.astype(np.float64)
    return (wide / np.linalg.norm(wide)).astype(np.float32)
