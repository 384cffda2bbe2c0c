"""Skins: joints and inverse bind matrices, and how vertices hang on them. [glTF 2.0, 3.7.3]"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass

import numpy as np

from elemental.scene.gltf.accessors import Accessors
from elemental.scene.gltf.container import Document
from elemental.scene.gltf.fields import Field
from elemental.scene.model import FloatArray
from elemental.scene.motion import F32, F64, Influences

MOST_SETS = 2
"""JOINTS_0 and JOINTS_1: eight joints a vertex."""


@dataclass(frozen=True)
class DeclaredSkin:
    """joints: node indices; inverse_bind (J, 4, 4) float64."""

    field: Field
    joints: list[int]
    inverse_bind: F64

    def matrices(self, worlds: Mapping[int, FloatArray]) -> F32:
        """(J, 4, 4) joint matrices by the nodes' world transforms."""
        stacked = np.array([worlds[joint] for joint in self.joints], np.float64)
        matrices: F32 = (stacked @ self.inverse_bind).astype(np.float32)
        return matrices


class Skins:
    """A document's skins, each read and checked once."""

    def __init__(self, document: Document, accessors: Accessors) -> None:
        self._accessors = accessors
        self._fields = document.root.elements("skins")
        self._nodes = document.root.elements("nodes")
        self._read: dict[int, DeclaredSkin] = {}

    def use(self, node: Field, placed: Collection[int]) -> tuple[int, DeclaredSkin] | None:
        """(index, skin) of a node, None without one. `placed`: the nodes that the scene shows."""
        index = node.index_or_none("skin", len(self._fields), "skins")
        if index is None:
            return None
        if index not in self._read:
            self._read[index] = self._skin(self._fields[index], placed)
        return index, self._read[index]

    def _skin(self, field: Field, placed: Collection[int]) -> DeclaredSkin:
        joints = []
        for joint in field.need("joints"):
            joints.append(joint.index(len(self._nodes), "nodes"))
            if joints[-1] not in placed:
                raise joint.error(f"node {joints[-1]} is not in the scene")
        if not joints:
            raise field.error("has no joints")
        reference = field.find("inverseBindMatrices")
        if reference is None:
            return DeclaredSkin(field, joints, np.tile(np.eye(4), (len(joints), 1, 1)))
        raw = self._accessors.floats(reference, (16,)).astype(np.float64)
        if len(raw) < len(joints):
            raise reference.error(f"has {len(raw)} matrices for {len(joints)} joints")
        if not np.isfinite(raw).all():
            raise reference.error("a matrix is NaN or infinite")
        matrices = raw[: len(joints)].reshape(-1, 4, 4).transpose(0, 2, 1).copy()
        matrices[:, 3] = (0.0, 0.0, 0.0, 1.0)
        return DeclaredSkin(field, joints, matrices)


def read_influences(
    attributes: Field, read: Callable[[str], FloatArray | None], count: int
) -> Influences | None:
    """What a primitive's vertices hang on; None where it has no JOINTS_0.

    `read` gives an attribute of four components by its name, compressed or not.
    Weights are brought to a sum of 1; a vertex without any hangs on its first joint.
    """
    sets = [k for k in range(MOST_SETS) if attributes.find(f"JOINTS_{k}") is not None]
    if not sets:
        return None
    if attributes.find(f"JOINTS_{MOST_SETS}") is not None:
        attributes.warn("more than eight joints a vertex are not supported; the others are ignored")
    joints, weights = (
        np.concatenate([_attribute(attributes, f"{kind}_{k}", read, count) for k in sets], 1)
        for kind in ("JOINTS", "WEIGHTS")
    )
    if not np.isfinite(weights).all() or weights.min() < 0.0:
        wrong = ~(np.isfinite(weights) & (weights >= 0.0))
        vertex = int(np.flatnonzero(wrong.any(axis=1))[0])
        raise attributes.error(f"WEIGHTS: vertex {vertex} is negative, NaN or infinite")
    if not weights[:, 4:].any():
        joints, weights = joints[:, :4], weights[:, :4]
    total = weights.sum(axis=1, dtype=np.float64)
    loose = total <= 0.0
    shares = weights / np.where(loose, 1.0, total)[:, None]
    shares[loose, 0] = 1.0
    held = np.where(shares > 0.0, joints, 0.0)
    return Influences(held.astype(np.int32), shares.astype(np.float32))


def check_joints(influences: Influences, skin: DeclaredSkin, primitive: Field) -> None:
    """Raises InputError for a vertex that hangs on a joint that the skin lacks."""
    largest = int(influences.joints.max())
    if largest >= len(skin.joints):
        raise primitive.error(
            f"JOINTS: joint {largest} is out of range, {skin.field.path} has {len(skin.joints)}"
        )


def _attribute(
    attributes: Field, name: str, read: Callable[[str], FloatArray | None], count: int
) -> FloatArray:
    reference, values = attributes.need(name), read(name)
    assert values is not None, "the attribute is there"
    if len(values) != count:
        raise reference.error(f"has {len(values)} vertices, POSITION {count}")
    return values
