"""The glTF 2.0 importer: a `.gltf` or `.glb` file to a `Scene`."""

from __future__ import annotations

from pathlib import Path

from elemental.core.errors import InputError
from elemental.scene.gltf.accessors import Accessors
from elemental.scene.gltf.animations import chosen_clips, held_values, read_animations
from elemental.scene.gltf.container import Document
from elemental.scene.gltf.extensions import check_extensions
from elemental.scene.gltf.materials import read_materials
from elemental.scene.gltf.meshes import Meshes
from elemental.scene.gltf.nodes import placed_nodes
from elemental.scene.gltf.placing import Placing
from elemental.scene.gltf.rig import NodeRig
from elemental.scene.gltf.skins import Skins
from elemental.scene.gltf.textures import Textures
from elemental.scene.model import Scene

__all__ = ["GLTF_SUFFIXES", "load_gltf"]

GLTF_SUFFIXES = (".gltf", ".glb")


def load_gltf(path: Path, animation: str = "all") -> Scene:
    """Read the file's default scene. What can't be honoured is said in `Scene.warnings`.

    `animation`: the name of the one that plays, or "all"; no such one, and all stand still. What
    moves stands as without its animations until `extent.settle`. The scene may be empty. Raises
    InputError for a missing or broken file, and for one of another suffix.
    """
    if path.suffix.lower() not in GLTF_SUFFIXES:
        raise InputError(path, "", "expected a .gltf or .glb file")
    document = Document(path)
    check_extensions(document)
    accessors = Accessors(document)
    clips = read_animations(document, accessors)
    played = chosen_clips(clips, animation)
    held = held_values(played)
    nodes = list(placed_nodes(document, held))
    shown = {node.index for node in nodes}
    declared = Skins(document, accessors)
    worn = {node.index: declared.use(node.field, shown) for node in nodes}
    skins = {index: skin for index, skin in worn.items() if skin is not None}
    rig = NodeRig(nodes, played, held, skins)
    scene = Scene(path.stem, path, animations=[clip.name for clip in clips])
    with Textures(document) as textures:
        scene.materials = read_materials(document, textures)
        meshes = Meshes(document, accessors, scene.materials)
        scene.meshes = meshes.meshes
        Placing(document, scene, meshes, rig, held, skins).place(nodes)
        scene.textures = textures.finish()
    scene.motion = rig.motion()
    document.report.note_counts()
    scene.warnings, scene.notes = list(document.report.warnings), list(document.report.notes)
    return scene
