"""Materials: which kind each is of, and the parameters that its kind has."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import Any

from imgui_bundle import imgui

from elemental.scene.definitions import definition_names, find_definition
from elemental.scene.materials import Material
from elemental.scene.parameters import LARGEST, Parameter
from elemental.settings import Setting
from elemental.settings.setting import Kind
from elemental.ui import icons, theme
from elemental.ui.document import Document
from elemental.ui.rows import property_row, vector_row
from elemental.ui.widgets import Widgets

KINDS: dict[str, Kind] = {"float": "float", "int": "int", "bool": "bool", "color": "color"}
LIST_ROWS = 6


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


def materials_page(w: Widgets, chosen: int, document: Document, folder: Path) -> int:
    """Draw the page; ``folder``: where the scene's own definitions are. Returns what is chosen."""
    materials = document.state.materials
    chosen = min(chosen, len(materials) - 1)
    height = LIST_ROWS * imgui.get_text_line_height_with_spacing()
    if imgui.begin_child("list", imgui.ImVec2(0.0, height), imgui.ChildFlags_.resize_y.value):
        for number, material in enumerate(materials):
            label = f"{icons.MATERIAL}  {material.name or 'unnamed'}##{number}"
            if imgui.selectable(label, number == chosen)[0]:
                chosen = number
            w.note(material.name)
    imgui.end_child()
    if chosen < 0:
        return 0
    material = materials[chosen]
    before = document.saved.materials
    saved = before[chosen] if chosen < len(before) else material
    if imgui.begin_child("parameters"):
        w.row("Kind", "which shader makes its surface")
        names = definition_names()
        kind = w.choose("kind", material.definition.name, names)
        w.hint(material.definition.help)
        if kind != material.definition.name:

            def dress() -> None:
                definition = find_definition(kind, folder, folder, "shader")
                document.set_material(chosen, material.with_definition(definition))

            document.attempt(dress)
        else:
            for parameter in material.definition.parameters:
                _row(w, document, chosen, material, saved, parameter)
    imgui.end_child()
    return chosen


def _row(
    w: Widgets,
    document: Document,
    index: int,
    material: Material,
    saved: Material,
    parameter: Parameter,
) -> None:
    name, label = parameter.name, parameter.name.replace("_", " ").capitalize()
    if parameter.kind == "texture":
        slot = getattr(material, name, None) or material.textures.get(name)
        w.row(label, parameter.help)
        w.text("an image" if slot is not None else str(parameter.default), theme.MUTED)
        return
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
