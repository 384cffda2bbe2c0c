"""What an artist may edit, as one immutable state with undo and redo. No GL, no widgets."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping
from dataclasses import dataclass, fields, is_dataclass, replace
from typing import Any

import numpy as np

from elemental.core.errors import InputError
from elemental.scene.model import Light, Material, Region
from elemental.scene.volumes import Volume
from elemental.settings import Settings

LONGEST_HISTORY = 1000
"""Steps that can be undone; older ones are forgotten."""


@dataclass(frozen=True)
class State:
    """Everything that can be edited. Replaced as a whole; its parts are never written to."""

    settings: Settings
    materials: tuple[Material, ...] = ()
    lights: tuple[Light, ...] = ()
    volumes: tuple[Volume, ...] = ()
    regions: tuple[Region, ...] = ()


@dataclass(frozen=True)
class Step:
    """An edit: what it is called, and the state on either side."""

    label: str
    before: State
    after: State


class Document:
    """The present state, the one on disk, and the way between them."""

    def __init__(self, state: State, on_disk: State | None = None) -> None:
        """``on_disk`` is what the scene's file says, where that is not ``state``."""
        self.state = state
        self.saved = on_disk or state
        self._undo: list[Step] = []
        self._redo: list[Step] = []
        self._gesture: Hashable = None
        self.problem: InputError | None = None
        """Why the last ``attempt`` was no edit, until someone tells the user."""

    @property
    def unsaved(self) -> bool:
        """Whether the state differs from the one on disk, in values."""
        return not same(self.state, self.saved)

    @property
    def would_be_lost(self) -> bool:
        """Whether there is work of the user's that is not on disk."""
        return bool(self._undo or self._redo) and self.unsaved

    @property
    def in_gesture(self) -> bool:
        """Whether the newest step may still grow: a slider is held."""
        return self._gesture is not None

    @property
    def undo_label(self) -> str | None:
        """What ``undo`` would take back."""
        return self._undo[-1].label if self._undo else None

    @property
    def redo_label(self) -> str | None:
        """What ``redo`` would bring back."""
        return self._redo[-1].label if self._redo else None

    @property
    def steps(self) -> int:
        """Steps that can be undone."""
        return len(self._undo)

    def edit(self, label: str, state: State, gesture: Hashable = None) -> None:
        """Go to ``state``; edits of one ``gesture`` are one step until ``settle``."""
        grows = gesture is not None and gesture == self._gesture
        if not grows:
            self.settle()
            if same(state, self.state):
                return
        before = self._undo.pop().before if grows else self.state
        self._undo.append(Step(label, before, state))
        del self._undo[:-LONGEST_HISTORY]
        self._redo.clear()
        self._gesture = gesture
        self.state = state

    def amend(self, label: str, state: State) -> None:
        """Go to ``state`` by what is no hand's: steps of one label in a row are one."""
        if same(state, self.state):
            return
        newest = self._undo[-1] if self._undo else None
        if newest is not None and newest.label == label:
            self._undo[-1] = Step(label, newest.before, state)
            self._redo.clear()
            self.state = state
        else:
            self.edit(label, state)

    def settle(self) -> None:
        """End the gesture; one that led nowhere is no step."""
        if self._gesture is not None:
            self._gesture = None
            step = self._undo[-1]
            if same(step.before, step.after):
                self._undo.pop()
                self.state = step.before

    def refuse(self) -> None:
        """Take back the newest step for good: what it asks for can't be had."""
        self.undo()
        self._redo.clear()

    def undo(self) -> str | None:
        """Take back the newest step; returns its label."""
        self.settle()
        if not self._undo:
            return None
        step = self._undo.pop()
        self._redo.append(step)
        self.state = step.before
        return step.label

    def redo(self) -> str | None:
        """Bring back the step that was undone last; returns its label."""
        self.settle()
        if not self._redo:
            return None
        step = self._redo.pop()
        self._undo.append(step)
        self.state = step.after
        return step.label

    def revert(self) -> None:
        """Go to the state on disk; a step like others."""
        self.settle()
        self.edit("revert", self.saved)

    def mark_saved(self) -> None:
        """The present state is on disk."""
        self.saved = self.state

    def attempt(self, edit: Callable[[], None]) -> None:
        """Make an edit of what a user typed; one that can't be is a ``problem`` instead."""
        try:
            edit()
        except InputError as error:
            self.problem = error

    # Edits of one part -------------------------------------------------------------------------

    def set(self, key: str, value: Any, gesture: Hashable = None) -> None:
        """Assign a setting. Raises InputError for a value outside its range."""
        self.assign({key: value}, key, gesture)

    def assign(self, values: Mapping[str, Any], label: str, gesture: Hashable = None) -> None:
        """Assign several settings in one step."""
        settings = self.state.settings.replace(values)
        self.edit(label, replace(self.state, settings=settings), gesture)

    def set_material(self, index: int, material: Material, gesture: Hashable = None) -> None:
        """Replace one of the materials."""
        materials = _with(self.state.materials, index, material)
        self.edit(f"material {material.name}", replace(self.state, materials=materials), gesture)

    def set_light(self, index: int, light: Light, gesture: Hashable = None) -> None:
        """Replace one of the lights."""
        lights = _with(self.state.lights, index, light)
        self.edit(f"light {light.name}", replace(self.state, lights=lights), gesture)

    def follow_lights(self, lights: tuple[Light, ...]) -> None:
        """The newest step brought other lights along: they are part of it."""
        self.state = replace(self.state, lights=lights)
        if self._undo:
            newest = self._undo[-1]
            self._undo[-1] = Step(newest.label, newest.before, self.state)

    def set_volumes(
        self, volumes: tuple[Volume, ...], label: str, gesture: Hashable = None
    ) -> None:
        """Replace all volumes."""
        self.edit(label, replace(self.state, volumes=volumes), gesture)

    def amend_volumes(self, volumes: tuple[Volume, ...], label: str) -> None:
        """Replace all volumes as ``amend`` does."""
        self.amend(label, replace(self.state, volumes=volumes))

    def set_volume(self, index: int, volume: Volume, gesture: Hashable = None) -> None:
        """Replace one of the volumes."""
        volumes = _with(self.state.volumes, index, volume)
        self.set_volumes(volumes, f"volume {volume.name}", gesture)

    def set_regions(self, regions: tuple[Region, ...], label: str) -> None:
        """Replace all regions of other voxels."""
        self.edit(label, replace(self.state, regions=regions))

    def set_region(self, index: int, region: Region, gesture: Hashable = None) -> None:
        """Replace one of the regions."""
        regions = _with(self.state.regions, index, region)
        self.edit(f"region {index + 1}", replace(self.state, regions=regions), gesture)


def _with(items: tuple[Any, ...], index: int, item: Any) -> tuple[Any, ...]:
    return (*items[:index], item, *items[index + 1 :])


def same(a: Any, b: Any) -> bool:
    """Whether two states, or parts of states, hold equal values."""
    if a is b:
        return True
    if type(a) is not type(b):
        return False
    if isinstance(a, np.ndarray):
        return bool(np.array_equal(a, b))
    if isinstance(a, tuple | list):
        return len(a) == len(b) and all(same(x, y) for x, y in zip(a, b, strict=True))
    if is_dataclass(a):
        return all(same(getattr(a, f.name), getattr(b, f.name)) for f in fields(a))
    return bool(a == b)
