"""AP-03: the document: undo and redo of everything, gestures as one step, saved and unsaved."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from elemental.core.errors import InputError
from elemental.scene.materials import Material
from elemental.settings import Settings
from elemental.ui.document import LONGEST_HISTORY, Document, State, same


def fresh() -> Document:
    """Two materials, default settings."""
    return Document(State(Settings(), (Material("stone"), Material("clay"))))


def test_a_gesture_is_one_step_and_another_one_another() -> None:
    document = fresh()
    for value in (0.5, 1.0, 1.5):
        document.set("exposure", value, gesture="drag")
    assert document.in_gesture
    document.settle()
    document.set("exposure", 2.0, gesture="drag")
    document.settle()
    assert document.steps == 2
    assert document.undo() == "exposure"
    assert document.state.settings["exposure"] == 1.5
    document.undo()
    assert document.state.settings["exposure"] == 0.0
    assert document.undo() is None


def test_a_gesture_that_comes_back_is_no_step() -> None:
    document = fresh()
    document.set("exposure", 1.0, gesture="drag")
    document.set("exposure", 0.0, gesture="drag")
    document.settle()
    assert document.steps == 0
    assert not document.unsaved


def test_gestures_of_two_widgets_do_not_merge() -> None:
    document = fresh()
    document.set("exposure", 1.0, gesture=1)
    document.set("sky.intensity", 2.0, gesture=2)
    assert document.steps == 2


def test_an_edit_after_undo_forgets_what_was_undone() -> None:
    document = fresh()
    document.set("exposure", 1.0)
    document.undo()
    document.set("exposure", 2.0)
    assert document.redo_label is None
    assert document.undo_label == "exposure"


def test_values_not_histories_tell_what_is_unsaved() -> None:
    document = fresh()
    document.set("exposure", 1.0)
    assert document.unsaved
    document.set("exposure", 0.0)
    assert not document.unsaved
    bright = replace(document.state.materials[0], emissive=np.ones(3, np.float32))
    document.set_material(0, bright)
    assert document.unsaved
    document.mark_saved()
    assert not document.unsaved
    document.set_material(0, replace(bright, emissive=np.ones(3, np.float32)))
    assert not document.unsaved
    document.undo()
    assert document.unsaved


def test_a_refused_value_is_no_step() -> None:
    document = fresh()
    with pytest.raises(InputError, match="exposure"):
        document.set("exposure", 99.0)
    assert document.steps == 0
    document.set("exposure", 1.0)
    document.refuse()
    assert (document.steps, document.redo_label) == (0, None)


def test_history_is_bounded() -> None:
    document = fresh()
    for k in range(LONGEST_HISTORY + 10):
        document.set("gi.bounces", k % 7 + 1)
    assert document.steps <= LONGEST_HISTORY


def test_revert_is_a_step() -> None:
    document = fresh()
    document.set("exposure", 1.0)
    document.revert()
    assert not document.unsaved
    document.undo()
    assert document.state.settings["exposure"] == 1.0


EDITS = st.lists(
    st.one_of(
        st.tuples(st.just("set"), st.floats(-16, 16), st.sampled_from([None, 1, 2])),
        st.tuples(st.just("material"), st.floats(0, 1), st.sampled_from([None, 3])),
        st.tuples(st.sampled_from(["undo", "redo", "settle", "revert"])),
    )
)


@given(EDITS)
def test_undo_leads_back_to_the_start_and_redo_to_the_end(edits: list[tuple[object, ...]]) -> None:
    document = fresh()
    start = document.state
    for name, *rest in edits:
        if name == "set":
            document.set("exposure", rest[0], rest[1])
        elif name == "material":
            changed = replace(document.state.materials[1], roughness=rest[0])
            document.set_material(1, changed, rest[1])
        else:
            getattr(document, str(name))()
    document.settle()
    while document.redo():
        pass
    end = document.state
    passed = [end]
    while document.undo():
        passed.append(document.state)
    assert same(document.state, start)
    assert all(not same(a, b) for a, b in pairwise(passed))
    while document.redo():
        pass
    assert document.state is end
