"""Artist's materials as GLSL: what stands before a snippet, and what declares its parameters.

No GL."""

from __future__ import annotations

import re
from pathlib import Path

from elemental.core.errors import InputError
from elemental.core.files import read_text
from elemental.core.paths import content_root, glsl_root
from elemental.gpu.shaders import COMMENT, ShaderError, SnippetText
from elemental.scene.definitions import (
    COMMON_PARAMETERS,
    MaterialDefinition,
    read_definition,
)
from elemental.scene.parameters import Parameter

NAME = "material"
"""The snippet's name in ``#include <material>``."""
FALLBACK = "material/fallback.glsl"
TYPES = {
    "float": "float", "int": "int", "bool": "bool", "vec2": "vec2", "vec3": "vec3",
    "color": "vec3", "rgba": "vec4",
}  # fmt: skip
"""GLSL types by kind of parameter."""
FUNCTIONS = {
    "material": "void material(inout Surface s, MaterialInput m, Parameters p)",
    "displace": "vec3 displace(MaterialInput m, Parameters p)",
}
"""What a material has to have; the second one only where it moves vertices."""


class MaterialSnippet:
    """The code of one definition, for the shader library; `definition` is the one in use."""

    def __init__(self, definition: MaterialDefinition) -> None:
        self.definition = definition
        self.revision = 0
        """How often an edit was taken over."""
        self._next = definition
        self._loads = 0

    @property
    def file(self) -> Path:
        """The artist's file."""
        return self.definition.file

    def load(self) -> SnippetText:
        """What is on disk now. Raises ShaderError where the heading is broken."""
        if self._loads or self.definition is not self._next:
            self._reread()
        self._loads += 1
        _check_functions(self._next)
        return SnippetText(prelude(self._next), self.file, label(self.file))

    def _reread(self) -> None:
        try:
            self._next = read_definition(self.file)
        except InputError as error:
            raise ShaderError(str(error)) from error

    def fallback(self, broken: bool) -> SnippetText:
        """The magenta checker, with the same parameters and textures."""
        del broken
        text = f"{prelude(self.definition)}\n#define MATERIAL_IS_FALLBACK 1"
        return SnippetText(text, glsl_root() / FALLBACK, FALLBACK)

    def settle(self, accepted: bool) -> None:
        """Take the newly read definition into use, or drop it."""
        if accepted:
            self.definition = self._next
            self.revision += self._loads > 1  # to be compiled for the first time is no edit
        else:
            self._next = self.definition


def _check_functions(definition: MaterialDefinition) -> None:
    """Raises ShaderError for a material without the functions that it is asked for."""
    code = COMMENT.sub(" ", read_text(definition.file))
    for name, wanted in FUNCTIONS.items():
        is_asked = name == "material" or definition.displacement_m > 0.0
        if is_asked and re.search(rf"\b{name}\s*\(", code) is None:
            raise ShaderError(f"{label(definition.file)}: has no function `{wanted}`")


def label(file: Path) -> str:
    """How messages name a material's file."""
    content = content_root()
    return str(file.relative_to(content.parent)) if file.is_relative_to(content) else str(file)


def prelude(definition: MaterialDefinition) -> str:
    """GLSL that declares a definition's parameters, and reads them of a material."""
    values = [p for p in definition.parameters if p.lanes]
    places = definition.places()
    lines = ["#define HAS_MATERIAL 1"]
    lines += [f"uniform sampler2D u_{p.name};" for p in definition.textures]
    lines += ["struct Parameters {", *(f"    {TYPES[p.kind]} {p.name};" for p in values)]
    lines += ["    float none;", "};", "Parameters material_parameters(uint material) {"]
    lines += ["    Parameters p;", "    p.none = 0.0;"]
    lines += [f"    p.{p.name} = {_fetch(p, places.get(p.name, 0))};" for p in values]
    return "\n".join([*lines, "    return p;", "}"])


def _fetch(parameter: Parameter, place: int) -> str:
    if parameter.name in COMMON_PARAMETERS:
        return f"materials[material].{parameter.name}"
    first = place % 4
    lanes = "xyzw"[first : first + parameter.lanes]
    value = f"materials[material].parameters[{place // 4}].{lanes}"
    return {"int": f"int({value})", "bool": f"{value} != 0.0"}.get(parameter.kind, value)
