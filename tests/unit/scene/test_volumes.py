# PP-11
"""Blending of post-process volumes equals a model in numpy, in every property."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from elemental.core import transforms
from elemental.scene.volumes import Volume, blend, rotation_rows
from elemental.settings import SETTINGS, Settings
from unit.scene.volume_values import OVERRIDABLE, coordinates, overrides, values_of, volumes

ROUNDING = 1e-9
"""Relative; both sides compute in double precision."""


def model_weight(volume: Volume, eye: tuple[float, float, float]) -> float:
    """The weight by matrices: the eye in the volume's space, its distance by clamping."""
    if not volume.enabled:
        return 0.0
    if volume.unbound:
        return volume.blend_weight
    x, y, z = np.radians(volume.rotation_deg)
    about_x = [[1, 0, 0], [0, np.cos(x), -np.sin(x)], [0, np.sin(x), np.cos(x)]]
    about_y = [[np.cos(y), 0, np.sin(y)], [0, 1, 0], [-np.sin(y), 0, np.cos(y)]]
    about_z = [[np.cos(z), -np.sin(z), 0], [np.sin(z), np.cos(z), 0], [0, 0, 1]]
    local = (np.array(about_z) @ about_y @ about_x).T @ (np.array(eye) - volume.center)
    if volume.shape == "box":
        half = np.array(volume.size) / 2
        distance = float(np.linalg.norm(local - np.clip(local, -half, half)))
    else:
        distance = max(float(np.linalg.norm(local)) - volume.radius, 0.0)
    if distance < 1e-12:
        return volume.blend_weight
    share = 1.0 - distance / volume.blend_radius if volume.blend_radius > 0.0 else 0.0
    return volume.blend_weight * float(np.clip(share, 0.0, 1.0))


def model_shares(
    key: str, listed: list[Volume], eye: tuple[float, float, float], base: Settings
) -> list[tuple[Any, float]]:
    """(value, share) of the base and of each volume for one setting: w_i prod_{j > i} (1 - w_j)."""
    having = [volume for volume in listed if key in volume.overrides]
    by_priority = [having[i] for i in np.argsort([v.priority for v in having], kind="stable")]
    weights = np.array([model_weight(volume, eye) for volume in by_priority])
    left = np.append(np.cumprod(1.0 - weights[::-1])[::-1], 1.0)
    shares = np.append(left[0], weights * left[1:])
    values = [base[key], *(volume.overrides[key] for volume in by_priority)]
    return list(zip(values, shares.tolist(), strict=True))


@given(
    st.lists(volumes(), max_size=6),
    coordinates(),
    overrides(),
)
def test_every_property_equals_the_model(
    listed: list[Volume], eye: tuple[float, float, float], changed: dict[str, Any]
) -> None:
    base = Settings(changed)
    result = blend(base, listed, eye)
    for key, setting in SETTINGS.items():
        parts = model_shares(key, listed, eye, base)
        if setting.kind in ("float", "color", "int"):
            values = np.array([value for value, _ in parts], np.float64)
            expected = np.array([share for _, share in parts]) @ values
            if setting.kind == "int":
                assert abs(result[key] - expected) <= 0.5 + ROUNDING
            else:
                scale = 1.0 + np.abs(values).max()
                assert np.allclose(result[key], expected, rtol=0, atol=ROUNDING * scale), key
            assert result[key] == setting.check(result[key])
        else:
            shares: dict[Any, float] = {}
            for value, share in parts:
                shares[value] = shares.get(value, 0.0) + share
            assert shares[result[key]] >= max(shares.values()) - ROUNDING
            mix = dict(result.mix(key))
            assert math.isclose(sum(mix.values()), 1.0, abs_tol=ROUNDING)
            for value, share in shares.items():
                assert math.isclose(mix.get(value, 0.0), share, abs_tol=ROUNDING)


