"""Flattening of includes, line maps, compiler messages and the parse of declared names."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from elemental.gpu.shaders import (
    Compute,
    Raster,
    ShaderError,
    declared_resources,
    flatten,
    rewrite_messages,
)


@pytest.fixture
def root(tmp_path: Path) -> Path:
    (tmp_path / "lib").mkdir()
    (tmp_path / "lib/b.glsl").write_text("float b() { return 1.0; }\n")
    (tmp_path / "lib/a.glsl").write_text(
        '// first\n#include "lib/b.glsl"\nfloat a() { return b(); }\n'
    )
    (tmp_path / "x.comp.glsl").write_text(
        '#include "lib/a.glsl"\n#include "lib/b.glsl"\nvoid main() {\n  a();\n}\n'
    )
    return tmp_path


def test_each_file_is_joined_once_behind_version_and_defines(root: Path) -> None:
    source = flatten("x.comp.glsl", (("CONES", 9), ("FAST", True), ("STEP", 0.5)), root)
    assert source.text.splitlines() == [
        "#version 430 core", "#define CONES 9", "#define FAST 1", "#define STEP 0.5",
        "// first", "float b() { return 1.0; }", "float a() { return b(); }",
        "void main() {", "  a();", "}",
    ]  # fmt: skip
    assert [file.name for file in source.files] == ["x.comp.glsl", "a.glsl", "b.glsl"]


def test_every_line_knows_its_file_and_line(root: Path) -> None:
    source = flatten("x.comp.glsl", (), root)
    for number, line in enumerate(source.text.splitlines(), 1):
        file, _, at = source.locate(number).rpartition(":")
        if file != "<version>":
            assert (root / file).read_text().splitlines()[int(at) - 1] == line


@pytest.mark.parametrize(
    ("log", "rewritten"),
    [
        ("0:3(7): error: `x' undeclared", "lib/b.glsl:1: error: `x' undeclared"),
        ('0(5) : error C1008: undefined "x"', 'x.comp.glsl:3: error C1008: undefined "x"'),
        ("ERROR: 0:6: 'x' : undeclared", "x.comp.glsl:4: error: 'x' : undeclared"),
        ("WARNING: 0:4: unused", "lib/a.glsl:3: warning: unused"),
        (
            "0:4(1): warning: a\n0:6(1): error: b",
            "lib/a.glsl:3: warning: a\nx.comp.glsl:4: error: b",
        ),
        ("linking failed", "linking failed"),
    ],
)
def test_messages_of_every_driver_name_the_author_s_line(
    root: Path, log: str, rewritten: str
) -> None:
    assert rewrite_messages(log, flatten("x.comp.glsl", (), root)) == rewritten


def test_a_missing_include_names_the_line_that_asks_for_it(root: Path) -> None:
    (root / "y.comp.glsl").write_text('\n#include "lib/gone.glsl"\n')
    with pytest.raises(
        ShaderError, match=r"y\.comp\.glsl:2: can't read .*gone\.glsl: No such file"
    ):
        flatten("y.comp.glsl", (), root)


def test_a_version_line_is_refused(root: Path) -> None:
    (root / "y.comp.glsl").write_text("#version 450\nvoid main() {}\n")
    with pytest.raises(ShaderError, match=r"y\.comp\.glsl:1: .*#version"):
        flatten("y.comp.glsl", (), root)


def test_files_that_include_each_other_end(root: Path) -> None:
    (root / "p.glsl").write_text('#include "q.glsl"\nint p;\n')
    (root / "q.glsl").write_text('#include "p.glsl"\nint q;\n')
    assert flatten("p.glsl", (), root).text.splitlines()[1:] == ["int q;", "int p;"]


def test_declared_names_with_kinds_formats_and_access() -> None:
    found = declared_resources("""
        layout(rgba16f) writeonly uniform image2D o_radiance;  // uniform sampler2D u_no;
        layout(r32ui, binding = 3) uniform coherent readonly uimage3D u_bricks;
        uniform sampler2DShadow u_shadow; uniform usampler2D u_ids[4];
        /* uniform sampler2D u_neither; */
        layout(std140) uniform View { mat4 m; } u_view;
        layout(std430) readonly restrict buffer Nodes { uint nodes[]; };
        buffer Queue { uint q[]; } queue;
        struct Uniform { float buffered; };
    """)
    assert {name: (d.kind, d.image_format, d.access) for name, d in found.items()} == {
        "o_radiance": ("image", "rgba16f", "writeonly"),
        "u_bricks": ("image", "r32ui", "readonly"),
        "u_shadow": ("sampler", None, ""),
        "u_ids": ("sampler", None, ""),
        "View": ("uniform", None, ""),
        "Nodes": ("buffer", None, ""),
        "Queue": ("buffer", None, ""),
    }


def test_descriptions_compare_by_value() -> None:
    assert Compute("a", {"X": 1, "Y": 2}) == Compute("a", {"Y": 2, "X": 1})
    assert hash(Compute("a", {"X": 1})) == hash(Compute("a", {"X": 1}))
    assert Compute("a", {"X": 1}) != Compute("a", {"X": 2})
    assert Raster("a", "b") != Raster("a", "b", "c")
    assert Compute("cone_trace/diffuse.comp.glsl").name == "cone_trace/diffuse"
    assert Raster("full.vert.glsl", "post/tonemap.frag.glsl").name == "post/tonemap"


@given(st.lists(st.text(alphabet="ab \n", max_size=20), min_size=1, max_size=5))
def test_line_maps_hold_for_any_nesting(
    tmp_path_factory: pytest.TempPathFactory, texts: list[str]
) -> None:
    root = tmp_path_factory.mktemp("nest")
    for number, text in enumerate(texts):
        middle = f'#include "{number + 1}.glsl"\n' if number + 1 < len(texts) else ""
        (root / f"{number}.glsl").write_text(f"{text}\n{middle}{text}")
    source = flatten("0.glsl", (), root)
    for number, line in enumerate(source.text.splitlines()[1:], 2):
        file, _, at = source.locate(number).rpartition(":")
        assert (root / file).read_text().splitlines()[int(at) - 1] == line
