"""Validates every shader with glslangValidator: `python tools/lint_shaders.py`.

Each entry point is flattened by the program's own flattener and checked as it stands, once more
with each of its on/off switches turned the other way, and with the defines of every description
that the passes hold as a module constant. Every material of content/materials is checked in each
pass that takes materials. Identifiers that some drivers reserve are refused.
"""

from __future__ import annotations

import importlib
import pkgutil
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import TypeAlias

from elemental.core.paths import glsl_root
from elemental.gpu.shaders import (
    Compute,
    Define,
    Raster,
    ShaderError,
    flatten,
    rewrite_messages,
)
from elemental.passes.material_snippets import NAME, MaterialSnippet
from elemental.scene.definitions import builtin, definition_names

Defines: TypeAlias = tuple[tuple[str, Define], ...]

STAGES = {"comp": "compute", "vert": "vertex", "frag": "fragment", "geom": "geometry"}
PACKAGES = ("passes", "ui")
"""Packages of elemental whose modules hold shader descriptions."""

TAKES_MATERIAL = "void material(inout Surface s"
"""In the text of every entry point that includes lib/material.glsl."""
DISPLACE = "scene/displace.comp.glsl"

RESERVED = frozenset(
    ["packed", "filter", "sample", "half", "input", "output", "active", "common", "patch"]
)
"""Keywords of GLSL or of a driver's own dialect."""

SWITCH_WITH_DEFAULT = re.compile(r"#\s*ifndef\s+(\w+)\s*\n\s*#\s*define\s+\1\s+([01])\s*\n")
SWITCH = re.compile(r"#\s*if(?:def)?\s+(?:defined\s*\(?\s*)?([A-Z]\w*)\s*\)?\s*\n")
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.S)


def entry_points(root: Path) -> list[str]:
    """Paths of all entry points relative to the GLSL root, sorted."""
    return sorted(
        path.relative_to(root).as_posix()
        for suffix in STAGES
        for path in root.rglob(f"*.{suffix}.glsl")
    )


def switch_variants(text: str) -> Iterator[Defines]:
    """For each on/off switch of a flattened text, the defines that turn it the other way."""
    defaults = {name: int(value) for name, value in SWITCH_WITH_DEFAULT.findall(text)}
    bare = set(SWITCH.findall(text)) - set(re.findall(r"#\s*define\s+(\w+)", text))
    for name in sorted({**defaults, **dict.fromkeys(bare, 0)}):
        yield ((name, 1 - defaults.get(name, 0)),)


def described_programs() -> list[Compute | Raster]:
    """Every description that a module constant holds, once."""
    found: dict[Compute | Raster, None] = {}
    for name in PACKAGES:
        package = importlib.import_module(f"elemental.{name}")
        for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            for value in vars(importlib.import_module(module.name)).values():
                found |= dict.fromkeys(_shaders_in(value))
    return list(found)


def described_variants() -> Iterator[tuple[str, Defines]]:
    """(entry point, defines) of the stages of all described programs."""
    for shader in described_programs():
        for _, path in shader.stages:
            yield path, shader.defines


def _shaders_in(value: object) -> Iterator[Compute | Raster]:
    if isinstance(value, Compute | Raster):
        yield value
    elif isinstance(value, dict):
        for inner in value.values():
            yield from _shaders_in(inner)
    elif isinstance(value, list | tuple):
        for inner in value:
            yield from _shaders_in(inner)


def reserved_identifiers(root: Path) -> Iterator[str]:
    """`file:line: name` of each use of a name that is not to be used."""
    for path in sorted(root.rglob("*.glsl")):
        blank = COMMENT.sub(lambda m: re.sub(r"[^\n]", " ", m[0]), path.read_text("utf-8"))
        for number, line in enumerate(blank.splitlines(), 1):
            for word in re.findall(r"[A-Za-z_]\w*", line):
                if word in RESERVED:
                    where = path.relative_to(root).as_posix()
                    yield f"{where}:{number}: '{word}' is a reserved word on some driver"


def material_variants(root: Path) -> Iterator[tuple[str, Defines, str]]:
    """(entry point, defines, material) of every pass that includes <material>, a material each."""
    takers = [e for e in entry_points(root) if TAKES_MATERIAL in flatten(e, (), root).text]
    for name in definition_names():
        displaces = builtin(name).displacement_m > 0.0
        for entry in takers:
            if displaces or entry != DISPLACE:
                yield entry, (("MATERIAL_FAULTS", 1), ("ALPHA_MASK", 1)), name


def validate(entry: str, defines: Defines, root: Path, material: str = "") -> str:
    """The validator's complaints, with the author's files and lines; empty where it has none."""
    snippets = {NAME: MaterialSnippet(builtin(material)).load()} if material else None
    try:
        source = flatten(entry, defines, root, snippets)
    except ShaderError as error:
        return str(error)
    stage = entry.split(".")[-2]
    done = subprocess.run(
        ["glslangValidator", "--stdin", "-S", stage],
        input=source.text,
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode == 0:
        return ""
    chosen = " ".join([*(f"{name}={value}" for name, value in defines), material])
    return f"{entry} {chosen}\n{rewrite_messages(done.stdout, source)}"


def lint(root: Path, described: list[tuple[str, Defines]]) -> tuple[int, list[str]]:
    """How many programs were checked, and what is wrong."""
    problems = list(reserved_identifiers(root))
    jobs: dict[tuple[str, Defines, str], None] = {(*job, ""): None for job in described}
    if root == glsl_root():
        jobs |= dict.fromkeys(material_variants(root))
    for entry in entry_points(root):
        jobs[entry, (), ""] = None
        try:
            text = flatten(entry, (), root).text
        except ShaderError:
            continue  # validate() reports it
        jobs |= {(entry, variant, ""): None for variant in switch_variants(text)}
    with ThreadPoolExecutor() as pool:
        problems += filter(None, pool.map(lambda job: validate(job[0], job[1], root, job[2]), jobs))
    return len(jobs), problems


def main() -> int:
    """Print what is wrong; 1 if anything is."""
    if shutil.which("glslangValidator") is None:
        print("lint_shaders: glslangValidator is missing: apt-get install glslang-tools")
        return 1
    count, problems = lint(glsl_root(), list(described_variants()))
    for problem in problems:
        print(problem)
    print(f"{count} shader variants, {len(problems)} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
