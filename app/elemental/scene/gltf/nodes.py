"""The node tree: world transforms of everything that a scene places."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from elemental.core import transforms
from elemental.scene.gltf.container import Document
from elemental.scene.gltf.fields import Field
from elemental.scene.model import FloatArray
from elemental.scene.motion import Path
from elemental.scene.placement import mirrors, singular

VISIBILITY = "KHR_node_visibility"
AFFINE_ROW = (0.0, 0.0, 0.0, 1.0)
AFFINE_TOLERANCE = 1e-5
NOTHING_HELD: Mapping[tuple[int, Path], npt.NDArray[np.float64]] = {}


@dataclass(frozen=True)
class PlacedNode:
    """A node that the scene shows, with its transform to the world.

    `place`: offset @ T @ R @ S in the frame of its parent, which is None for a root;
    `world_from_parent` (4, 4) float64; `visible`: it and all above it are (KHR_node_visibility).
    """

    field: Field
    index: int
    world_from_local: FloatArray
    place: Place
    parent: int | None
    world_from_parent: npt.NDArray[np.float64]
    visible: bool

    def name_or(self, default: str) -> str:
        return self.field.text_or("name", default)

    @property
    def is_singular(self) -> bool:
        return bool(singular(self.world_from_local))

    @property
    def is_mirrored(self) -> bool:
        return bool(mirrors(self.world_from_local))


@dataclass(frozen=True)
class Place:
    """Where a node stands in its parent: offset (4, 4), or a translation, a rotation as a
    quaternion x, y, z, w, and a scale, float64; the others neutral."""

    offset: npt.NDArray[np.float64]
    translation: npt.NDArray[np.float64]
    rotation: npt.NDArray[np.float64]
    scale: npt.NDArray[np.float64]

    def matrix(self) -> npt.NDArray[np.float64]:
        """(4, 4) parent_from_local."""
        composed = transforms.compose(self.translation, self.rotation, self.scale)
        matrix: npt.NDArray[np.float64] = self.offset @ composed.astype(np.float64)
        return matrix


def placed_nodes(
    document: Document, held: Mapping[tuple[int, Path], npt.NDArray[np.float64]] = NOTHING_HELD
) -> Iterator[PlacedNode]:
    """The nodes of the file's default scene, parents first, in the file's order.

    `held`: values by node and path that replace the file's, of animations that stand still.
    Raises InputError for cycles, for nodes with two parents, and for transforms that overflow.
    """
    nodes = document.root.elements("nodes")
    parents = _parents(nodes)
    pending = [(root, np.eye(4), True) for root in reversed(_roots(document, parents))]
    visited: set[int] = set()
    while pending:
        index, world_from_parent, visible = pending.pop()
        node = nodes[index]
        if index in visited:
            raise node.error("is reached twice: a cycle, or a root that is also a child")
        visited.add(index)
        place = _place(node, index, held)
        with np.errstate(over="ignore", invalid="ignore"):
            world_from_local = world_from_parent @ place.matrix()
            narrow = world_from_local.astype(np.float32)
        if not np.isfinite(narrow).all():
            raise node.error("its transform to the world overflows")
        visibility = node.extension(VISIBILITY)
        visible &= visibility is None or visibility.flag("visible", True)
        yield PlacedNode(node, index, narrow, place, parents[index], world_from_parent, visible)
        children = [child.integer() for child in node.elements("children")]
        pending += [(child, world_from_local, visible) for child in reversed(children)]


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


def _place(
    node: Field, index: int, held: Mapping[tuple[int, Path], npt.NDArray[np.float64]]
) -> Place:
    matrix = node.find("matrix")
    m = np.eye(4)
    if matrix is not None:
        m = matrix.numbers(16).reshape(4, 4).T.astype(np.float64)
        if np.abs(m[3] - AFFINE_ROW).max() > AFFINE_TOLERANCE:
            raise matrix.error("expected a last row of 0 0 0 1")
        m[3] = AFFINE_ROW

    def part(path: Path, default: tuple[float, ...]) -> npt.NDArray[np.float64]:
        if (index, path) in held:
            return held[index, path]
        found = node.find(path) if matrix is None else None
        return found.numbers(len(default)).astype(np.float64) if found else np.array(default)

    rotation = part("rotation", AFFINE_ROW)
    if not rotation.any():
        raise node.need("rotation").error("a quaternion of length 0")
    return Place(m, part("translation", (0.0,) * 3), rotation, part("scale", (1.0,) * 3))
