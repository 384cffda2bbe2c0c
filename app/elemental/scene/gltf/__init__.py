"""The glTF 2.0 importer: a `.gltf` or `.glb` file to a `Scene`."""

from __future__ import annotations

from pathlib import Path

from elemental.scene.gltf import cameras, lights
from elemental.scene.gltf.container import Document
from elemental.scene.gltf.extensions import check_extensions
from elemental.scene.gltf.materials import read_materials
from elemental.scene.gltf.meshes import Meshes
from elemental.scene.gltf.nodes import PlacedNode, placed_nodes
from elemental.scene.gltf.textures import Textures
from elemental.scene.model import Instance, Scene, unique_name

__all__ = ["load_gltf"]


def load_gltf(path: Path) -> Scene:
    """Read the file's default scene. What can't be honoured is said in `Scene.warnings`.

    The scene may be empty. Raises InputError for a missing or broken file.
    """
    document = Document(path)
    check_extensions(document)
    scene = Scene(path.stem, path)
    with Textures(document) as textures:
        scene.materials = read_materials(document, textures)
        meshes = Meshes(document, scene.materials)
        for node in placed_nodes(document):
            _place(document, node, meshes, scene)
        scene.meshes = meshes.meshes
        scene.textures = textures.finish()
    if document.root.elements("animations"):
        document.report.warn("animations", "are ignored; the scene stands still")
    scene.warnings, scene.notes = document.report.warnings, document.report.notes
    return scene


def _place(document: Document, node: PlacedNode, meshes: Meshes, scene: Scene) -> None:
    """Add what a node holds: a mesh, a camera, a light."""
    mesh = node.field.find("mesh")
    if node.field.find("skin") is not None:
        document.report.warn("skins", "are ignored; meshes stand in their bind pose")
    if mesh is not None and node.is_singular:
        document.report.note(node.field.path, "a scale of 0; its mesh is left out")
    elif mesh is not None:
        for index in meshes.use(mesh, node.is_mirrored):
            name = node.name_or(meshes.meshes[index].name)
            scene.instances.append(Instance(name, index, node.world_from_local))
    _place_camera(document, node, scene)
    _place_light(document, node, scene)


def _place_camera(document: Document, node: PlacedNode, scene: Scene) -> None:
    declared = document.root.elements("cameras")
    index = node.field.index_or_none("camera", len(declared), "cameras")
    if index is None:
        return
    name = node.name_or(declared[index].text_or("name", f"camera{index}"))
    taken = {camera.name for camera in scene.cameras}
    camera = cameras.place_camera(declared[index], unique_name(name, taken), node.world_from_local)
    if camera is not None:
        scene.cameras.append(camera)


def _place_light(document: Document, node: PlacedNode, scene: Scene) -> None:
    extension = node.field.extension(lights.EXTENSION)
    if extension is None:
        return
    declared = lights.declared_lights(document.root)
    index = extension.need("light").index(len(declared), "lights")
    name = node.name_or(declared[index].text_or("name", f"light{index}"))
    scene.lights.append(lights.place_light(declared[index], name, node.world_from_local))
