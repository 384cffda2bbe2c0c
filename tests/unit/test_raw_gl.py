"""Raw GL is touched in gpu/ alone, and no pass speaks of slots or barriers."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2] / "app" / "elemental"


def _offences(text: str) -> Iterator[str]:
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.ImportFrom):
            names = {f"{node.module}.{alias.name}" for alias in node.names} | {node.module}
            if "elemental.gpu.gl" in names:
                yield f"line {node.lineno}: imports gpu.gl"
        elif isinstance(node, ast.Import) and any("gpu.gl" in a.name for a in node.names):
            yield f"line {node.lineno}: imports gpu.gl"
        elif isinstance(node, ast.Attribute):
            raw = node.attr.startswith("gl") and node.attr[2:3].isupper()
            if raw or node.attr == "memory_barrier":
                yield f"line {node.lineno}: calls {node.attr}"


def test_only_gpu_touches_raw_gl() -> None:
    found = {
        f"{path.relative_to(ROOT)}: {offence}"
        for path in ROOT.rglob("*.py")
        if path.relative_to(ROOT).parts[0] != "gpu"
        for offence in _offences(path.read_text())
    }
    assert not found


@pytest.mark.parametrize(
    "text",
    [
        "from elemental.gpu import gl as c",
        "from elemental.gpu.gl import FRAMEBUFFER",
        "import elemental.gpu.gl",
        "device.gl.glBindTexture(1, 2)",
        "device.ctx.memory_barrier()",
    ],
)
def test_an_offence_is_seen(text: str) -> None:
    assert list(_offences(text))


def test_ordinary_code_is_none() -> None:
    assert not list(_offences("from elemental.gpu import formats\nglob.glob('x'); scene.global_x"))
