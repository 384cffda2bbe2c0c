"""The reader of .cube files: what it takes, and one line for what it refuses. PP-09"""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from elemental.core.cube_lut import parse_cube_lut, read_cube_lut
from elemental.core.errors import InputError

CURVES = 'TITLE "a # b"\n# made by hand\nLUT_1D_SIZE 2\nDOMAIN_MAX 2 2 2\n0 0 0\n1 0.5 .25 # end\n'


def test_curves() -> None:
    lut = parse_cube_lut(CURVES, "a.cube")
    assert (lut.size, lut.is_cube) == (2, False)
    np.testing.assert_array_equal(lut.table, [[0, 0, 0], [1, 0.5, 0.25]])
    np.testing.assert_array_equal(lut.high, [2, 2, 2])


def test_in_a_cube_red_changes_fastest() -> None:
    rows = [f"{r} {g} {b}" for b in (0, 1) for g in (0, 1) for r in (0, 1)]
    lut = parse_cube_lut("LUT_3D_SIZE 2\n" + "\n".join(rows), "a.cube")
    assert lut.is_cube
    np.testing.assert_array_equal(lut.table[0, 0, 1], [1, 0, 0])
    np.testing.assert_array_equal(lut.table[1, 0, 0], [0, 0, 1])


@pytest.mark.parametrize(
    ("text", "where", "reason"),
    [
        ("", "", "no LUT_1D_SIZE"),
        ("LUT_3D_SIZE 1", "line 1", "from 2 to 256"),
        ("LUT_3D_SIZE 9999999999", "line 1", "from 2 to 256"),
        ("LUT_3D_SIZE 2 2", "line 1", "expected a size"),
        ("LUT_1D_SIZE 2\nLUT_3D_SIZE 2", "line 2", "a second size"),
        ("0 0 0\nLUT_1D_SIZE 2", "line 1", "colours before"),
        ("LUT_1D_SIZE 2\n0 0 0", "", "1 colours, 2 needed"),
        ("LUT_1D_SIZE 2\n0 0 0\n1 1 1\n1 1 1", "line 4", "more than 2"),
        ("LUT_1D_SIZE 2\n0 0\n1 1 1", "line 2", "three numbers"),
        ("LUT_1D_SIZE 2\n0 0 nan\n1 1 1", "line 2", "three numbers"),
        ("LUT_1D_SIZE 2\nnan 0 0\n1 1 1", "line 2", "three numbers"),
        ("LUT_1D_SIZE 2\n0 0 1e30\n1 1 1", "line 2", "three numbers"),
        ("LUT_1D_SIZE 2\nDOMAIN_MIN 1 1 1\n0 0 0\n1 1 1", "DOMAIN_MAX", "not above"),
        ("LUT_SIZE 2", "line 1", "unknown keyword 'LUT_SIZE'"),
    ],
)
def test_bad_files_are_told_by_line(text: str, where: str, reason: str) -> None:
    with pytest.raises(InputError, match=reason) as caught:
        parse_cube_lut(text, "bad.cube")
    assert (caught.value.file, caught.value.field) == ("bad.cube", where)


def test_a_binary_file_is_refused(tmp_path: Path) -> None:
    (tmp_path / "a.cube").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InputError, match=r"a\.cube: is not UTF-8 text"):
        read_cube_lut(tmp_path / "a.cube")


WORDS = st.sampled_from(
    [
        "LUT_1D_SIZE",
        "LUT_3D_SIZE",
        "DOMAIN_MIN",
        "TITLE",
        "2",
        "3",
        "0.5",
        "-1",
        "nan",
        "1e400",
        "#",
    ]
)
LINES = st.lists(st.lists(WORDS, max_size=4).map(" ".join) | st.text(max_size=12), max_size=12)


@given(LINES.map("\n".join))
def test_any_text_gives_a_table_or_an_input_error(text: str) -> None:
    with suppress(InputError):
        assert np.isfinite(parse_cube_lut(text, "fuzz.cube").table).all()
