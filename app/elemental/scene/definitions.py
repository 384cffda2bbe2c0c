"""Artist's materials: a GLSL snippet with a heading that says what may be set of it.

[Mittring12 "Voxel Lighting Pipeline": shader evaluates artist defined material]. The heading is
TOML in the comment that the file begins with; `docs/materials.md` has the format.
"""

from __future__ import annotations

import difflib
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path

from elemental.core.errors import InputError, named_by
from elemental.core.files import read_text
from elemental.core.paths import content_root
from elemental.core.toml import parse_toml
from elemental.scene.parameters import (
    Parameter,
    ParameterKind,
    ParameterValue,
    read_parameter,
)

SUFFIX = ".glsl"
STANDARD = "standard"
UNLIT = "unlit"
VECTORS_MAX = 8
"""vec4s of parameters a material: MATERIAL_VECTORS of glsl/shared/material.glsl."""
TEXTURES_MAX = 3
"""Textures of its own: a stage has 16 units, of which glTF's slots, lights, indirect light and
glass take up to 13."""
DISPLACEMENT_MAX_M = 1e6
LIGHTING_MODELS = ("subsurface", "cloth")
"""Those that a material has to ask for, by the name LIGHTING_* in its code."""

COMMON_PARAMETERS: dict[str, ParameterKind] = {
    "base_color": "rgba",
    "metallic": "float",
    "roughness": "float",
    "emissive": "color",
    "normal_scale": "float",
    "occlusion_strength": "float",
    "transmission": "float",
    "ior": "float",
    "thickness": "float",
    "attenuation_color": "color",
    "attenuation_distance": "float",
    "base_color_texture": "texture",
    "metallic_roughness_texture": "texture",
    "normal_texture": "texture",
    "occlusion_texture": "texture",
    "emissive_texture": "texture",
}
"""Parameters that each glTF material has, and their kinds: one of these names stands for the file's
own value, and is kept in the field of `Material` of that name."""


@dataclass(frozen=True)
class MaterialDefinition:
    """A kind of material: its GLSL file and what may be set of it.

    `animated`: it changes with time. `displacement_m`: how far its function ``displace`` may move a
    vertex, 0 where it has none. `emits`: the parameters whose product bounds its emission; none: it
    has none.
    """

    name: str
    file: Path
    help: str = ""
    parameters: tuple[Parameter, ...] = ()
    emits: tuple[str, ...] = ()
    animated: bool = False
    displacement_m: float = 0.0
    lighting_models: frozenset[str] = frozenset()
    """The lighting models, of LIGHTING_MODELS, that its code names."""

    @property
    def key(self) -> str:
        """What tells it from all others."""
        return str(self.file)

    def __hash__(self) -> int:
        return hash(self.key)  # passes look shaders up by it

    @cached_property
    def is_standard(self) -> bool:
        """Whether it is glTF's own material, lit."""
        return self._is_builtin(STANDARD)

    @cached_property
    def is_unlit(self) -> bool:
        """Whether it is glTF's KHR_materials_unlit."""
        return self._is_builtin(UNLIT)

    @property
    def may_fail(self) -> bool:
        """Whether what it writes has to be looked at: it may be no number."""
        return not (self.is_standard or self.is_unlit)

    def _is_builtin(self, name: str) -> bool:
        return self.name == name and self.file.parent == materials_folder()

    @property
    def own(self) -> tuple[Parameter, ...]:
        """The parameters that glTF materials do not have."""
        return tuple(p for p in self.parameters if p.name not in COMMON_PARAMETERS)

    @property
    def textures(self) -> tuple[Parameter, ...]:
        """The textures among `own`, in the order of their declaration."""
        return tuple(p for p in self.own if p.kind == "texture")

    def parameter(self, name: str) -> Parameter | None:
        """The parameter of that name."""
        return next((p for p in self.parameters if p.name == name), None)

    def check_value(self, name: str, value: object) -> ParameterValue:
        """A value for one of the parameters. Raises InputError(name, parameter, reason)."""
        parameter = self.parameter(name)
        if parameter is None:
            names = [p.name for p in self.parameters]
            nearest = difflib.get_close_matches(name, names, n=1, cutoff=0.6)
            hint = f"did you mean {nearest[0]!r}?" if nearest else f"known: {', '.join(names)}"
            raise InputError(f"material {self.name!r}", name, f"is an unknown parameter; {hint}")
        return parameter.checked(value, f"material {self.name!r}", name)

    def places(self) -> dict[str, int]:
        """Where the values of `own` begin among the material's floats; none straddles a vec4."""
        places: dict[str, int] = {}
        end = 0
        for parameter in self.own:
            if parameter.lanes:
                if end % 4 + parameter.lanes > 4:
                    end += 4 - end % 4
                places[parameter.name] = end
                end += parameter.lanes
        return places


