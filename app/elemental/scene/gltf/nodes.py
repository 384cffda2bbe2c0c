"""The node tree: world transforms of everything that a scene places."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from elemental.core import transforms
from elemental.scene.gltf.container import Document
from elemental.scene.gltf.fields import Field
from elemental.scene.model import FloatArray

AFFINE_ROW = (0.0, 0.0, 0.0, 1.0)
AFFINE_TOLERANCE = 1e-5
SINGULAR_VOLUME = 1e-9
"""Least volume of a transformed unit cube, as a part of its edges' product, that still counts as
three-dimensional [inferred]."""
SHORTEST_EDGE = 1e-15
"""Least length of such an edge: float32 still holds the inverse's cube [inferred]."""


@dataclass(frozen=True)
class PlacedNode:
    """A node that the scene shows, with its transform to the world."""

    field: Field
    index: int
    world_from_local: FloatArray

    def name_or(self, default: str) -> str:
        return self.field.text_or("name", default)

    @property
    def is_singular(self) -> bool:
        return bool(volume_ratio(self.world_from_local) < SINGULAR_VOLUME)

    @property
    def is_mirrored(self) -> bool:
        linear = self.world_from_local[:3, :3].astype(np.float64)
        return bool(np.linalg.det(linear) < 0.0)


def placed_nodes(document: Document) -> Iterator[PlacedNode]:
    """The nodes of the file's default scene, parents first, in the file's order.

    Raises InputError for cycles, for nodes with two parents, and for transforms that overflow.
    """
    nodes = document.root.elements("nodes")
    parents = _parents(nodes)
    pending = [(root, np.eye(4)) for root in reversed(_roots(document, parents))]
    visited: set[int] = set()
    while pending:
        index, world_from_parent = pending.pop()
        node = nodes[index]
        if index in visited:
            raise node.error("is reached twice: a cycle, or a root that is also a child")
        visited.add(index)
        with np.errstate(over="ignore", invalid="ignore"):
            world_from_local = world_from_parent @ _local_matrix(node)
            narrow = world_from_local.astype(np.float32)
        if not np.isfinite(narrow).all():
            raise node.error("its transform to the world overflows")
        yield PlacedNode(node, index, narrow)
        children = [child.integer() for child in node.elements("children")]
        pending += [(child, world_from_local) for child in reversed(children)]


def volume_ratio(world_from_local: FloatArray) -> float:
    """|det| of the linear part over the product of its columns' lengths: 1 where orthogonal."""
    linear = world_from_local[:3, :3].astype(np.float64)
    edges = np.linalg.norm(linear, axis=0)
    if edges.min() < SHORTEST_EDGE:
        return 0.0
    return abs(float(np.linalg.det(linear / edges)))


def _parents(nodes: list[Field]) -> list[int | None]:
    """Each node's parent. Raises InputError for a second one."""
    parents: list[int | None] = [None] * len(nodes)
    for i, node in enumerate(nodes):
        for child in node.elements("children"):
            k = child.index(len(nodes), "nodes")
            if k == i:
                raise child.error("the node is its own child")
            if parents[k] is not None:
                raise child.error(f"node {k} is already a child of node {parents[k]}")
            parents[k] = i
    return parents


def _roots(document: Document, parents: list[int | None]) -> list[int]:
    scenes = document.root.elements("scenes")
    chosen = document.root.index_or_none("scene", len(scenes), "scenes")
    if scenes:
        scene = scenes[chosen or 0]
        return [node.index(len(parents), "nodes") for node in scene.elements("nodes")]
    roots = [i for i, parent in enumerate(parents) if parent is None]
    if parents and not roots:
        raise document.root.need("nodes").error("every node is a child of another: a cycle")
    return roots


def _local_matrix(node: Field) -> npt.NDArray[np.float64]:
    matrix = node.find("matrix")
    if matrix is not None:
        m = matrix.numbers(16).reshape(4, 4).T.astype(np.float64)
        if np.abs(m[3] - AFFINE_ROW).max() > AFFINE_TOLERANCE:
            raise matrix.error("expected a last row of 0 0 0 1")
        m[3] = AFFINE_ROW
        return m
    translation, rotation, scale = (node.find(k) for k in ("translation", "rotation", "scale"))
    q = rotation.numbers(4) if rotation else np.array(AFFINE_ROW, np.float32)
    if rotation and not q.any():
        raise rotation.error("a quaternion of length 0")
    return transforms.compose(
        translation.numbers(3) if translation else (0.0, 0.0, 0.0),
        q,
        scale.numbers(3) if scale else (1.0, 1.0, 1.0),
    ).astype(np.float64)
