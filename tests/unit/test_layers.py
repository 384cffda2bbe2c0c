"""Imports run one way: core <- {scene, gpu} <- passes <- frame <- ui <- the commands."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parents[2] / "app" / "elemental"

LAYERS = (
    {"__init__"},
    {"core"},
    {"settings"},
    {"scene", "gpu"},
    {"passes"},
    {"frame"},
    {"session", "report", "picture", "remote", "flag_values"},
    {"sequence"},
    {"ui"},
    {"shot", "bench", "listing", "render", "graph_listing", "flags"},
    {"cli"},
    {"__main__"},
)
"""Lowest first. A module imports its own unit and units of lower layers, not its neighbours."""

RANK = {unit: rank for rank, units in enumerate(LAYERS) for unit in units}

OWNERS = {
    "moderngl": {"gpu"},
    "glcontext": {"gpu"},
    "glfw": {"ui"},
    "imgui_bundle": {"ui"},
    "pyrr": {"core"},
    "pydantic": {"scene"},
    "tomlkit": {"scene"},
    "pythonosc": {"remote"},
    "imageio_ffmpeg": {"sequence"},
    "PIL": {"core"},
    "OpenEXR": {"core"},
    "DracoPy": {"scene"},
}
"""The only units that may import a third-party package."""


def imported(tree: ast.AST, package: tuple[str, ...]) -> Iterator[tuple[int, str]]:
    """(line, absolute dotted module) of every import, those inside functions too.

    `package` is the importing module's package, for relative imports.
    """
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from ((node.lineno, alias.name) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = package[: len(package) - node.level + 1] if node.level else ()
            module = ".".join((*base, *((node.module,) if node.module else ())))
            # `from elemental import frame` names a unit, `from elemental.core import x` does not.
            if module == "elemental":
                yield from ((node.lineno, f"elemental.{alias.name}") for alias in node.names)
            else:
                yield node.lineno, module


def unit_of(module: str) -> str:
    """`elemental.gpu.device` -> `gpu`; a name of the package itself -> `__init__`."""
    parts = module.split(".")
    return parts[1] if len(parts) > 1 and parts[1] in RANK else "__init__"


def violations(package: Path) -> list[str]:
    """`file:line: what` of every import that runs up or sideways, and of unknown units."""
    found = []
    for path in sorted(package.rglob("*.py")):
        relative = path.relative_to(package)
        unit = relative.parts[0].removesuffix(".py")
        if unit not in RANK:
            found.append(f"{relative}: {unit} has no layer")
            continue
        tree = ast.parse(path.read_text(encoding="utf-8"))
        for line, module in imported(tree, ("elemental", *relative.parts[:-1])):
            root = module.split(".")[0]
            if root in OWNERS and unit not in OWNERS[root]:
                found.append(f"{relative}:{line}: {unit} imports {root}")
            if root != "elemental":
                continue
            target = unit_of(module)
            if target != unit and RANK[target] >= RANK[unit]:
                found.append(f"{relative}:{line}: {unit} imports {target}")
    return found


def test_imports_run_down() -> None:
    assert violations(PACKAGE) == []


@pytest.mark.parametrize(
    ("file", "text", "complaint"),
    [
        ("core/a.py", "from elemental.gpu.device import Device", "core imports gpu"),
        ("scene/a.py", "import elemental.gpu", "scene imports gpu"),
        ("gpu/a.py", "from elemental.scene.model import Scene", "gpu imports scene"),
        ("gpu/a.py", "from ..passes import shade", "gpu imports passes"),
        ("passes/post/a.py", "def f():\n    from elemental import frame", "passes imports frame"),
        ("frame.py", "from elemental.ui.app import run", "frame imports ui"),
        ("report.py", "from elemental.session import Stage", "report imports session"),
        ("settings.py", "from elemental.scene.model import Scene", "settings imports scene"),
        ("ui/a.py", "import elemental.cli as c", "ui imports cli"),
        ("passes/a.py", "import moderngl", "passes imports moderngl"),
        ("scene/a.py", "from pyrr import Matrix44", "scene imports pyrr"),
        ("extra.py", "", "extra has no layer"),
    ],
)
def test_finds_an_import_that_runs_up(tmp_path: Path, file: str, text: str, complaint: str) -> None:
    path = tmp_path / file
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    found = violations(tmp_path)
    assert len(found) == 1
    assert complaint in found[0]


@pytest.mark.parametrize(
    ("file", "text"),
    [
        ("gpu/a.py", "from elemental.core.layout import pack\nfrom elemental.gpu import formats"),
        ("core/a.py", "from elemental import __version__\nimport numpy"),
        ("passes/a.py", "from elemental.scene.model import Scene\nfrom . import b"),
        ("cli.py", "from elemental.shot import shoot"),
    ],
)
def test_lets_an_import_that_runs_down_pass(tmp_path: Path, file: str, text: str) -> None:
    path = tmp_path / file
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    assert violations(tmp_path) == []
