"""docs/talk-coverage.md has one true line for each system of the talk."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
DOCUMENT = ROOT / "docs" / "talk-coverage.md"

ROWS = {"GI": 16, "SH": 10, "PP": 12, "PA": 9, "AP": 5}
"""Systems of the talk by group: GI-01 to GI-16 and so on."""
IDS = [f"{group}-{k:02d}" for group, count in ROWS.items() for k in range(1, count + 1)]

STATES = ("works", "in part", "not yet")


@dataclass(frozen=True)
class Row:
    """One line of the table."""

    id: str
    statement: str
    state: str
    lives: list[str]
    tests: list[str]


def rows(text: str) -> list[Row]:
    """The table lines whose first cell is an id; `lives` and `tests` are the backticked words."""
    found = []
    for line in text.splitlines():
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if re.fullmatch(r"[A-Z]{2}-\d\d", cells[0]) and len(cells) == 5:
            lives, tests = (re.findall(r"`([^`]+)`", cell) for cell in cells[3:])
            found.append(Row(cells[0], cells[1], cells[2], lives, tests))
    return found


def problems(row: Row, root: Path) -> list[str]:
    """What a line says that is not so."""
    found = [f"names {path}, which is missing" for path in row.lives if not (root / path).exists()]
    if row.state not in STATES:
        found.append(f"state {row.state!r}")
    if row.state != "not yet" and not row.lives:
        found.append("names no file")
    if row.state == "works" and not row.tests:
        found.append("works, but names no test")
    if row.state == "not yet" and (row.lives or row.tests):
        found.append("not yet, but names files")
    for name in row.tests:
        path, _, function = name.partition("::")
        if not (root / path).is_file():
            found.append(f"names {path}, which is missing")
            continue
        text = (root / path).read_text(encoding="utf-8")
        if row.id not in text:
            found.append(f"{path} does not mention it")
        if function and not re.search(rf"^\s*def {re.escape(function)}\(", text, re.M):
            found.append(f"{path} has no {function}")
    return found


TABLE = rows(DOCUMENT.read_text(encoding="utf-8"))


def test_each_system_has_one_line_in_order() -> None:
    assert [row.id for row in TABLE] == IDS


@pytest.mark.parametrize("row", TABLE, ids=[row.id for row in TABLE])
def test_the_line_is_true(row: Row) -> None:
    assert problems(row, ROOT) == []


def unlisted(table: list[Row], tests: Path) -> list[str]:
    """Test files that name a system whose line does not name them."""
    listed = {row.id: {name.partition("::")[0] for name in row.tests} for row in table}
    found = []
    for path in sorted(tests.rglob("test_*.py")):
        name = path.relative_to(tests.parent).as_posix()
        named = set(re.findall(r"\b[A-Z]{2}-\d\d\b", path.read_text(encoding="utf-8")))
        if path.name != Path(__file__).name:
            found += [f"{k}: {name}" for k in sorted(named & set(listed)) if name not in listed[k]]
    return found


def test_each_test_that_names_a_system_is_listed() -> None:
    assert unlisted(TABLE, ROOT / "tests") == []


def test_finds_an_unlisted_test(tmp_path: Path) -> None:
    (tmp_path / "tests").mkdir()
    (tmp_path / "tests" / "test_a.py").write_text("# GI-02\n")
    (row,) = rows("| GI-02 | x | works | `glsl/a.glsl` | `tests/test_b.py` |")
    assert unlisted([row], tmp_path / "tests") == ["GI-02: tests/test_a.py"]


@pytest.mark.parametrize(
    ("line", "complaint"),
    [
        ("| GI-01 | x | works | `glsl/none.glsl` | `tests/t.py` |", "none.glsl, which is missing"),
        ("| GI-01 | x | works | `glsl/a.glsl` | |", "names no test"),
        ("| GI-01 | x | works | `glsl/a.glsl` | `tests/t.py::test_b` |", "has no test_b"),
        ("| GI-02 | x | works | `glsl/a.glsl` | `tests/t.py` |", "does not mention it"),
        ("| GI-01 | x | perhaps | `glsl/a.glsl` | |", "state 'perhaps'"),
        ("| GI-01 | x | not yet | `glsl/a.glsl` | |", "but names files"),
    ],
)
def test_finds_an_untrue_line(tmp_path: Path, line: str, complaint: str) -> None:
    (tmp_path / "glsl").mkdir()
    (tmp_path / "glsl" / "a.glsl").touch()
    (tmp_path / "tests").mkdir()
    (tmp_path / "tests" / "t.py").write_text("def test_a():  # GI-01\n    pass\n")
    (row,) = rows(line)
    assert complaint in "; ".join(problems(row, tmp_path))
