"""What the nodes of a file place in the scene: meshes, lights and cameras."""

from __future__ import annotations

import numpy as np

from elemental.scene.deform import bake, turns_over, use_mirrored
from elemental.scene.gltf import cameras, lights
from elemental.scene.gltf.container import Document
from elemental.scene.gltf.meshes import Meshes
from elemental.scene.gltf.morphs import rest_weights
from elemental.scene.gltf.nodes import PlacedNode
from elemental.scene.gltf.rig import NodeRig
from elemental.scene.gltf.skins import DeclaredSkin, check_joints
from elemental.scene.model import Instance, Scene, unique_name
from elemental.scene.motion import F32, F64, Path


class Placing:
    """Fills a scene from nodes. `held`: values that animations hold; `skins`: as NodeRig's."""

    def __init__(
        self,
        document: Document,
        scene: Scene,
        meshes: Meshes,
        rig: NodeRig,
        held: dict[tuple[int, Path], F64],
        skins: dict[int, tuple[int, DeclaredSkin]],
    ) -> None:
        self._document, self._scene, self._meshes, self._rig = document, scene, meshes, rig
        self._held, self._skins = held, skins
        self._mesh_fields = document.root.elements("meshes")
        self._cameras = document.root.elements("cameras")
        self._lights = lights.declared_lights(document.root)
        self._worlds: dict[int, F32] = {}

    def place(self, nodes: list[PlacedNode]) -> None:
        """Append what the nodes hold to the scene."""
        self._worlds = {node.index: node.world_from_local for node in nodes}
        for node in nodes:
            self._place_camera(node)
            if node.visible:
                self._place_meshes(node)
                self._place_light(node)
            elif node.field.find("mesh") is not None:
                self._document.report.count("meshes are left out, whose nodes are invisible")
                self._scene.hidden += 1

    def _place_meshes(self, node: PlacedNode) -> None:
        reference = node.field.find("mesh")
        if reference is None:
            return
        worn = self._skins.get(node.index)
        moves = node.index in self._rig.moving
        flat = node.is_singular and not moves
        mirrored = node.is_mirrored and not moves and worn is None
        for index in self._meshes.use(reference, mirrored):
            mesh = self._meshes.meshes[index]
            name = node.name_or(mesh.name)
            weights = self._rest_weights(node, index)
            if worn is not None and mesh.influences is not None:
                check_joints(mesh.influences, worn[1], self._mesh_fields[reference.integer()])
                self._place_skinned(name, index, node, worn, weights)
                continue
            if worn is not None:
                node.field.warn("has a skin, but its mesh no JOINTS_0; the skin is ignored")
            if flat:
                self._place_flat(name, index, node, weights)
                continue
            world = node.world_from_local
            if node.index in self._rig.morphing:
                rig_node = self._rig.node(node.index)
                placed = Instance(name, index, world, True, rig_node, weights=weights)
            elif weights is not None and weights.any():
                placed = bake(self._scene, Instance(name, index, world), world, None, weights)
            else:
                placed = Instance(name, index, world)
            if moves:
                placed.dynamic, placed.node = True, self._rig.node(node.index)
            self._scene.instances.append(placed)

    def _place_flat(self, name: str, index: int, node: PlacedNode, weights: F32 | None) -> None:
        """A mesh without thickness, in the world's directions: matrices have to have inverses."""
        linear, world = node.world_from_local[:3, :3], np.eye(4, dtype=np.float32)
        world[:3, 3] = node.world_from_local[:3, 3]
        flat = self._meshes.flattened(index, linear, weights)
        if flat is None:
            self._document.report.count("meshes are left out, whose scale of 0 leaves no area")
            self._scene.hidden += 1
            return
        self._document.report.count("meshes are drawn flat, whose nodes have a scale of 0")
        self._scene.instances.append(Instance(name, flat, world))

    def _place_skinned(
        self,
        name: str,
        index: int,
        node: PlacedNode,
        worn: tuple[int, DeclaredSkin],
        weights: F32 | None,
    ) -> None:
        """A mesh whose joints place it; its node's own transform is ignored [glTF 2.0, 3.7.3.1]."""
        world = np.eye(4, dtype=np.float32)
        skin = self._rig.skin(worn[0])
        if skin >= 0:
            bends = node.index in self._rig.morphing or (weights is not None and weights.any())
            placed = Instance(name, index, world, True, self._rig.node(node.index), skin,
                              weights if bends else None)  # fmt: skip
        else:
            joints = worn[1].matrices(self._worlds)
            placed = bake(self._scene, Instance(name, index, world), world, joints, weights)
            if turns_over(joints):
                use_mirrored(self._scene, placed)
        self._scene.instances.append(placed)

    def _rest_weights(self, node: PlacedNode, index: int) -> F32 | None:
        """(T,) of a mesh with morph targets, None of another."""
        morphs = self._meshes.meshes[index].morphs
        if morphs is None:
            return None
        held = self._held.get((node.index, "weights"))
        if held is not None:
            return held.astype(np.float32)
        mesh = self._mesh_fields[node.field.need("mesh").integer()]
        return rest_weights(node.field, mesh, len(morphs))

    def _place_camera(self, node: PlacedNode) -> None:
        index = node.field.index_or_none("camera", len(self._cameras), "cameras")
        if index is None:
            return
        name = node.name_or(self._cameras[index].text_or("name", f"camera{index}"))
        name = unique_name(name, {camera.name for camera in self._scene.cameras})
        camera = cameras.place_camera(self._cameras[index], name, node.world_from_local)
        if camera is not None:
            camera.node = self._mover(node)
            self._scene.cameras.append(camera)

    def _place_light(self, node: PlacedNode) -> None:
        extension = node.field.extension(lights.EXTENSION)
        if extension is None:
            return
        index = extension.need("light").index(len(self._lights), "lights")
        name = node.name_or(self._lights[index].text_or("name", f"light{index}"))
        light = lights.place_light(self._lights[index], name, node.world_from_local)
        light.node = self._mover(node)
        self._scene.lights.append(light)

    def _mover(self, node: PlacedNode) -> int:
        return self._rig.node(node.index) if node.index in self._rig.moving else -1
