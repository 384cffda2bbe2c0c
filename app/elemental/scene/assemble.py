"""A checked scene file to a `Scene`: its models placed in one world, and what it adds to them."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import numpy.typing as npt

from elemental.core import transforms
from elemental.core.errors import InputError
from elemental.core.images import read_environment
from elemental.scene.gltf import load_gltf
from elemental.scene.model import (
    Camera,
    CameraPath,
    Environment,
    FloatArray,
    Instance,
    Light,
    Material,
    Mesh,
    Region,
    Scene,
    TextureSlot,
    unique_name,
)
from elemental.scene.scene_file import (
    CameraTable,
    EnvironmentTable,
    LightTable,
    ModelTable,
    PathTable,
    SceneFile,
    flat_settings,
    read_scene_file,
)

TEXTURE_SLOTS = (
    "base_color_texture",
    "metallic_roughness_texture",
    "normal_texture",
    "occlusion_texture",
    "emissive_texture",
)


def load_scene_file(path: Path) -> Scene:
    """Read a scene file and everything that it names. Raises InputError."""
    file = read_scene_file(path)
    scene = Scene(file.name or path.stem, path)
    scene.cameras = [_camera(table) for table in file.cameras]
    scene.lights = [_light(table, i) for i, table in enumerate(file.lights)]
    _place_models(scene, file)
    scene.environment = _environment(file.environment, path) if file.environment else None
    scene.exposure_ev = file.exposure_ev
    scene.settings = flat_settings(file.settings)
    scene.camera_path = _camera_path(file.camera_path) if file.camera_path else None
    scene.regions = [
        Region(_vec(region.min), _vec(region.max), region.level_offset) for region in file.regions
    ]
    return scene


def _place_models(scene: Scene, file: SceneFile) -> None:
    """Load each named file once; a second placement shares its meshes."""
    loaded: dict[Path, tuple[Scene, int]] = {}
    for i, table in enumerate(file.models):
        path = scene.path.parent / table.file
        if not path.is_file():
            raise InputError(scene.path, f"models[{i}].file", f"{table.file} does not exist")
        if path not in loaded:
            loaded[path] = load_gltf(path), len(scene.meshes)
            _adopt(scene, loaded[path][0])
        model, first_mesh = loaded[path]
        world_from_model = _placement(table)
        scene.instances += [
            Instance(item.name, first_mesh + item.mesh, world_from_model @ item.world_from_local)
            for item in model.instances
        ]
        scene.lights += [_moved_light(light, world_from_model) for light in model.lights]
        for camera in model.cameras:
            scene.cameras.append(_moved_camera(camera, world_from_model, scene.cameras))


def _adopt(scene: Scene, model: Scene) -> None:
    """Append a model's arrays to the scene's, renumbered."""
    first_texture, first_material = len(scene.textures), len(scene.materials)
    scene.textures += model.textures
    scene.materials += [_shifted_material(m, first_texture) for m in model.materials]
    scene.meshes += [_shifted_mesh(mesh, first_material) for mesh in model.meshes]
    scene.warnings += model.warnings
    scene.notes += model.notes


def _shifted_mesh(mesh: Mesh, first_material: int) -> Mesh:
    return replace(mesh, material=mesh.material + first_material)


def _shifted_material(material: Material, first_texture: int) -> Material:
    slots: dict[str, TextureSlot | None] = {name: getattr(material, name) for name in TEXTURE_SLOTS}
    shifted = {
        name: replace(slot, texture=slot.texture + first_texture)
        for name, slot in slots.items()
        if slot is not None
    }
    return replace(material, **shifted)  # type: ignore[arg-type]  # the names are TextureSlots'


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


def _light(table: LightTable, index: int) -> Light:
    return Light(
        name=table.name or f"{table.kind}{index}",
        kind=table.kind,
        color=_vec(table.color),
        intensity=table.intensity,
        position=_vec(table.position or [0.0, 0.0, 0.0]),
        direction=_unit(_vec(table.direction or [0.0, 0.0, -1.0])),
        range=table.range or math.inf,
        inner_angle=math.radians(table.inner_angle_deg),
        outer_angle=math.radians(table.outer_angle_deg),
        source_radius=table.source_radius,
        casts_shadow=table.casts_shadow,
    )


def _environment(table: EnvironmentTable, path: Path) -> Environment:
    radiance = read_environment(path.parent / table.file) if table.file else None
    return Environment(radiance, _vec(table.tint), table.intensity)


def _vec(values: list[float]) -> FloatArray:
    return np.array(values, np.float32)


def _unit(vector: FloatArray) -> FloatArray:
    wide: npt.NDArray[np.float64] = vector.astype(np.float64)
    return (wide / np.linalg.norm(wide)).astype(np.float32)
