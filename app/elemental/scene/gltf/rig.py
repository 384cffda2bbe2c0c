"""The nodes of a file that its animations move, as the nodes of a rig."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

import numpy as np

from elemental.scene.gltf.animations import Clip, tracks_of
from elemental.scene.gltf.nodes import PlacedNode
from elemental.scene.gltf.skins import DeclaredSkin
from elemental.scene.motion import F64, Motion, Path, RigBuilder, Skin


class NodeRig:
    """Which nodes move and bend, and where each is in the rig.

    nodes: those that the scene shows, parents first; held: values by node and path that the clips
    never leave; skins: by the node that wears it, (its index in the file, the skin).
    """

    def __init__(
        self,
        nodes: Sequence[PlacedNode],
        clips: Sequence[Clip],
        held: Mapping[tuple[int, Path], F64],
        skins: Mapping[int, tuple[int, DeclaredSkin]],
    ) -> None:
        channels = [c for clip in clips for c in clip.channels if (c.node, c.path) not in held]
        shown = {node.index for node in nodes}
        self.morphing = {c.node for c in channels if c.path == "weights"} & shown
        """Nodes whose meshes' morph weights change."""
        self.moving = _with_descendants(nodes, {c.node for c in channels if c.path != "weights"})
        """Nodes whose transform to the world changes."""
        self._builder = RigBuilder()
        worn = {
            index: skin
            for node, (index, skin) in skins.items()
            if node in self.morphing or not self.moving.isdisjoint(skin.joints)
        }
        needed = self.moving | self.morphing
        needed.update(joint for skin in worn.values() for joint in skin.joints)
        self._rig_of: dict[int, int] = {}
        for node in nodes:
            if node.index in needed:
                self._rig_of[node.index] = self._add(node)
        self._skin_of = {index: number for number, index in enumerate(worn)}
        for skin in worn.values():
            joints = np.array([self._rig_of[joint] for joint in skin.joints], np.int64)
            self._builder.skins.append(Skin(joints, skin.inverse_bind))
        self._builder.tracks = tracks_of(clips, held, self._rig_of)

    def node(self, index: int) -> int:
        """The rig's node for a node of the file; -1 where it stands still."""
        return self._rig_of.get(index, -1)

    def skin(self, index: int) -> int:
        """The motion's skin for one of the file; -1 where its joints stand still."""
        return self._skin_of.get(index, -1)

    def motion(self) -> Motion | None:
        """All of it; None where nothing moves."""
        return self._builder.motion()

    def _add(self, node: PlacedNode) -> int:
        place = node.place
        parent = -1 if node.parent is None else self._rig_of.get(node.parent, -1)
        offset = place.offset if parent >= 0 else node.world_from_parent @ place.offset
        return self._builder.node(parent, offset, place.translation, place.rotation, place.scale)


def _with_descendants(nodes: Sequence[PlacedNode], targets: Collection[int]) -> set[int]:
    moving: set[int] = set()
    for node in nodes:
        if node.index in targets or node.parent in moving:
            moving.add(node.index)
    return moving
