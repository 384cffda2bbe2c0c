"""Meshes: primitives of any mode as complete triangle lists."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from elemental.scene import mesh_attributes
from elemental.scene.deform import deformed
from elemental.scene.gltf import draco
from elemental.scene.gltf.accessors import Accessors, normalize
from elemental.scene.gltf.container import Document
from elemental.scene.gltf.fields import Field
from elemental.scene.gltf.morphs import read_morphs
from elemental.scene.gltf.skins import read_influences
from elemental.scene.mesh_attributes import Primitive
from elemental.scene.model import ByteArray, FloatArray, IndexArray, Material, Mesh

MODES = {0: "points", 1: "lines", 2: "lines", 3: "lines", 4: "list", 5: "strip", 6: "fan"}
TRIANGLES = 4


class Meshes:
    """A document's meshes. Each primitive is completed on first use, and again if mirrored."""

    def __init__(self, document: Document, accessors: Accessors, materials: list[Material]) -> None:
        self.meshes: list[Mesh] = []
        self._document = document
        self._accessors = accessors
        self._materials = materials
        self._declared_materials = len(document.root.elements("materials"))
        self._fields = document.root.elements("meshes")
        self._made: dict[tuple[int, bool], list[int]] = {}

    def use(self, reference: Field, mirrored: bool) -> list[int]:
        """Indices into `meshes` of the primitives of glTF mesh `reference`."""
        index = reference.index(len(self._fields), "meshes")
        if (index, False) not in self._made:
            self._made[index, False] = self._read_mesh(self._fields[index], index)
        if (index, mirrored) not in self._made:
            copies = [mesh_attributes.mirrored(self.meshes[m]) for m in self._made[index, False]]
            self._made[index, True] = self._append(copies)
        return self._made[index, mirrored]

    def flattened(self, index: int, linear: FloatArray, weights: FloatArray | None) -> int | None:
        """Index of mesh `index` after (3, 3) `linear`, which flattens it; None: no area is left."""
        mesh = self.meshes[index]
        if weights is not None:
            mesh = deformed(mesh, None, weights)
        slot = self._materials[mesh.material].normal_texture
        flat = mesh_attributes.flattened(mesh, linear, slot.uv_set if slot else None)
        return None if flat is None else self._append([flat])[0]

    def _append(self, meshes: list[Mesh]) -> list[int]:
        first = len(self.meshes)
        self.meshes += meshes
        return list(range(first, len(self.meshes)))

    def _read_mesh(self, field: Field, index: int) -> list[int]:
        name = field.text_or("name", f"mesh{index}")
        primitives = list(field.need("primitives"))
        counts = {len(primitive.elements("targets")) for primitive in primitives}
        if len(counts) > 1:
            raise field.error("its primitives differ in their number of morph targets")
        meshes = []
        for k, primitive in enumerate(primitives):
            part = name if len(primitives) == 1 else f"{name}.{k}"
            mesh = self._read_primitive(primitive, part)
            if mesh is not None:
                meshes.append(mesh)
        return self._append(meshes)

    def _read_primitive(self, field: Field, name: str) -> Mesh | None:
        """The primitive as a mesh, or None if it holds no triangle."""
        mode = MODES[field.integer_or("mode", TRIANGLES, high=max(MODES))]
        if mode in ("points", "lines"):
            self._document.report.warn("meshes", "points and lines are not drawn")
            return None
        material = field.index_or_none("material", self._declared_materials, "materials")
        material = self._default_material() if material is None else material
        source = self._compressed(field)
        primitive = self._read_vertices(field, source)
        primitive.indices = self._read_indices(field, source, mode, len(primitive.positions))
        if primitive.influences is None and primitive.morphs is None:  # others may open
            primitive, dropped = mesh_attributes.drop_degenerate(primitive)
            if dropped:
                self._document.report.count("triangles without area are dropped", dropped)
        if not len(primitive.indices):
            return None
        primitive = mesh_attributes.drop_unused_vertices(primitive)
        self._tell_of_missing_uv(primitive, material)
        slot = self._materials[material].normal_texture
        return mesh_attributes.complete(primitive, name, material, slot.uv_set if slot else None)

    def _tell_of_missing_uv(self, primitive: Primitive, index: int) -> None:
        material = self._materials[index]
        textures = [p.name for p in material.definition.parameters if p.kind == "texture"]
        slots = [material.texture(name) for name in textures]
        for uv_set in sorted({slot.uv_set for slot in slots if slot is not None}):
            if (primitive.uv0, primitive.uv1)[uv_set] is None:
                reason = (
                    f"a mesh has no TEXCOORD_{uv_set}: one texel of its textures is all it shows"
                )
                self._document.report.warn(f"materials[{index}]", reason)

    def _compressed(self, field: Field) -> draco.DracoPrimitive | None:
        """The Draco data of a primitive; None, perhaps with a warning, for the plain data."""
        extension = field.extension(draco.EXTENSION)
        if extension is None:
            return None
        position = field.need("attributes").need("POSITION")
        if not draco.is_installed() and self._accessors.is_backed(position):
            reason = f"{draco.EXTENSION} needs DracoPy (the extra [draco]); the plain data is read"
            self._document.report.warn("meshes", reason)
            return None
        return draco.DracoPrimitive(self._document, extension)

    def _default_material(self) -> int:
        """glTF's default material, appended behind the file's own."""
        if len(self._materials) == self._declared_materials:
            self._materials.append(Material("default"))
        return self._declared_materials

    def _read_vertices(self, field: Field, source: draco.DracoPrimitive | None) -> Primitive:
        attributes = field.need("attributes")
        attributes.need("POSITION")
        arrays: dict[str, FloatArray | None] = {}
        for name, widths in {
            "POSITION": (3,), "NORMAL": (3,), "TANGENT": (4,),
            "TEXCOORD_0": (2,), "TEXCOORD_1": (2,), "COLOR_0": (3, 4),
        }.items():  # fmt: skip
            arrays[name] = self._read_attribute(attributes, source, name, widths)
        positions = arrays["POSITION"]
        assert positions is not None
        for name, array in arrays.items():
            if array is not None and len(array) != len(positions):
                raise attributes.need(name).error(
                    f"has {len(array)} vertices, POSITION {len(positions)}"
                )
        if not np.isfinite(positions).all():
            vertex = int(np.flatnonzero(~np.isfinite(positions).all(axis=1))[0])
            raise attributes.need("POSITION").error(f"vertex {vertex} is NaN or infinite")
        return Primitive(
            positions=positions,
            indices=np.empty(0, np.uint32),
            normals=arrays["NORMAL"],
            tangents=arrays["TANGENT"],
            uv0=arrays["TEXCOORD_0"],
            uv1=arrays["TEXCOORD_1"],
            colors=_color_bytes(arrays["COLOR_0"]),
            influences=read_influences(
                attributes,
                lambda name: self._read_attribute(attributes, source, name, (4,)),
                len(positions),
            ),
            morphs=read_morphs(self._document, field, self._accessors, len(positions)),
        )

    def _read_attribute(
        self,
        attributes: Field,
        source: draco.DracoPrimitive | None,
        name: str,
        widths: tuple[int, ...],
    ) -> FloatArray | None:
        reference = attributes.find(name)
        if reference is None:
            return None
        values = source.attribute(name) if source else None
        if values is None:
            return self._accessors.floats(reference, widths)
        normalized = self._accessors.is_normalized(reference)
        if values.shape[1] not in widths:
            raise reference.error(f"Draco data of {values.shape[1]} components")
        return normalize(values) if normalized else values.astype(np.float32)

    def _read_indices(
        self, field: Field, source: draco.DracoPrimitive | None, mode: str, vertex_count: int
    ) -> IndexArray:
        reference = field.find("indices")
        if source is not None:
            indices = source.indices
        elif reference is not None:
            indices = self._accessors.indices(reference)
        else:
            indices = np.arange(vertex_count, dtype=np.uint32)
        if len(indices) and int(indices.max()) >= vertex_count:
            raise (reference or field).error(
                f"index {int(indices.max())} is out of range, there are {vertex_count} vertices"
            )
        if source is None and mode != "list":
            return triangles_of(mode, indices)
        if len(indices) % 3:
            field.warn(f"{len(indices)} indices are no multiple of 3; the last ones are ignored")
        return indices[: len(indices) // 3 * 3].astype(np.uint32)


def triangles_of(mode: str, indices: npt.NDArray[Any]) -> IndexArray:
    """A "strip" or "fan" as a triangle list, in glTF's corner order (3.7.2.1)."""
    i = np.arange(max(len(indices) - 2, 0))
    corners = (i, i + 1 + i % 2, i + 2 - i % 2) if mode == "strip" else (i + 1, i + 2, 0 * i)
    triangles: IndexArray = indices[np.stack(corners, axis=1).reshape(-1)].astype(np.uint32)
    return triangles


def _color_bytes(colors: FloatArray | None) -> ByteArray | None:
    """Linear (N, 3 or 4) colours as (N, 4) bytes."""
    if colors is None:
        return None
    quantized = np.full((len(colors), 4), 255, np.uint8)
    levels = np.clip(np.nan_to_num(colors, nan=1.0), 0.0, 1.0) * 255.0 + 0.5
    quantized[:, : colors.shape[1]] = levels.astype(np.uint8)
    return quantized
