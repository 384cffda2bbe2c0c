"""The scene's meshes, materials and instances as the arrays that the GPU reads; no GL here."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import Any, NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from elemental.core import transforms
from elemental.core.layout import layouts, pack_array
from elemental.scene.area_lights import AreaLight
from elemental.scene.definitions import VECTORS_MAX, MaterialDefinition
from elemental.scene.model import AlphaMode, Material, Scene, TextureSlot

Array: TypeAlias = npt.NDArray[Any]

CATEGORIES: tuple[AlphaMode, ...] = ("opaque", "mask", "blend")
"""Alpha modes in the order of the draw commands."""

OPAQUE: tuple[AlphaMode, ...] = ("opaque",)
MASKED: tuple[AlphaMode, ...] = ("mask",)
SOLID: tuple[AlphaMode, ...] = ("opaque", "mask")
"""Surfaces that the G-buffer holds."""
BLEND: tuple[AlphaMode, ...] = ("blend",)

SLOTS = ("base_color", "metallic_roughness", "normal", "occlusion", "emissive")
"""Texture slots, in the order of SLOT_* in glsl/shared/material.glsl."""
BASE_COLOR_SLOT = 1
ALL_SLOTS = (1 << len(SLOTS)) - 1
"""MATERIAL_TEXTURES of a shader that samples every slot."""

SURFACE_VERTEX = np.dtype(
    [
        ("a_normal", "<f4", 3),
        ("a_tangent", "<f4", 4),
        ("a_uv0", "<f4", 2),
        ("a_uv1", "<f4", 2),
        ("a_color", "u1", 4),
    ]
)
"""A vertex without its position, which lies in a buffer of its own for depth-only passes."""

DRAW_COMMAND = np.dtype(
    [
        ("count", "<u4"),
        ("instance_count", "<u4"),
        ("first_index", "<u4"),
        ("base_vertex", "<u4"),
        ("base_instance", "<u4"),
    ]
)
"""DrawElementsIndirectCommand (OpenGL 4.3 core, section 10.3.10)."""


@dataclass(frozen=True)
class Geometry:
    """Every mesh of a scene in one set of arrays.

    positions (V, 3) float32, surface (V,) SURFACE_VERTEX, indices (I,) uint32 local to a mesh,
    first_vertex and first_index (M,) by mesh; placed_vertex (N,) by instance: its mesh's first
    vertex, or that of its own copy where it bends.
    """

    positions: Array
    surface: Array
    indices: Array
    first_vertex: Array
    first_index: Array
    placed_vertex: Array


class OwnTexture(NamedTuple):
    """A texture of a definition's own: its name, then the scene's texture or a plain one."""

    name: str
    number: int
    """In Scene.textures, -1 for a plain one."""
    plain: str
    """Of PLAIN_TEXTURES."""
    is_srgb: bool


@dataclass(frozen=True)
class Batch:
    """Draw commands first .. first + count that share fixed state and textures."""

    first: int
    count: int
    alpha_mode: AlphaMode
    dynamic: bool
    """Whether its instances are dynamic; no pose moves those of other batches."""
    double_sided: bool
    textures: tuple[int, ...]
    """Texture numbers by SLOTS, -1 where a slot is empty."""
    uv_transforms: bool
    """Whether a texture is read by other coordinates than the first set as it is."""
    definition: MaterialDefinition
    own_textures: tuple[OwnTexture, ...]
    instance: int
    """The only instance of a blended batch, else -1."""

    @property
    def texture_mask(self) -> int:
        """Bit by SLOTS: the slot has a texture."""
        return slot_mask(texture >= 0 for texture in self.textures)


def bending(scene: Scene) -> list[int]:
    """Numbers of the instances whose vertices move against each other."""
    return [n for n, i in enumerate(scene.instances) if i.skin >= 0 or i.weights is not None]


def pack_geometry(scene: Scene, bending: Sequence[int] = ()) -> Geometry:
    """Merge the scene's meshes, with a copy for each of the instances in `bending`."""
    meshes = scene.meshes
    mesh_of = [instance.mesh for instance in scene.instances]
    copied = meshes + [meshes[mesh_of[number]] for number in bending]
    first = np.cumsum([0, *(len(m.positions) for m in copied)])
    index_counts = np.array([0, *(len(m.indices) for m in meshes)])
    surface = np.empty(int(first[-1]), SURFACE_VERTEX)
    fields = {"a_normal": "normals", "a_tangent": "tangents", "a_uv0": "uv0", "a_uv1": "uv1",
              "a_color": "colors"}  # fmt: skip
    for attribute, name in fields.items():
        surface[attribute] = np.concatenate([getattr(m, name) for m in copied])
    placed = first[mesh_of]
    placed[list(bending)] = first[len(meshes) : -1]
    return Geometry(
        positions=np.concatenate([m.positions for m in copied]).astype("<f4"),
        surface=surface,
        indices=np.concatenate([m.indices for m in meshes]).astype("<u4"),
        first_vertex=first[: len(meshes)],
        first_index=np.cumsum(index_counts)[:-1],
        placed_vertex=placed,
    )


