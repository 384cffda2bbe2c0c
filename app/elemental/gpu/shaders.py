"""Shader descriptions, include flattening and the mapping of compiler messages to source lines.

moderngl's own includes are one level deep and Mesa drops the file number of ``#line``, so the files
are joined here and the compiler's messages are rewritten to ``file:line``.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from elemental.core.paths import glsl_root
from elemental.gpu.formats import IMAGE_QUALIFIERS

Define = int | float | bool | str
_INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"')
_SNIPPET = re.compile(r"^\s*#\s*include\s+<(\w+)>")
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.S)


class ShaderError(Exception):
    """A shader that can't be read, compiled or bound; the message names file and line."""


@dataclass(frozen=True, slots=True)
class SnippetText:
    """What stands for ``#include <name>``: ``prelude``, then the lines of ``file``.

    ``label`` is what messages call the file.
    """

    prelude: str
    file: Path
    label: str


class Snippet(Protocol):
    """Code of an artist's that shaders take in by ``snippets={"name": key}``.

    The library loads it, compiles every program that uses it, and settles: only if all of them
    compile does the new text count.
    """

    @property
    def file(self) -> Path:
        """Where its text is, present or not."""

    def load(self) -> SnippetText:
        """The text as it is on disk now. Raises ShaderError."""

    def fallback(self, broken: bool) -> SnippetText:
        """What shows loudly that a program never compiled. `broken`: nor could it be loaded."""

    def settle(self, accepted: bool) -> None:
        """Told once after each ``load``, whether what it gave is in use now."""


class _Shader:
    """Base of the two descriptions: hashable, compared by value, hash computed once."""

    __slots__ = ("_hash", "_key", "defines", "name", "snippets", "stages")

    def __init__(
        self,
        stages: tuple[tuple[str, str], ...],
        defines: Mapping[str, Define],
        snippets: Mapping[str, str],
    ) -> None:
        self.stages = stages
        """(stage, path relative to the GLSL root or absolute) pairs."""
        self.defines: tuple[tuple[str, Define], ...] = tuple(sorted(defines.items()))
        self.snippets: tuple[tuple[str, str], ...] = tuple(sorted(snippets.items()))
        """(name in ``#include <name>``, key in the library's ``snippets``) pairs."""
        self._key = (stages, self.defines, self.snippets)
        self._hash = hash(self._key)
        main = Path(stages[-1][1] if stages[0][0] == "compute" else stages[1][1])
        self.name = "/".join((*main.parts[-2:-1], main.name.split(".")[0])).lstrip("/")
        """Short name for timings and debug groups, ``folder/stem``."""

    def __hash__(self) -> int:
        return self._hash

    def __eq__(self, other: object) -> bool:
        return self is other or (isinstance(other, _Shader) and self._key == other._key)

    def __repr__(self) -> str:
        defines = "".join(f" {k}={v}" for k, v in self.defines)
        snippets = "".join(f" <{name}>={Path(key).stem}" for name, key in self.snippets)
        return " + ".join(path for _, path in self.stages) + defines + snippets


class Compute(_Shader):
    """A compute program: ``Compute("cone_trace/diffuse.comp.glsl", defines={"CONES": 9})``."""

    __slots__ = ()

    def __init__(
        self,
        path: str | Path,
        defines: Mapping[str, Define] | None = None,
        snippets: Mapping[str, str] | None = None,
    ) -> None:
        super().__init__((("compute", str(path)),), defines or {}, snippets or {})


class Raster(_Shader):
    """A raster program of a vertex, a fragment and perhaps a geometry shader."""

    __slots__ = ()

    def __init__(
        self,
        vert: str | Path,
        frag: str | Path,
        geom: str | Path | None = None,
        defines: Mapping[str, Define] | None = None,
        snippets: Mapping[str, str] | None = None,
    ) -> None:
        stages = [("vertex", str(vert)), ("fragment", str(frag))]
        if geom is not None:
            stages.append(("geometry", str(geom)))
        super().__init__(tuple(stages), defines or {}, snippets or {})


Shader = Compute | Raster


@dataclass(frozen=True, slots=True)
class Source:
    """One flattened stage."""

    text: str
    lines: tuple[tuple[str, int], ...]
    """(file, 1-based line) of each line of ``text``."""
    files: tuple[Path, ...]
    """Every file that took part."""

    def locate(self, line: int) -> str:
        """``file:line`` of the 1-based ``line`` of the flattened text."""
        file, number = self.lines[min(max(line, 1), len(self.lines)) - 1]
        return f"{file}:{number}"


