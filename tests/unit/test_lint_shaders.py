"""The shader linter finds what it is there to find."""

from __future__ import annotations

from pathlib import Path

from elemental.core.paths import glsl_root
from lint_shaders import (
    described_variants,
    entry_points,
    lint,
    reserved_identifiers,
    switch_variants,
    validate,
)

GOOD = "layout(local_size_x = 1) in;\nvoid main() {}\n"


def test_names_a_broken_line_by_the_author_s_file(tmp_path: Path) -> None:
    (tmp_path / "lib.glsl").write_text("float twice(float x) {\n    return 2.0 * y;\n}\n")
    (tmp_path / "a.comp.glsl").write_text('#include "lib.glsl"\n' + GOOD)
    count, problems = lint(tmp_path, [])
    assert count == 1
    assert "lib.glsl:2" in problems[0]


def test_checks_each_switch_the_other_way(tmp_path: Path) -> None:
    text = "#ifndef EXTRA\n#define EXTRA 0\n#endif\n#if EXTRA\nbroken\n#endif\n" + GOOD
    (tmp_path / "a.comp.glsl").write_text(text)
    assert list(switch_variants(text)) == [(("EXTRA", 1),)]
    assert validate("a.comp.glsl", (), tmp_path) == ""
    assert "a.comp.glsl:5" in validate("a.comp.glsl", (("EXTRA", 1),), tmp_path)
    assert len(lint(tmp_path, [])[1]) == 1


def test_refuses_reserved_identifiers_but_not_in_comments(tmp_path: Path) -> None:
    (tmp_path / "a.glsl").write_text("// a sample\nfloat sampled;\n/* filter\n */ float half;\n")
    assert list(reserved_identifiers(tmp_path)) == [
        "a.glsl:4: 'half' is a reserved word on some driver"
    ]


def test_a_missing_include_is_a_problem(tmp_path: Path) -> None:
    (tmp_path / "a.comp.glsl").write_text('#include "none.glsl"\n' + GOOD)
    assert "a.comp.glsl:1" in "".join(lint(tmp_path, [])[1])


def test_every_described_shader_is_an_entry_point() -> None:
    described = {path for path, _ in described_variants()}
    assert described <= set(entry_points(glsl_root()))
    assert len(described) > 20
