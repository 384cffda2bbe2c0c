"""Layouts parsed from GLSL, without a driver (tests/gpu/test_layouts.py asks one)."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from elemental.core.layout import Layouts, layouts, pack, pack_array

SOURCE = """
const uint SIDE = 3u; // texels
const uint TEXELS = SIDE * SIDE * (1u << 1u);
const float HALF_PI = 1.5;
#define RATIO 0.25f
struct Cone { vec3 direction; float weight; vec2 spread[SIDE]; };
layout(std140) uniform Trace {
    mat4 clip_from_world; /* a matrix */
    mat3 basis;
    vec3 up;
    float step;
    float weights[2];
    Cone cone;
    bool on;
} u_trace;
layout(std430) readonly buffer Cones { uint count; uint size; Cone cones[]; };
"""


@pytest.fixture
def parsed(tmp_path: Path) -> Layouts:
    (tmp_path / "trace.glsl").write_text(SOURCE)
    return Layouts(tmp_path)


def test_constants_are_evaluated_in_any_order(tmp_path: Path) -> None:
    (tmp_path / "a.glsl").write_text("const uint B = A * 2u; const float H = 1.0 / 2;")
    (tmp_path / "b.glsl").write_text("const uint A = 0x10u; const int N = -7 / 2 ;")
    found = Layouts(tmp_path)
    assert (found.constant("B"), found.constant("H")) == (32, 0.5)


def test_constants(parsed: Layouts) -> None:
    assert parsed.constant("TEXELS") == 18
    assert isinstance(parsed.constant("TEXELS"), int)
    assert parsed.constant("RATIO") == 0.25


def test_std430_struct(parsed: Layouts) -> None:
    cone = parsed.struct("Cone")
    assert {n: cone.fields[n][1] for n in cone.names} == {
        "direction": 0,
        "weight": 12,
        "spread": 16,
    }
    assert cone.itemsize == 48  # 16 + 3 * 8, rounded up to vec3's alignment


def test_std140_block(parsed: Layouts) -> None:
    block = parsed.block("Trace")
    assert {n: block.fields[n][1] for n in block.names} == {
        "clip_from_world": 0, "basis": 64, "up": 112, "step": 124, "weights": 128, "cone": 160,
        "on": 224,
    }  # fmt: skip
    assert block.itemsize == 240


def test_a_buffer_block_stops_at_its_runtime_array(parsed: Layouts) -> None:
    assert parsed.block("Cones").names == ("count", "size")


def test_pack_stores_columns_and_pads_lanes(parsed: Layouts) -> None:
    matrix = np.arange(16, dtype=np.float32).reshape(4, 4)
    cone = pack(
        parsed.struct("Cone", "std140"), direction=[1, 2, 3], weight=4, spread=np.ones((3, 2))
    )
    block = pack(
        parsed.block("Trace"), clip_from_world=matrix, basis=np.diag([1, 2, 3]), up=[0, 1, 0],
        step=0.5, weights=[7, 8], cone=cone, on=True,
    )  # fmt: skip
    words = np.frombuffer(block.tobytes(), np.float32)
    np.testing.assert_array_equal(words[:16].reshape(4, 4), matrix.T)
    np.testing.assert_array_equal(words[16:28], [1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 3, 0])
    np.testing.assert_array_equal(words[28:40], [0, 1, 0, 0.5, 7, 0, 0, 0, 8, 0, 0, 0])
    np.testing.assert_array_equal(words[40:44], [1, 2, 3, 4])


def test_pack_array_takes_a_leading_axis(parsed: Layouts) -> None:
    cones = pack_array(
        parsed.struct("Cone"), 2, direction=np.eye(3)[:2], weight=[1, 2], spread=np.zeros((2, 3, 2))
    )
    assert cones["weight"].tolist() == [1, 2]
    assert cones["direction"].tolist() == [[1, 0, 0], [0, 1, 0]]


def test_pack_refuses_missing_unknown_and_misshapen_fields(parsed: Layouts) -> None:
    cone = parsed.struct("Cone")
    with pytest.raises(ValueError, match=r"unknown \['wait'\], missing \['weight'\]"):
        pack(cone, direction=[0, 0, 1], wait=1, spread=np.zeros((3, 2)))
    with pytest.raises(ValueError, match=r"direction: shape \(4,\), not \(3,\)"):
        pack(cone, direction=[0, 0, 1, 0], weight=1, spread=np.zeros((3, 2)))


def test_a_block_must_name_its_rule(tmp_path: Path) -> None:
    (tmp_path / "bad.glsl").write_text("uniform Settings { float a; };")
    with pytest.raises(ValueError, match=r"bad\.glsl: block Settings needs layout\(std140\)"):
        Layouts(tmp_path)


def test_an_unreadable_member_names_the_file(tmp_path: Path) -> None:
    (tmp_path / "bad.glsl").write_text("struct A { float a, b; };")
    with pytest.raises(ValueError, match=r"bad\.glsl: can't read the member 'float a, b'"):
        Layouts(tmp_path)


def test_the_project_s_own_files_parse() -> None:
    assert "View" in layouts().blocks
    assert layouts().structs
