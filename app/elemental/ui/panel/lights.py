"""The scene's lights: strength, colour, place, reach; and whether the sky's sun is one."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
from imgui_bundle import imgui

from elemental.scene.blackbody import COOLEST, HOTTEST
from elemental.scene.lights import Environment, Light
from elemental.scene.sky_sun import SkySun, told
from elemental.settings import SETTINGS, Setting
from elemental.ui import icons
from elemental.ui.document import Document
from elemental.ui.panel.image_row import Images
from elemental.ui.panel.light_mask import mask_rows
from elemental.ui.rows import list_height, property_row, spelled, vector_row
from elemental.ui.widgets import Widgets

WHITE_K = 6500.0
"""Temperature that a light gets when it is given one: daylight."""
BRIGHTEST = 1e5
"""End of the slider, lux or candela: the sun at noon."""
FARTHEST_M = 1000.0


def lights_page(
    w: Widgets, chosen: int, document: Document, environment: Environment | None, images: Images
) -> int:
    """Draw the page. Returns which light is chosen."""
    if environment is not None and environment.sun is not None:
        _sky_sun(w, document, environment)
    lights = document.state.lights
    if not lights:
        w.hint("The scene has no lights of its own: it is lit by emission or the sky.")
        return 0
    chosen = min(chosen, len(lights) - 1)
    height = list_height(len(lights))
    if imgui.begin_child("list", imgui.ImVec2(0.0, height)):
        for number, light in enumerate(lights):
            label = f"{icons.LAMP}  {light.name or 'unnamed'}##{number}"
            if imgui.selectable(label, number == chosen)[0]:
                chosen = number
            w.note(light.name)
            w.tell_if_cut(light.name)
    imgui.end_child()
    light = lights[chosen]
    before = document.saved.lights
    saved = before[chosen] if chosen < len(before) else light
    if imgui.begin_child("light"):
        changed, gesture = _fields(w, light, saved)
        if light.kind != "point":
            of_mask, held = mask_rows(w, images, chosen, light, saved)
            changed, gesture = changed | of_mask, gesture or held
        if changed:
            document.set_light(chosen, replace(light, **changed), gesture)
    imgui.end_child()
    return chosen


def _sky_sun(w: Widgets, document: Document, environment: Environment) -> None:
    """The switch of the sun in the environment's image, and what it gives."""
    setting, settings = SETTINGS["sky.sun"], document.state.settings
    value = settings[setting.key]
    edit = property_row(w, setting.key, "Sun of the sky", setting, value, setting.default)
    if edit is not None:
        document.attempt(partial(document.set, setting.key, edit.value))
    shining = SkySun().joined([], environment, settings)
    w.hint(told(shining[0]) if shining else "It does not shine as a light of its own.")
    imgui.spacing()
    imgui.separator()
    imgui.spacing()


def fields_of(light: Light) -> tuple[Setting, ...]:
    """The plain numbers and switches of a light of its kind; angles in degrees."""
    is_sun = light.kind == "directional"
    unit = "lux" if is_sun else "cd"
    fields = [
        Setting("intensity", "float", 1.0, "strength", unit=unit, lo=0.0, hi=BRIGHTEST),
        Setting("casts_shadow", "bool", True, "whether what stands in its way is dark behind"),
        Setting(
            "source_radius", "float", 0.0,
            "half the sun's width as seen from here" if is_sun else "of a glowing sphere",
            unit="rad" if is_sun else "m", lo=0.0, hi=0.1 if is_sun else 10.0,
        ),
    ]  # fmt: skip
    if not is_sun:
        fields.append(
            Setting("range", "float", FARTHEST_M, "beyond it there is no light of it", unit="m",
                    lo=0.01, hi=FARTHEST_M)
        )  # fmt: skip
    if light.kind == "spot":
        fields += [
            Setting("inner_angle", "float", 0.0, "half angle of full light", unit="°", lo=0, hi=90),
            Setting("outer_angle", "float", 45.0, "half angle of any", unit="°", lo=0.1, hi=90),
        ]
    return tuple(fields)


def _fields(w: Widgets, light: Light, saved: Light) -> tuple[dict[str, Any], Any]:
    """(changed fields, gesture)."""
    changed: dict[str, Any] = {}
    gesture: Any = None
    color = Setting("color", "color", (1.0, 1.0, 1.0), "linear", lo=0.0)
    values = (_floats(light.color), _floats(saved.color))
    edit = property_row(w, "color", "Colour", color, *values)
    if edit is not None:
        changed["color"], gesture = np.array(edit.value, np.float32), edit.gesture
    has_heat = Setting("heat", "bool", False, "whether its colour is that of a glowing body too")
    edit = property_row(
        w, "heat", "Black body", has_heat, light.temperature is not None,
        saved.temperature is not None,
    )  # fmt: skip
    if edit is not None:
        changed["temperature"] = (saved.temperature or WHITE_K) if edit.value else None
    if light.temperature is not None:
        heat = Setting(
            "temperature", "float", WHITE_K, "of a black body", unit="K", lo=COOLEST, hi=HOTTEST
        )
        default = saved.temperature or WHITE_K
        edit = property_row(w, "temperature", "Temperature", heat, light.temperature, default)
        if edit is not None:
            changed["temperature"], gesture = edit
    for field in fields_of(light):
        label = spelled(field.key)
        shown, default = _shown(light, field), _shown(saved, field)
        edit = property_row(w, field.key, label, field, shown, default)
        if edit is not None:
            changed[field.key], gesture = _held(light, field, edit.value), edit.gesture
    for name, kinds in (("position", ("point", "spot")), ("direction", ("directional", "spot"))):
        if light.kind in kinds or (name == "position" and light.mask is not None):
            unit = "m" if name == "position" else ""
            here, there = _floats(getattr(light, name)), _floats(getattr(saved, name))
            edit = vector_row(w, name, name.capitalize(), here, there, unit=unit)
            is_direction = name == "direction"
            if edit is not None and (any(edit.value) or not is_direction):
                vector = np.array(edit.value, np.float32)
                changed[name] = vector / np.linalg.norm(vector) if is_direction else vector
                gesture = edit.gesture
    inner = changed.get("inner_angle", light.inner_angle)
    outer = changed.get("outer_angle", light.outer_angle)
    if inner > outer:
        changed["inner_angle"] = changed["outer_angle"] = changed.get("outer_angle", inner)
    return changed, gesture


def _floats(vector: Any) -> tuple[float, ...]:
    return tuple(float(f"{part:.6g}") for part in vector)


def _shown(light: Light, field: Setting) -> Any:
    value = getattr(light, field.key)
    if field.key.endswith("_angle"):
        return float(f"{math.degrees(value):.6g}")
    return min(value, FARTHEST_M) if field.key == "range" else value


def _held(light: Light, field: Setting, value: Any) -> Any:
    if field.key.endswith("_angle"):
        return math.radians(value)
    return math.inf if field.key == "range" and value >= FARTHEST_M else value
