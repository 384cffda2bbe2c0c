"""Materials: which kind each is of, and the parameters that its kind has."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache, partial
from pathlib import Path
from typing import Any

from imgui_bundle import imgui

from elemental.scene.definitions import builtin, definition_names, read_definition
from elemental.scene.materials import Material
from elemental.scene.parameters import LARGEST, Parameter
from elemental.settings import Setting
from elemental.settings.setting import Kind
from elemental.ui import icons
from elemental.ui.document import Document
from elemental.ui.panel.textures import MaterialImages, texture_row
from elemental.ui.rows import list_height, property_row, spelled, vector_row
from elemental.ui.widgets import Widgets

KINDS: dict[str, Kind] = {"float": "float", "int": "int", "bool": "bool", "color": "color"}
DRAW_STATES = (
    Setting("alpha_mode", "choice", "opaque", "what opacity means: nothing, cut-outs, or glass",
            choices=("opaque", "mask", "blend")),
    Setting("double_sided", "bool", False, "whether its backs show"),
)  # fmt: skip
"""Of every material but what decals project."""


@lru_cache(maxsize=512)
def setting_of(parameter: Parameter) -> Setting:
    """A parameter as the rows know it."""
    kind = KINDS.get(parameter.kind, "color")
    return Setting(
        parameter.name,
        kind,
        parameter.default if kind != "color" else tuple(parameter.default)[:3],  # type: ignore[arg-type]
        parameter.help or parameter.name.replace("_", " "),
        unit=parameter.unit,
        lo=None if parameter.low <= -LARGEST else parameter.low,
        hi=None if parameter.high >= LARGEST else parameter.high,
    )


def materials_page(w: Widgets, chosen: int, document: Document, images: MaterialImages) -> int:
    """Draw the page. Returns what is chosen."""
    materials = document.state.materials
    chosen = min(chosen, len(materials) - 1)
    height = list_height(len(materials))
    if imgui.begin_child("list", imgui.ImVec2(0.0, height), imgui.ChildFlags_.resize_y.value):
        for number, material in enumerate(materials):
            label = f"{icons.MATERIAL}  {material.name or 'unnamed'}##{number}"
            if imgui.selectable(label, number == chosen)[0]:
                chosen = number
            w.note(material.name)
            w.tell_if_cut(material.name)
    imgui.end_child()
    if chosen < 0:
        return 0
    material = materials[chosen]
    before = document.saved.materials
    saved = before[chosen] if chosen < len(before) else material
    if imgui.begin_child("parameters"):
        kinds = _kinds(document)
        w.row("Shader", "which shader makes its surface")
        kind = w.choose("kind", material.definition.name, list(kinds))
        w.hint(material.definition.help)
        if kind != material.definition.name:
            document.attempt(partial(_dress, document, chosen, material, kind, kinds[kind]))
        else:
            for parameter in material.definition.parameters:
                if parameter.kind == "texture":
                    texture_row(w, images, chosen, material, saved, parameter)
                else:
                    _row(w, document, chosen, material, saved, parameter)
            if chosen not in images.projected:
                _draw_states(w, document, chosen, material, saved)
    imgui.end_child()
    return chosen


def _draw_states(
    w: Widgets, document: Document, index: int, material: Material, saved: Material
) -> None:
    """How its surfaces are drawn, whatever its shader."""
    for state in DRAW_STATES:
        value, before = getattr(material, state.key), getattr(saved, state.key)
        edit = property_row(w, state.key, spelled(state.key), state, value, before)
        if edit is not None:
            document.set_material(index, replace(material, **{state.key: edit.value}))


def _kinds(document: Document) -> dict[str, Path | None]:
    """Shaders to choose from, by name: our own, and files that the scene's materials have."""
    kinds: dict[str, Path | None] = dict.fromkeys(definition_names())
    for material in (*document.saved.materials, *document.state.materials):
        kinds.setdefault(material.definition.name, material.definition.file)
    return kinds


def _dress(
    document: Document, index: int, material: Material, kind: str, file: Path | None
) -> None:
    definition = builtin(kind) if file is None else read_definition(file)
    document.set_material(index, material.with_definition(definition))


def _row(
    w: Widgets,
    document: Document,
    index: int,
    material: Material,
    saved: Material,
    parameter: Parameter,
) -> None:
    name, label = parameter.name, spelled(parameter.name)
    value = material.value(name)
    default: Any = parameter.default
    if material.definition == saved.definition:
        default = saved.value(name)
    if parameter.kind in ("vec2", "vec3"):
        assert isinstance(value, tuple)
        bounds = setting_of(parameter)
        edit = vector_row(
            w, name, label, value, default, unit=parameter.unit, help=parameter.help,
            lo=bounds.lo, hi=bounds.hi,
        )  # fmt: skip
    elif parameter.kind == "rgba":
        assert isinstance(value, tuple)
        edit = property_row(w, name, label, setting_of(parameter), value[:3], tuple(default)[:3])
        if edit is not None:
            edit = edit._replace(value=(*edit.value, value[3]))
        alpha = Setting("opacity", "float", 1.0, "alpha of the base colour", lo=0.0, hi=1.0)
        opacity = property_row(w, f"{name}.a", "Opacity", alpha, value[3], default[3])
        if opacity is not None:
            edit = opacity._replace(value=(*value[:3], opacity.value))
    else:
        edit = property_row(w, name, label, setting_of(parameter), value, default)
    if edit is not None:
        value, gesture = edit

        def change() -> None:
            document.set_material(index, material.with_value(name, value), gesture)

        document.attempt(change)
