"""The scene's meshes, materials and instances as the arrays that the GPU reads; no GL here."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import groupby
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from elemental.core import transforms
from elemental.core.layout import layouts, pack_array
from elemental.passes.material_pack import CATEGORIES, OwnTexture, draw_state, slot_mask
from elemental.scene.area_lights import AreaLight
from elemental.scene.definitions import MaterialDefinition
from elemental.scene.model import AlphaMode, Scene

Array: TypeAlias = npt.NDArray[Any]

OPAQUE: tuple[AlphaMode, ...] = ("opaque",)
MASKED: tuple[AlphaMode, ...] = ("mask",)
SOLID: tuple[AlphaMode, ...] = ("opaque", "mask")
"""Surfaces that the G-buffer holds."""
BLEND: tuple[AlphaMode, ...] = ("blend",)

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


@dataclass(frozen=True)
class Batch:
    """Draw commands first .. first + count that share fixed state and textures."""

    first: int
    count: int
    alpha_mode: AlphaMode
    dynamic: bool
    """Whether its instances are dynamic; no pose moves those of other batches."""
    receives_decals: bool
    double_sided: bool
    textures: tuple[int, ...]
    """Texture numbers by SLOTS, -1 where a slot is empty."""
    uv_transforms: bool
    """Whether a texture is read by other coordinates than the first set as it is."""
    definition: MaterialDefinition
    own_textures: tuple[OwnTexture, ...]
    instance: int
    """The only instance of a blended batch, else -1."""

    @cached_property
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
        flags=instance_flags(scene, area_lights),
    )


def instance_flags(scene: Scene, area_lights: Sequence[AreaLight]) -> Array:
    """(instances,) uint32: Instance.flags."""
    refuses = np.array([not instance.receives_decals for instance in scene.instances], np.uint32)
    flags = refuses * np.uint32(layouts().constant("INSTANCE_REFUSES_DECALS"))
    area_light = np.uint32(layouts().constant("INSTANCE_AREA_LIGHT"))
    flags[[light.instance for light in area_lights]] |= area_light
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
    """(place in CATEGORIES, dynamic, then Batch's fields from `receives_decals` to `instance`, the
    definition by its key)."""
    instance = scene.instances[number]
    material = scene.materials[scene.meshes[instance.mesh].material]
    category, *state = draw_state(material)
    alone = number if material.alpha_mode == "blend" else -1
    return category, dynamic, instance.receives_decals, *state, alone