def texture_slots(material: Material) -> tuple[TextureSlot | None, ...]:
    """A material's slots in the order of SLOTS."""
    return tuple(getattr(material, f"{slot}_texture") for slot in SLOTS)


def pack_materials(scene: Scene) -> Array:
    """(materials,) of the GLSL struct Material."""
    materials = scene.materials
    slots = [texture_slots(material) for material in materials]
    rows = np.zeros((len(materials), len(SLOTS), 2, 4), np.float32)
    for number, by_slot in enumerate(slots):
        for index, slot in enumerate(by_slot):
            if slot is not None:
                rows[number, index, :, :3] = slot.uv_from_uv

    def column(name: str) -> list[Any]:
        return [getattr(material, name) for material in materials]

    return pack_array(
        layouts().struct("Material"),
        len(materials),
        base_color=column("base_color"),
        emissive=column("emissive"),
        metallic=column("metallic"),
        roughness=column("roughness"),
        normal_scale=column("normal_scale"),
        occlusion_strength=column("occlusion_strength"),
        alpha_cutoff=column("alpha_cutoff"),
        flags=[_flags(material) for material in materials],
        texture_mask=[slot_mask(s is not None for s in by_slot) for by_slot in slots],
        uv_set_mask=[slot_mask(s is not None and s.uv_set == 1 for s in by_slot)
                     for by_slot in slots],
        uv_row_u=rows[:, :, 0],
        uv_row_v=rows[:, :, 1],
        emission_max=column("emission_max"),
        parameters=[pack_parameters(material) for material in materials],
    )  # fmt: skip


def _flags(material: Material) -> int:
    said = {
        "DOUBLE_SIDED": material.double_sided,
        "MASK": material.alpha_mode == "mask",
        "BLEND": material.alpha_mode == "blend",
    }
    constant = layouts().constant
    return sum(int(constant(f"MATERIAL_{name}")) for name, holds in said.items() if holds)


def slot_mask(held: Iterable[bool]) -> int:
    return sum(1 << index for index, holds in enumerate(held) if holds)


def pack_instances(scene: Scene, area_lights: Sequence[AreaLight] = ()) -> Array:
    """(instances,) of the GLSL struct Instance, in the scene's own order."""
    matrices = np.array([instance.world_from_local for instance in scene.instances])
    normals = np.tile(np.eye(4, dtype=np.float32), (len(matrices), 1, 1))
    normals[:, :3, :3] = [transforms.normal_matrix(matrix) for matrix in matrices]
    return pack_array(
        layouts().struct("Instance"),
        len(matrices),
        world_from_local=matrices,
        normal_from_local=normals,
        prev_world_from_local=matrices,
        material=[scene.meshes[instance.mesh].material for instance in scene.instances],
        flags=area_light_flags(len(matrices), area_lights),
    )


def area_light_flags(instances: int, area_lights: Sequence[AreaLight]) -> Array:
    """(instances,) uint32: Instance.flags."""
    flags = np.zeros(instances, np.uint32)
    flags[[light.instance for light in area_lights]] = layouts().constant("INSTANCE_AREA_LIGHT")
    return flags