def flatten(
    path: str,
    defines: tuple[tuple[str, Define], ...] = (),
    root: Path | None = None,
    snippets: Mapping[str, SnippetText] | None = None,
) -> Source:
    """Join ``path`` and all that it includes, each file once, behind version and defines.

    Includes are relative to ``root`` (the GLSL root). A file is joined where it is first named,
    whether or not an ``#if`` hides that line. ``#include <name>`` takes in a snippet, or nothing
    where none is given. Raises ShaderError for a missing file.
    """
    root = root or glsl_root()
    text: list[str] = ["#version 430 core"]
    lines: list[tuple[str, int]] = [("<version>", 1)]
    for name, value in defines:
        text.append(f"#define {name} {_glsl_value(value)}")
        lines.append((f"<define {name}>", 1))
    files: dict[Path, None] = {}

    def add_snippet(snippet: SnippetText) -> None:
        for line in snippet.prelude.splitlines():
            text.append(line)
            lines.append((f"<parameters of {snippet.label}>", 1))
        add(str(snippet.file), snippet.label, snippet.label)

    def add(path: str, origin: str, label: str | None = None) -> None:
        file, name = root / path, label or path
        if file in files:
            return
        files[file] = None
        try:
            content = file.read_text(encoding="utf-8-sig")
        except OSError as error:
            raise ShaderError(f"{origin}: can't read {path}: {error.strerror}") from error
        except ValueError as error:  # no UTF-8, or a name that no file can have
            raise ShaderError(f"{origin}: {path} is no text in UTF-8") from error
        for number, line in enumerate(content.splitlines(), 1):
            include = _INCLUDE.match(line)
            if include:
                add(include.group(1), f"{name}:{number}")
                continue
            placeholder = _SNIPPET.match(line)
            if placeholder:
                if snippets and placeholder.group(1) in snippets:
                    add_snippet(snippets[placeholder.group(1)])
                continue
            if line.lstrip().startswith("#version"):
                raise ShaderError(f"{name}:{number}: the flattener writes #version, remove it")
            text.append(line)
            lines.append((name, number))

    add(path, path)
    return Source("\n".join(text) + "\n", tuple(lines), tuple(files))


def _glsl_value(value: Define) -> str:
    return str(int(value)) if isinstance(value, bool) else str(value)


# Mesa "0:12(5): error: …", NVIDIA "0(12) : error C1008: …", Intel and AMD "ERROR: 0:12: …".
_MESSAGES = (
    re.compile(r"^\s*\d+:(?P<line>\d+)\(\d+\):\s*(?P<rest>.*)$"),
    re.compile(r"^\s*\d+\((?P<line>\d+)\)\s*:\s*(?P<rest>.*)$"),
    re.compile(r"^\s*(?P<kind>ERROR|WARNING):\s*[^:\s]*:(?P<line>\d+):\s*(?P<rest>.*)$"),
)


def rewrite_messages(log: str, source: Source) -> str:
    """Compiler log with each ``string:line`` replaced by the author's ``file:line``."""
    rewritten = []
    for line in log.splitlines():
        for pattern in _MESSAGES:
            match = pattern.match(line)
            if match:
                kind = (match.groupdict().get("kind") or "").lower()
                prefix = f"{kind}: " if kind else ""
                where = source.locate(int(match["line"]))
                rewritten.append(f"{where}: {prefix}{match['rest']}")
                break
        else:
            if line.strip():
                rewritten.append(line)
    return "\n".join(rewritten)


@dataclass(frozen=True, slots=True)
class Declared:
    """A resource that the source declares, used by the compiler or not."""

    kind: str
    """sampler, image, uniform (block) or buffer (block)."""
    image_format: str | None = None
    """The image's ``layout`` format qualifier."""
    access: str = ""
    """readonly, writeonly or nothing."""


_STATEMENT_END = re.compile(r"(?<=[;{}])")
_OPAQUE = re.compile(
    r"(?:layout\s*\((?P<layout>[^)]*)\)\s*)?(?P<before>(?:\b\w+\s+)*?)\buniform\s+"
    r"(?P<after>(?:\w+\s+)*?)(?P<type>[iu]?(?:sampler|image)\w+)\s+(?P<name>\w+)\s*(?:\[|;)"
)
_BLOCK = re.compile(
    r"(?:layout\s*\([^)]*\)\s*)?(?P<before>(?:\b\w+\s+)*?)\b(?P<kind>uniform|buffer)\s+"
    r"(?P<name>\w+)\s*\{"
)


def declared_resources(text: str) -> dict[str, Declared]:
    """Samplers, images and blocks that GLSL ``text`` declares, by name, in any ``#if`` branch."""
    found: dict[str, Declared] = {}
    # A statement a line: the patterns are slow where they find nothing.
    statements = _STATEMENT_END.split(COMMENT.sub(" ", text))
    plain = "\n".join([part for part in statements if "uniform" in part or "buffer" in part])
    for match in _OPAQUE.finditer(plain):
        words = set(re.findall(r"\w+", match["layout"] or ""))
        qualifiers = set((match["before"] + match["after"]).split())
        access = next((a for a in ("readonly", "writeonly") if a in qualifiers), "")
        fmt = next((word for word in words if word in IMAGE_QUALIFIERS), None)
        kind = "image" if "image" in match["type"] else "sampler"
        found[match["name"]] = Declared(kind, fmt, access)
    for match in _BLOCK.finditer(plain):
        found[match["name"]] = Declared(match["kind"])
    return found
