"""The glTF 2.0 importer: a `.gltf` or `.glb` file to a `Scene`."""

from __future__ import annotations

from pathlib import Path

from elemental.scene.gltf import cameras, lights
from elemental.scene.gltf.container import Document
from elemental.scene.gltf.extensions import check_extensions
from elemental.scene.gltf.fields import Field
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
        declared_cameras = document.root.elements("cameras")
        declared_lights = lights.declared_lights(document.root)
        for node in placed_nodes(document):
            _place_mesh(document, node, meshes, scene)
            _place_camera(node, declared_cameras, scene)
            _place_light(node, declared_lights, scene)
        scene.meshes = meshes.meshes
        scene.textures = textures.finish()
    if document.root.elements("animations"):
        document.report.warn("animations", "are ignored; the scene stands still")
    document.report.note_counts()
    scene.warnings, scene.notes = list(document.report.warnings), list(document.report.notes)
    return scene


def _place_mesh(document: Document, node: PlacedNode, meshes: Meshes, scene: Scene) -> None:
    if node.field.find("skin") is not None:
        document.report.warn("skins", "are ignored; meshes stand in their bind pose")
    mesh = node.field.find("mesh")
    if mesh is not None and node.is_singular:
        document.report.count("meshes are left out, whose nodes have a scale of 0")
    elif mesh is not None:
        for index in meshes.use(mesh, node.is_mirrored):
            name = node.name_or(meshes.meshes[index].name)
            scene.instances.append(Instance(name, index, node.world_from_local))


def _place_camera(node: PlacedNode, declared: list[Field], scene: Scene) -> None:
    index = node.field.index_or_none("camera", len(declared), "cameras")
    if index is None:
        return
    name = node.name_or(declared[index].text_or("name", f"camera{index}"))
    name = unique_name(name, {camera.name for camera in scene.cameras})
    camera = cameras.place_camera(declared[index], name, node.world_from_local)
    if camera is not None:
        scene.cameras.append(camera)


def _place_light(node: PlacedNode, declared: list[Field], scene: Scene) -> None:
    extension = node.field.extension(lights.EXTENSION)
    if extension is None:
        return
    index = extension.need("light").index(len(declared), "lights")
    name = node.name_or(declared[index].text_or("name", f"light{index}"))
    scene.lights.append(lights.place_light(declared[index], name, node.world_from_local))