def pack_draws(
    scene: Scene, geometry: Geometry, dynamic: Array
) -> tuple[Array, Array, list[Batch]]:
    """(commands (D,) DRAW_COMMAND, instance numbers (N,) uint32 in draw order, batches).

    dynamic (N,) bool by instance number.
    Commands of one batch, batches of one alpha mode, and among those the static and the dynamic
    ones lie together; instances of one mesh share a command unless they bend, but a blended one is
    a batch of its own, to be sorted.
    """
    numbers = range(len(scene.instances))
    mesh_of = [instance.mesh for instance in scene.instances]
    drawn_as = list(zip(mesh_of, geometry.placed_vertex.tolist(), strict=True))
    keys = [_batch_key(scene, number, bool(dynamic[number])) for number in numbers]
    order = sorted(numbers, key=lambda number: (keys[number], drawn_as[number], number))
    commands: list[tuple[int, int, int, int, int]] = []
    batches: list[Batch] = []
    definitions = {m.definition.key: m.definition for m in scene.materials}
    drawn = 0
    for key, batch in groupby(order, key=keys.__getitem__):
        first = len(commands)
        for (mesh, vertex), same in groupby(batch, key=drawn_as.__getitem__):
            size, count = len(scene.meshes[mesh].indices), len(list(same))
            commands.append((size, count, int(geometry.first_index[mesh]), vertex, drawn))
            drawn += count
        *fixed, definition, own, alone = key[1:]
        state = (*fixed, definitions[definition], own, alone)
        batches.append(Batch(first, len(commands) - first, CATEGORIES[key[0]], *state))
    return np.array(commands, DRAW_COMMAND), np.array(order, "<u4"), batches


def _transforms_uv(slot: TextureSlot) -> bool:
    return slot.uv_set != 0 or not np.array_equal(slot.uv_from_uv, np.eye(2, 3))


def instance_boxes(scene: Scene) -> tuple[Array, Array]:
    """(low, high), each (N, 3) m, of every instance's world box."""
    boxes = []
    for instance in scene.instances:
        positions = scene.meshes[instance.mesh].positions
        points = transforms.transform_points(instance.world_from_local, positions)
        boxes.append((points.min(axis=0), points.max(axis=0)))
    low, high = zip(*boxes, strict=True)
    return np.array(low), np.array(high)


def _batch_key(scene: Scene, number: int, dynamic: bool) -> tuple[Any, ...]:
    """(place in CATEGORIES, dynamic, then Batch's fields from `double_sided` to `instance`, the
    definition by its key)."""
    instance = scene.instances[number]
    material = scene.materials[scene.meshes[instance.mesh].material]
    category, *state = draw_state(material)
    alone = number if material.alpha_mode == "blend" else -1
    return category, dynamic, *state, alone


def draw_state(
    material: Material,
) -> tuple[int, bool, tuple[int, ...], bool, str, tuple[OwnTexture, ...]]:
    """What a material asks of the draws that use it.

    (place in CATEGORIES, double-sided, texture numbers by SLOTS, whether they have uv transforms,
    its definition's key, the definition's own textures).
    """
    slots = texture_slots(material)
    textures = tuple(-1 if s is None else s.texture for s in slots)
    transforms_uv = any(s is not None and _transforms_uv(s) for s in slots)
    category = CATEGORIES.index(material.alpha_mode)
    key, own = material.definition.key, own_textures(material)
    return category, material.double_sided, textures, transforms_uv, key, own


def own_textures(material: Material) -> tuple[OwnTexture, ...]:
    """The textures that the material's definition declares beyond SLOTS."""
    found = []
    for parameter in material.definition.textures:
        slot = material.textures.get(parameter.name)
        number = -1 if slot is None else slot.texture
        plain = str(material.value(parameter.name))
        found.append(OwnTexture(parameter.name, number, plain, parameter.is_srgb))
    return tuple(found)


def pack_parameters(material: Material) -> Array:
    """(VECTORS_MAX, 4) float32: the values of the definition's own parameters."""
    floats = np.zeros(4 * VECTORS_MAX, np.float32)
    for name, place in material.definition.places().items():
        value = np.atleast_1d(np.asarray(material.value(name), np.float32))
        floats[place : place + len(value)] = value
    return floats.reshape(VECTORS_MAX, 4)


def opacity(material: Material) -> tuple[object, ...]:
    """What decides where a material lets light through."""
    slot = material.base_color_texture
    texture = None if slot is None else (slot.texture, slot.uv_set, slot.uv_from_uv.tobytes())
    shown = material.alpha_mode, material.alpha_cutoff, float(material.base_color[3]), texture
    if material.alpha_mode == "opaque" or not material.definition.own:
        return shown
    return *shown, material.definition, tuple(material.values.items()), own_textures(material)
