"""Accessors: typed, strided, sparse and normalized views of buffers as numpy arrays."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from elemental.scene.gltf.container import Document
from elemental.scene.gltf.fields import Field
from elemental.scene.model import FloatArray

COMPONENT_DTYPE: dict[int, np.dtype[Any]] = {
    5120: np.dtype("<i1"),
    5121: np.dtype("<u1"),
    5122: np.dtype("<i2"),
    5123: np.dtype("<u2"),
    5125: np.dtype("<u4"),
    5126: np.dtype("<f4"),
}
COMPONENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
MAX_UNBACKED_COUNT = 1 << 24
"""Elements that an accessor without a buffer view may claim: its zeros cost the file nothing."""

RawArray = npt.NDArray[Any]


class Accessors:
    """A document's accessors, each decoded once. The arrays are shared: copy before writing."""

    def __init__(self, document: Document) -> None:
        self._document = document
        self._accessors = document.root.elements("accessors")
        self._floats: dict[int, FloatArray] = {}
        self._integers: dict[int, RawArray] = {}

    def floats(self, reference: Field, widths: tuple[int, ...]) -> FloatArray:
        """Accessor `reference` as (count, width) float32, its width one of `widths`.

        Normalized integers are scaled as the specification says, others converted (which
        KHR_mesh_quantization needs). Values may be NaN or infinite: the caller judges.
        """
        index = reference.index(len(self._accessors), "accessors")
        if index not in self._floats:
            accessor = self._accessors[index]
            raw = self._read(accessor)
            if raw.dtype == np.uint32:
                raise accessor.error("32-bit integers are no vertex attributes")
            normalized = accessor.flag("normalized")
            self._floats[index] = normalize(raw) if normalized else raw.astype(np.float32)
        values = self._floats[index]
        if values.shape[1] not in widths:
            wanted = " or ".join(str(width) for width in widths)
            raise reference.error(f"expected an accessor of {wanted} components")
        return values

    def indices(self, reference: Field) -> RawArray:
        """Accessor `reference` as (count,) unsigned integers."""
        index = reference.index(len(self._accessors), "accessors")
        if index not in self._integers:
            raw = self._read(self._accessors[index])
            if raw.dtype.kind != "u" or raw.shape[1] != 1:
                raise reference.error("expected an accessor of unsigned integer scalars")
            self._integers[index] = raw[:, 0]
        return self._integers[index]

    def is_backed(self, reference: Field) -> bool:
        """Whether a buffer view holds its values; else they are zeros, or stored elsewhere."""
        accessor = self._accessors[reference.index(len(self._accessors), "accessors")]
        return accessor.find("bufferView") is not None

    def is_normalized(self, reference: Field) -> bool:
        """Whether integers stand for fractions; for values stored elsewhere, as by Draco."""
        accessor = self._accessors[reference.index(len(self._accessors), "accessors")]
        return accessor.flag("normalized")

    def _read(self, accessor: Field) -> RawArray:
        dtype = COMPONENT_DTYPE[_component_type(accessor)]
        kind = accessor.need("type").text()
        if kind not in COMPONENTS:
            raise accessor.error(f"expected a type of {', '.join(COMPONENTS)}, not {kind[:20]!r}")
        width = COMPONENTS[kind]
        count = accessor.need("count").integer(low=1)
        view = accessor.index_or_none("bufferView", len(self._document.views), "bufferViews")
        if view is not None:
            offset = accessor.integer_or("byteOffset", 0)
            values = self._strided(accessor, view, offset, (count, width), dtype)
        elif count <= MAX_UNBACKED_COUNT:
            values = np.zeros((count, width), dtype)
        else:
            raise accessor.error(f"{count} elements without a bufferView are too many")
        sparse = accessor.find("sparse")
        return self._overlay(sparse, values) if sparse else values

    def _strided(
        self, owner: Field, view: int, offset: int, shape: tuple[int, int], dtype: np.dtype[Any]
    ) -> RawArray:
        """A contiguous copy of elements `stride` bytes apart, in native byte order."""
        window, stride = self._document.view(view)
        count, width = shape
        element = width * dtype.itemsize
        step = element if stride is None else stride
        if step < element:
            raise owner.error(f"a stride of {step} bytes is less than an element's {element}")
        end = offset + step * (count - 1) + element
        if end > len(window):
            raise owner.error(f"{count} elements end at byte {end} of a view of {len(window)}")
        strides = (step, dtype.itemsize)
        elements: RawArray = np.ndarray(shape, dtype, window, offset, strides)
        return np.array(elements, dtype.newbyteorder("="), order="C")

    def _overlay(self, sparse: Field, values: RawArray) -> RawArray:
        count = sparse.need("count").integer(low=1, high=len(values))
        places, replacements = sparse.need("indices"), sparse.need("values")
        code = _component_type(places)
        if COMPONENT_DTYPE[code].kind != "u":
            raise places.error("expected an unsigned component type")
        rows = self._sparse_part(places, (count, 1), COMPONENT_DTYPE[code])[:, 0]
        if int(rows.max()) >= len(values):
            raise places.error(f"{int(rows.max())} is out of range, there are {len(values)}")
        values[rows] = self._sparse_part(replacements, (count, values.shape[1]), values.dtype)
        return values

    def _sparse_part(self, part: Field, shape: tuple[int, int], dtype: np.dtype[Any]) -> RawArray:
        view = part.need("bufferView").index(len(self._document.views), "bufferViews")
        little_endian = dtype.newbyteorder("<")
        return self._strided(part, view, part.integer_or("byteOffset", 0), shape, little_endian)


def normalize(raw: RawArray) -> FloatArray:
    """Integers as fractions of their type's largest value, not below -1 [glTF 2.0, 3.6.2.4]."""
    if raw.dtype.kind == "f":
        return raw.astype(np.float32)
    scale = np.float32(1.0 / np.iinfo(raw.dtype).max)
    scaled: FloatArray = np.maximum(raw.astype(np.float32) * scale, np.float32(-1.0))
    return scaled


def _component_type(owner: Field) -> int:
    code = owner.need("componentType").integer()
    if code not in COMPONENT_DTYPE:
        raise owner.error(f"componentType {code} is none of {', '.join(map(str, COMPONENT_DTYPE))}")
    return code