def materials_folder() -> Path:
    """Where the materials are that come with the program."""
    return content_root() / "materials"


def definition_names() -> list[str]:
    """Names of the materials that come with the program, sorted."""
    return sorted(path.stem for path in materials_folder().glob(f"*{SUFFIX}"))


@cache
def builtin(name: str) -> MaterialDefinition:
    """One of `definition_names`, read once. Raises InputError."""
    return read_definition(materials_folder() / f"{name}{SUFFIX}")


def find_definition(name: str, folder: Path, file: Path, field: str) -> MaterialDefinition:
    """The material of a name, or in a .glsl file below `folder`.

    Raises InputError(file, field, reason) where there is none, and for a broken one.
    """
    if name.endswith(SUFFIX):
        with named_by(file, field, name):
            return read_definition((folder / name).resolve())
    names = definition_names()
    if name in names:
        return builtin(name)
    nearest = difflib.get_close_matches(name, names, n=1, cutoff=0.6)
    hint = f"did you mean {nearest[0]!r}?" if nearest else f"known: {', '.join(names)}"
    raise InputError(file, field, f"no material is named {name!r}; {hint}")


def read_definition(path: Path) -> MaterialDefinition:
    """The definition in a material's file. Raises InputError."""
    text = read_text(path)
    heading = _heading(text, path)
    try:
        table = parse_toml(heading)
    except ValueError as error:
        raise InputError(path, "heading", f"is broken TOML ({error})") from error
    told = {key: table.pop(key, default) for key, default in (
        ("help", ""), ("animated", False), ("displacement_m", 0.0), ("emits", []),
        ("standard", False), ("parameters", {}),
    )}  # fmt: skip
    if table:
        raise InputError(path, min(table), "is an unknown key")
    for key, kind, wanted in (
        ("help", str, "a text"), ("animated", bool, "true or false"),
        ("standard", bool, "true or false"),
        ("displacement_m", int | float, "a length in m"), ("emits", list, "a list of names"),
        ("parameters", dict, "a table"),
    ):  # fmt: skip
        if not isinstance(told[key], kind) or (key == "displacement_m" and told[key] is True):
            raise InputError(path, key, f"should be {wanted}")
    if not 0.0 <= told["displacement_m"] <= DISPLACEMENT_MAX_M:
        raise InputError(path, "displacement_m", f"should be 0 to {DISPLACEMENT_MAX_M:g}")
    parameters = [read_parameter(n, t, path) for n, t in told["parameters"].items()]
    if told["standard"]:
        names = {parameter.name for parameter in parameters}
        parameters += [p for p in builtin(STANDARD).parameters if p.name not in names]
    definition = MaterialDefinition(
        name=path.stem,
        file=path,
        help=told["help"],
        parameters=tuple(parameters),
        emits=tuple(told["emits"]),
        animated=told["animated"],
        displacement_m=float(told["displacement_m"]),
        lighting_models=frozenset(m for m in LIGHTING_MODELS if f"LIGHTING_{m.upper()}" in text),
    )
    _check(definition)
    return definition


def _heading(text: str, path: Path) -> str:
    """The leading comment, on the lines that it has in the file."""
    start = len(text) - len(text.lstrip())
    end = text.find("*/", start)
    if not text.startswith("/*", start) or end < 0:
        raise InputError(path, "heading", "the file does not begin with a comment /* ... */")
    return "\n" * text.count("\n", 0, start) + text[start + 2 : end]


def _check(definition: MaterialDefinition) -> None:
    path = definition.file
    for parameter in definition.parameters:
        kind = COMMON_PARAMETERS.get(parameter.name)
        if kind is not None and parameter.kind != kind:
            raise InputError(path, f"parameters.{parameter.name}.type", f"should be {kind}")
    for name in definition.emits:
        found = definition.parameter(name) if isinstance(name, str) else None
        if found is None or found.kind == "texture":
            raise InputError(path, "emits", f"{name!r} is no parameter with a value")
    places = definition.places()
    end = max((places[p.name] + p.lanes for p in definition.own if p.lanes), default=0)
    if end > 4 * VECTORS_MAX:
        raise InputError(path, "parameters", f"take more than {4 * VECTORS_MAX} numbers")
    if len(definition.textures) > TEXTURES_MAX:
        raise InputError(path, "parameters", f"has more than {TEXTURES_MAX} textures of its own")
