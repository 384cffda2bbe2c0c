"""Open a scene by name or path, whatever its kind, and check that it can be drawn."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np

from elemental.core.errors import InputError
from elemental.core.files import check_file
from elemental.core.paths import content_root
from elemental.scene.defaults import add_default_lights, is_unlit
from elemental.scene.extent import settle
from elemental.scene.gltf import GLTF_SUFFIXES, load_gltf
from elemental.scene.model import Scene

EVERY_ANIMATION, NO_ANIMATION = "all", "none"
"""Words for which animations play, besides their names."""
SCENE_FILE_SUFFIX = ".toml"

LARGEST_COORDINATE = 1e9
SMALLEST_SIZE = 1e-9
"""Metres. Between these, distances squared stay well inside float32 [inferred]."""


def load_scene(
    name_or_path: str | Path, *, default_lights: bool, animation: str | None = None
) -> Scene:
    """Load a `.gltf`, `.glb` or `.toml` file, or the scene `content/scenes/<name>.toml`.

    `default_lights` adds a sun and a sky to a scene without light, emission or environment.
    `animation`: the one that plays, "all" or "none"; None as the scene file says, else all.
    Raises InputError for whatever can't be opened, read or drawn.
    """
    path = _find(name_or_path)
    suffix = path.suffix.lower()
    if suffix in GLTF_SUFFIXES:
        scene = load_gltf(path, animation or EVERY_ANIMATION)
    elif suffix == SCENE_FILE_SUFFIX:
        # Pydantic and its models take 120 ms to import, which glTF files need not pay.
        from elemental.scene.assemble import load_scene_file  # noqa: PLC0415

        scene = load_scene_file(path, animation)
    else:
        check_file(path)
        raise InputError(path, "", "expected a .gltf, .glb or .toml file")
    if animation is not None:
        _check_animation(scene, animation, "scene.animation")
    else:
        own = str(scene.settings.get("scene.animation", ""))
        _check_animation(scene, own, "settings.scene.animation")
    settle(scene)
    _drop_unused_meshes(scene)
    _check_drawable(scene)
    if default_lights and is_unlit(scene):
        add_default_lights(scene)
    return scene


def scene_names() -> list[str]:
    """Names of the scenes that come with the program, sorted."""
    return sorted(path.stem for path in _content_scenes().glob(f"*{SCENE_FILE_SUFFIX}"))


def _content_scenes() -> Path:
    return content_root() / "scenes"


def _find(name_or_path: str | Path) -> Path:
    path = Path(name_or_path)
    is_there = os.path.exists(name_or_path)  # which takes a name that no file can have for False
    if path.suffix.lower() in (*GLTF_SUFFIXES, SCENE_FILE_SUFFIX) or is_there:
        return path
    if str(name_or_path) in scene_names():
        return _content_scenes() / f"{name_or_path}{SCENE_FILE_SUFFIX}"
    known = ", ".join(scene_names()) or "none"
    raise InputError(str(name_or_path), "", f"neither a file nor one of the scenes: {known}")


def _check_animation(scene: Scene, wanted: str, field: str) -> None:
    if wanted not in ("", EVERY_ANIMATION, NO_ANIMATION, *scene.animations):
        known = ", ".join(scene.animations) or "none"
        reason = f"no animation is named {wanted!r}; known: {known}"
        raise InputError(scene.path, field, reason)


def _drop_unused_meshes(scene: Scene) -> None:
    """Meshes that only served to make others of need no room."""
    used = sorted({instance.mesh for instance in scene.instances})
    number = {mesh: k for k, mesh in enumerate(used)}
    scene.meshes = [scene.meshes[mesh] for mesh in used]
    for instance in scene.instances:
        instance.mesh = number[instance.mesh]


def _check_drawable(scene: Scene) -> None:
    if scene.triangle_count == 0:
        reason = "the scene has no triangles"
        if scene.hidden:
            reason = f"nothing shows: {scene.hidden} meshes are scaled to 0 or hidden at all times"
        raise InputError(scene.path, "", reason)
    with np.errstate(over="ignore", invalid="ignore"):
        low, high = scene.bounds()
    if not (np.isfinite([low, high]).all() and max(-low.min(), high.max()) <= LARGEST_COORDINATE):
        raise InputError(scene.path, "", f"reaches beyond {LARGEST_COORDINATE:g} m")
    size = float((high - low).max())
    if size < SMALLEST_SIZE:
        raise InputError(scene.path, "", f"is only {size:g} m across")
