"""Morph targets: what each adds to a primitive's vertices. [glTF 2.0, 3.7.2.2]"""

from __future__ import annotations

import numpy as np

from elemental.scene.gltf.accessors import Accessors
from elemental.scene.gltf.container import Document
from elemental.scene.gltf.fields import Field
from elemental.scene.model import FloatArray
from elemental.scene.motion import F32, Morphs

ATTRIBUTES = ("POSITION", "NORMAL", "TANGENT")


def read_morphs(
    document: Document, primitive: Field, accessors: Accessors, count: int
) -> Morphs | None:
    """The targets of a primitive of `count` vertices; None where it has none."""
    targets = primitive.elements("targets")
    if not targets:
        return None
    for target in targets:
        named = target.keys()
        for name in named:
            if name not in ATTRIBUTES:
                document.report.warn("meshes", f"morph targets of {name} are ignored")
    positions, normals, tangents = (
        np.stack([_deltas(target, name, accessors, count) for target in targets])
        for name in ATTRIBUTES
    )
    return Morphs(positions, normals, tangents)


def rest_weights(node: Field, mesh: Field, count: int) -> F32:
    """(T,) float32: a node's own weights, else its mesh's, else zeros."""
    for owner in (node, mesh):
        found = owner.find("weights")
        if found is not None:
            return found.numbers(count)
    return np.zeros(count, np.float32)


def _deltas(target: Field, name: str, accessors: Accessors, count: int) -> FloatArray:
    reference = target.find(name)
    if reference is None:
        return np.zeros((count, 3), np.float32)
    values = accessors.floats(reference, (3,))
    if len(values) != count:
        raise reference.error(f"has {len(values)} vertices, POSITION {count}")
    if not np.isfinite(values).all():
        vertex = int(np.flatnonzero(~np.isfinite(values).all(axis=1))[0])
        raise reference.error(f"vertex {vertex} is NaN or infinite")
    return values
