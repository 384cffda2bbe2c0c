"""Between the document and the renderer and the scene's file: apply, save, revert."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from elemental.core.errors import InputError
from elemental.core.paths import named_file
from elemental.frame import OCTREE_KEYS, SHADOW_KEYS, Renderer
from elemental.gpu.device import GpuMemoryError
from elemental.scene.model import Material, Scene
from elemental.scene.named_files import FILE_KEYS
from elemental.scene.save_parts import MaterialChanges
from elemental.scene.save_scene import Changes, save_scene
from elemental.session import Stage, own_settings
from elemental.settings import SETTINGS, Settings
from elemental.ui.document import Document, State, same

REBUILDING = OCTREE_KEYS | SHADOW_KEYS
"""Settings that wait for the mouse's release: taking one over costs more than a frame."""
REOPENING = frozenset({"scene.default_lights", "scene.animation", "sky.image"})
"""Settings that the scene is read by."""


def document_of(stage: Stage) -> Document:
    """The opened scene as a document; what --set assigned is not on disk."""
    scene = stage.scene
    state = State(
        stage.settings,
        tuple(scene.materials),
        tuple(scene.lights),
        tuple(scene.volumes),
        tuple(scene.regions),
    )
    on_disk = replace(state, settings=own_settings(scene))
    return Document(state, on_disk)


class Applied:
    """The state that a renderer shows."""

    def __init__(self, renderer: Renderer, state: State) -> None:
        self.renderer = renderer
        self.state = state

    def take_over(self, document: Document) -> bool:
        """Bring the renderer to the document's state. Returns whether to reopen the scene.

        Raises InputError for what the device has no room for.
        """
        before, after = self.state, document.state
        if after is before:
            return False
        changed = changed_keys(before.settings, after.settings)
        rebuilds = changed & REBUILDING or after.regions is not before.regions
        if rebuilds and document.in_gesture:
            return False
        self.state = after
        if changed & REOPENING:
            return True
        if changed:
            self.renderer.set_settings(after.settings)
        if after.lights is not before.lights:
            self.renderer.set_lights(after.lights)
        if after.volumes is not before.volumes:
            self.renderer.scene.volumes = list(after.volumes)
        if after.regions is not before.regions:
            self.renderer.set_regions(after.regions)
        for index, (old, new) in enumerate(zip(before.materials, after.materials, strict=True)):
            if not same(old, new):
                self._set_material(index, old, new)
        return False

    def _set_material(self, index: int, old: Material, new: Material) -> None:
        try:
            self.renderer.set_material(index, new)
        except GpuMemoryError as error:
            self.renderer.set_material(index, old)
            raise InputError(f"material {new.name}", "", str(error)) from error


def reopening_words(settings: Settings, folder: Path) -> list[str]:
    """``key=value`` of the settings that the scene is read by; files count from ``folder``."""
    values = {key: settings[key] for key in sorted(REOPENING)}
    for key in FILE_KEYS & REOPENING:
        values[key] = str(named_file(values[key], folder.resolve())) if values[key] else ""
    return [f"{key}={SETTINGS[key].value_text(value)}" for key, value in values.items()]


def changed_keys(before: Settings, after: Settings) -> frozenset[str]:
    """Keys whose values differ."""
    if before is after:
        return frozenset()
    return frozenset(key for key in after if after[key] != before[key])


def save(document: Document, scene: Scene, target: Path) -> None:
    """Write the document to the scene file ``target``. Raises InputError."""
    state, saved = document.state, document.saved
    keys = changed_keys(saved.settings, state.settings)
    changes = Changes(
        settings={key: state.settings[key] for key in keys},
        volumes=None if same(state.volumes, saved.volumes) else state.volumes,
        regions=None if same(state.regions, saved.regions) else state.regions,
        lights=None if same(state.lights, saved.lights) else (saved.lights, state.lights),
        materials=(
            None
            if same(state.materials, saved.materials)
            else MaterialChanges(saved.materials, state.materials, scene.textures, scene.decals)
        ),
    )
    save_scene(scene.path, target, changes, scene.folder)
    document.mark_saved()


def default_target(scene: Scene) -> Path:
    """Where "save" writes: the opened scene file, or one beside the opened glTF file."""
    return scene.path.with_suffix(".toml")


def check_target(text: str) -> Path:
    """A typed file name as a path to save to. Raises InputError."""
    path = Path(text).expanduser()
    if not path.suffix:
        path = path.with_suffix(".toml")
    if not path.parent.is_dir():
        raise InputError(path, "", f"the folder {path.parent} does not exist")
    return path
