"""Volumes and overrides as hypothesis draws them."""

from __future__ import annotations

from typing import Any

from hypothesis import strategies as st

from elemental.scene.volumes import Volume
from elemental.settings import SETTINGS, Setting

OVERRIDABLE = [setting for setting in SETTINGS.values() if setting.volume]
ANGLES = st.floats(-360.0, 360.0)
SPANS = st.floats(0.01, 20.0)


def coordinates(reach: float = 10.0) -> st.SearchStrategy[tuple[float, float, float]]:
    """Points within a cube."""
    return st.tuples(*[st.floats(-reach, reach)] * 3)


def values_of(setting: Setting) -> st.SearchStrategy[Any]:
    """Every value that a setting may have; texts are file names."""
    if setting.kind == "bool":
        return st.booleans()
    if setting.kind == "choice":
        return st.sampled_from(setting.choices)
    if setting.kind == "text":
        return st.sampled_from(["", "warm.cube", "luts/cold day.cube", 'q"uote.cube', "ü.cube"])
    assert setting.lo is not None
    assert setting.hi is not None
    if setting.kind == "int":
        return st.integers(int(setting.lo), int(setting.hi))
    number = st.floats(setting.lo, setting.hi)
    return st.tuples(number, number, number) if setting.kind == "color" else number


def overrides(max_size: int = 5) -> st.SearchStrategy[dict[str, Any]]:
    """Some settings with values."""
    pairs = st.sampled_from(OVERRIDABLE).flatmap(
        lambda setting: st.tuples(st.just(setting.key), values_of(setting))
    )
    return st.lists(pairs, max_size=max_size).map(dict)


def volumes(name: str = "v") -> st.SearchStrategy[Volume]:
    """Any volume, its weights often at their ends."""
    return st.builds(
        Volume,
        name=st.just(name),
        shape=st.sampled_from(["box", "sphere"]),
        center=coordinates(),
        rotation_deg=st.tuples(ANGLES, ANGLES, ANGLES),
        size=st.tuples(SPANS, SPANS, SPANS),
        radius=SPANS,
        priority=st.sampled_from([0.0, 1.0, 2.5]),
        blend_radius=st.one_of(st.just(0.0), st.floats(0.0, 10.0)),
        blend_weight=st.one_of(st.sampled_from([0.0, 1.0]), st.floats(0.0, 1.0)),
        enabled=st.booleans(),
        unbound=st.booleans(),
        overrides=overrides(),
    )