@pytest.mark.parametrize("setting", OVERRIDABLE, ids=lambda s: s.key)
@given(data=st.data())
def test_one_volume_takes_each_property_from_the_base_to_its_own(setting: Any, data: Any) -> None:
    value = data.draw(values_of(setting))
    volume = Volume("v", unbound=True, overrides={setting.key: value})
    assert blend(Settings(), [volume], (0, 0, 0))[setting.key] == value
    none = blend(Settings(), [replace(volume, blend_weight=0.0)], (0, 0, 0))
    assert none == Settings()


@pytest.mark.parametrize(
    ("shape", "eye", "weight"),
    [
        ("box", (0.9, 0.0, 0.0), 1.0),
        ("box", (1.5, 0.0, 0.0), 0.75),  # half a metre off its face, over two metres
        ("box", (2.0, 3.0, 0.0), 1.0 - math.sqrt(2) / 2),  # off an edge
        ("box", (2.0, 3.0, 4.0), 1.0 - math.sqrt(3) / 2),  # off a corner
        ("box", (3.0, 0.0, 0.0), 0.0),
        ("sphere", (1.0, 1.0, 1.0), 1.0),
        ("sphere", (0.0, 3.0, 0.0), 0.5),
        ("sphere", (0.0, 4.1, 0.0), 0.0),
    ],
)
def test_the_weight_falls_linearly_with_the_distance(
    shape: Any, eye: tuple[float, float, float], weight: float
) -> None:
    volume = Volume("v", shape, size=(2.0, 4.0, 6.0), radius=2.0, blend_radius=2.0)
    assert volume.weight(eye) == pytest.approx(weight)
    halved = replace(volume, blend_weight=0.5)
    assert halved.weight(eye) == pytest.approx(weight / 2)
    assert replace(volume, enabled=False).weight(eye) == 0.0


def test_a_turned_box_reaches_where_it_is_turned_to() -> None:
    box = Volume("v", size=(4.0, 1.0, 1.0), rotation_deg=(0.0, 90.0, 0.0), blend_radius=0.0)
    assert box.weight((0.0, 0.0, 1.9)) == 1.0
    assert box.weight((1.9, 0.0, 0.0)) == 0.0


@given(st.tuples(*[st.floats(-360, 360)] * 3))
def test_rotations_are_about_x_then_y_then_z(degrees: tuple[float, float, float]) -> None:
    matrices = []
    for axis, angle in enumerate(np.radians(degrees)):
        quaternion = np.zeros(4)
        quaternion[axis], quaternion[3] = np.sin(angle / 2), np.cos(angle / 2)
        matrices.append(transforms.rotation(quaternion)[:3, :3])
    about_x, about_y, about_z = matrices
    assert np.allclose(rotation_rows(degrees), about_z @ about_y @ about_x, atol=1e-5)


def test_equal_priorities_blend_in_file_order_and_higher_ones_over_them() -> None:
    low = Volume("low", unbound=True, overrides={"exposure": 1.0})
    later = Volume("later", unbound=True, overrides={"exposure": 2.0}, blend_weight=0.5)
    high = Volume("high", unbound=True, overrides={"exposure": 4.0}, blend_weight=0.5, priority=1)
    eye = (0.0, 0.0, 0.0)
    assert blend(Settings(), [low, later], eye)["exposure"] == 1.5
    assert blend(Settings(), [later, low], eye)["exposure"] == 1.0
    for order in ([high, low, later], [low, high, later], [low, later, high]):
        assert blend(Settings(), order, eye)["exposure"] == 2.75


def test_without_a_volume_at_work_the_settings_stay_the_same_object() -> None:
    base = Settings({"exposure": 1.0})
    far = Volume("far", center=(50.0, 0.0, 0.0), overrides={"exposure": 2.0})
    empty = Volume("empty", unbound=True)
    assert blend(base, [], (0, 0, 0)) is base
    assert blend(base, [far, empty], (0, 0, 0)) is base
