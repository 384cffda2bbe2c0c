"""Reading the desk's scene again: because its file changed, or a setting that it is read by."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from elemental.core.errors import InputError
from elemental.session import Viewpoint, set_stage
from elemental.ui.editor import Applied, document_of, reopening_words

if TYPE_CHECKING:
    from elemental.ui.desk import Desk


def reload(desk: Desk) -> None:
    """Take over the scene's file; a broken one is reported and the old one stays."""
    words = desk.words
    try:
        stage = set_stage(words.scene, words.assignments, Viewpoint(), desk.renderer.size)
    except InputError as error:
        desk.say(str(error), "error")
        return
    desk.images.clear()
    desk.show(stage)
    desk.document = document_of(stage)
    desk.applied = Applied(desk.renderer, desk.document.state)
    desk.say(f"reloaded {stage.scene.name}")


def reopen(desk: Desk) -> None:
    """Read the scene by the document's settings; an edit that can't be had is taken back."""
    document = desk.document
    settings = document.state.settings
    folder = desk.stage.scene.folder
    words = reopening_words(settings, folder)
    try:
        stage = set_stage(desk.words.scene, words, Viewpoint(), desk.renderer.size)
    except InputError as error:
        refuse(desk, error)
        return
    known = desk.stage.scene
    if [m.name for m in stage.scene.materials] != [m.name for m in document.state.materials]:
        refuse(desk, InputError(known.path, "", "has other materials now: R reads it again"))
        return
    stage.scene.folder = folder  # the document's names count from there, wherever it was saved
    # Materials number the textures: those that were chosen since come along.
    stage.scene.textures = known.textures
    stage.scene.materials = list(document.state.materials)
    desk.show(replace(stage, settings=settings))
    read = document_of(stage).state
    if len(read.lights) != len(document.state.lights):  # the default sun comes and goes
        document.follow_lights(read.lights)
    desk.applied = Applied(desk.renderer, replace(read, settings=settings))


def refuse(desk: Desk, error: InputError) -> None:
    """Tell why the newest edit can't be had, and take it back."""
    desk.say(str(error), "error")
    desk.document.refuse()
    desk.applied.state = desk.document.state
    desk.renderer.set_settings(desk.document.state.settings)
