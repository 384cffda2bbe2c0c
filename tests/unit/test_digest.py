"""Fingerprints differ where values do, and only there."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from elemental.core.digest import digest
from elemental.scene.load import load_scene, scene_names

VALUES = st.recursive(
    st.one_of(st.none(), st.booleans(), st.integers(), st.text(max_size=3), st.binary(max_size=3)),
    lambda inner: st.one_of(
        st.lists(inner, max_size=3), st.dictionaries(st.text(max_size=2), inner, max_size=3)
    ),
    max_leaves=6,
)


@dataclass
class Pair:
    a: Any
    b: Any


def same(one: Any, other: Any) -> bool:
    """Equality that tells 1 from True."""
    return repr(one) == repr(other) or (
        isinstance(one, dict)
        and isinstance(other, dict)
        and repr(sorted(one.items(), key=repr)) == repr(sorted(other.items(), key=repr))
    )


@given(VALUES, VALUES)
def test_digests_are_equal_for_equal_values_alone(one: Any, other: Any) -> None:
    assert digest(one) == digest(one)
    if same(one, other):
        assert digest(one) == digest(other)
    elif one != other:
        assert digest(one) != digest(other)


def test_nesting_type_and_shape_count() -> None:
    eight = np.arange(8, dtype=np.float32)
    different = [
        [eight], eight, eight.reshape(2, 4), eight.astype(np.float64), eight[::-1],
        [[1], 2], [1, [2]], [1, 2], ["1", 2], [12], [1.0, 2], Pair(1, 2), Pair(2, 1), {"a": 1},
        {"1": None}, [None], "", b"", [], 0, 0.0, False, Path("a"), {"a"}, {"b"},
    ]  # fmt: skip
    digests = [digest(value) for value in different]
    assert len(set(digests)) == len(different)
    assert digest(Path("a")) == digest("a")


def test_what_has_no_value_is_refused() -> None:
    with pytest.raises(TypeError, match="no digest of object"):
        digest(object())


@pytest.mark.parametrize("name", scene_names())
def test_every_scene_has_a_digest_that_lasts(name: str) -> None:
    scenes = [load_scene(name, default_lights=True) for _ in range(2)]
    assert digest(scenes[0]) == digest(scenes[1])
    scenes[1].materials[0].roughness += 0.001
    assert digest(scenes[0]) != digest(scenes[1])
