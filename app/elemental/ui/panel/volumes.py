"""Post-process volumes: where each is, how it blends, and which settings it overrides."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

from imgui_bundle import imgui

from elemental.scene.model import unique_name
from elemental.scene.volumes import Vector, Volume
from elemental.settings import SETTINGS, Setting, Settings, check_override
from elemental.ui import icons, theme
from elemental.ui.document import Document
from elemental.ui.panel.settings import GROUPS, label_of, matches, title_of
from elemental.ui.rows import help_text, property_row, vector_row
from elemental.ui.widgets import Edit, Widgets

FIELDS = (
    Setting("enabled", "bool", True, "whether the volume acts at all"),
    Setting("unbound", "bool", False, "acts everywhere, whatever its place"),
    Setting("shape", "choice", "box", "of the region in which it acts in full",
            choices=("box", "sphere")),
    Setting("priority", "float", 0.0, "volumes of a higher one come on top", lo=0, hi=100),
    Setting("blend_radius", "float", 1.0, "over which it fades outside", unit="m", lo=0, hi=1000),
    Setting("blend_weight", "float", 1.0, "share of its values, inside", lo=0, hi=1),
)  # fmt: skip
"""Fields of a Volume, as rows."""
OVERRIDABLE = {key: setting for key, setting in SETTINGS.items() if setting.volume}
GIZMOS = ("Move", "Rotate", "Scale")


@dataclass
class VolumeView:
    """What the page keeps."""

    chosen: int = 0
    searched: str = ""
    gizmo: str = "Move"
    only_overridden: bool = False


def volumes_page(
    w: Widgets, view: VolumeView, document: Document, weights: Sequence[float], eye: Vector
) -> None:
    """Draw the page. ``weights``: of each volume as seen from ``eye``, m."""
    volumes = document.state.volumes
    view.chosen = min(view.chosen, max(len(volumes) - 1, 0))
    _list(w, view, document, weights, eye)
    volumes = document.state.volumes
    if not volumes:
        w.hint("A volume overrides settings for an eye in or near it. Add one here.")
        return
    volume = volumes[view.chosen]
    if imgui.begin_child("volume"):
        _fields(w, view, document, volume)
        _overrides(w, view, document, volume)
    imgui.end_child()


def _list(
    w: Widgets, view: VolumeView, document: Document, weights: Sequence[float], eye: Vector
) -> None:
    volumes = document.state.volumes
    taken = {volume.name for volume in volumes}
    if w.button(f"{icons.PLUS} Box", "add box", help="a box of 4 m around the eye"):
        _add(view, document, Volume(unique_name("volume", taken), center=eye, size=(4.0,) * 3))
    w.flow(5.0 * imgui.get_font_size())
    if w.button(f"{icons.PLUS} Sphere", "add sphere", help="a sphere of 2 m around the eye"):
        name = unique_name("volume", taken)
        _add(view, document, Volume(name, "sphere", center=eye, radius=2.0))
    w.flow(4.0 * imgui.get_font_size())
    if w.button("Copy", enabled=bool(volumes), help="another one like this"):
        volume = volumes[view.chosen]
        _add(view, document, replace(volume, name=unique_name(volume.name, taken)))
    w.flow(2.0 * imgui.get_font_size())
    if w.button(icons.TRASH, "delete", bool(volumes), "take this volume out"):
        left = volumes[: view.chosen] + volumes[view.chosen + 1 :]
        document.set_volumes(left, f"delete {volumes[view.chosen].name}")
        view.chosen = max(view.chosen - 1, 0)
        return
    for number, (volume, weight) in enumerate(zip(volumes, weights, strict=False)):
        if imgui.selectable(f"##volume{number}", number == view.chosen)[0]:
            view.chosen = number
        w.note(volume.name)
        imgui.same_line(2.0 * imgui.get_style().item_spacing.x)
        w.text(f"{icons.VOLUME}  {volume.name}", None if volume.enabled else theme.MUTED)
        share = f"{100 * weight:.0f} %"
        imgui.same_line(imgui.get_content_region_avail().x - imgui.calc_text_size(share).x)
        w.text(share, theme.ACCENT if weight > 0 else theme.MUTED)


def _add(view: VolumeView, document: Document, volume: Volume) -> None:
    view.chosen = len(document.state.volumes)
    document.set_volumes((*document.state.volumes, volume), f"add {volume.name}")


def _fields(w: Widgets, view: VolumeView, document: Document, volume: Volume) -> None:
    if not w.section("Place"):
        return
    changed: dict[str, Any] = {}
    gesture = None
    w.row("Name", "what the scene file and the remote control call it")
    edit = w.typed("name", volume.name)
    others = {other.name for other in document.state.volumes if other is not volume}
    if edit is not None and edit.value.strip():
        changed["name"] = unique_name(edit.value.strip(), others)
    for field in FIELDS:
        edit = property_row(
            w, field.key, label_of(field), field, getattr(volume, field.key), field.default
        )
        if edit is not None:
            changed[field.key], gesture = edit
    default = Volume("")
    places: list[tuple[str, str, str, float | None]] = [("center", "Centre", "m", None)]
    if volume.shape == "box":
        places += [("rotation_deg", "Rotation", "°", None), ("size", "Size", "m", 1e-3)]
    for name, label, unit, lo in places:
        held = getattr(default, name)
        edit = vector_row(w, name, label, getattr(volume, name), held, unit=unit, lo=lo)
        if edit is not None:
            changed[name], gesture = edit
    if volume.shape == "sphere":
        radius = Setting("radius", "float", 1.0, "of the sphere", unit="m", lo=1e-3)
        edit = property_row(w, "radius", "Radius", radius, volume.radius, radius.default)
        if edit is not None:
            changed["radius"], gesture = edit
    w.row("Gizmo", "what a drag in the picture changes")
    view.gizmo = w.choose("gizmo", view.gizmo, GIZMOS)
    if changed:
        document.set_volume(view.chosen, replace(volume, **changed), gesture)


def _overrides(w: Widgets, view: VolumeView, document: Document, volume: Volume) -> None:
    if not w.section("Overrides"):
        return
    view.only_overridden = w.tick("only what is overridden", view.only_overridden, "only")
    view.searched = w.search("search", view.searched)
    words = view.searched.lower().split()
    for group, members in GROUPS.items():
        shown = [
            setting
            for setting in members
            if setting.volume
            and matches(setting, words)
            and (setting.key in volume.overrides or not view.only_overridden)
        ]
        if not shown:
            continue
        count = sum(setting.key in volume.overrides for setting in shown)
        title = f"{title_of(group)}{f'  {count}' if count else ''}###{group}"
        is_open = bool(words) or count > 0 or view.only_overridden
        if len(members) > 1 and not w.section(title, is_open):
            continue
        for setting in shown:
            overrides = _override_row(w, document.state.settings, volume, setting)
            if overrides is not None:
                document.attempt(partial(_override, document, view.chosen, volume, overrides))


def _override(document: Document, index: int, volume: Volume, overrides: Edit) -> None:
    checked = {key: check_override("volumes", key, value) for key, value in overrides.value.items()}
    document.set_volume(index, replace(volume, overrides=checked), overrides.gesture)


def _override_row(w: Widgets, settings: Settings, volume: Volume, setting: Setting) -> Edit | None:
    """A tick, and the value beside it: the volume's own, or the scene's, which can't be changed."""
    small = setting.kind == "bool"
    label = label_of(setting)
    if w.is_out_of_sight(label, small):
        return None
    key = setting.key
    on = key in volume.overrides
    value = volume.overrides[key] if on else settings[key]
    imgui.push_id(key)
    ticked = w.tick("", on, f"override {key}")
    w.tooltip("override the scene's value in this volume")
    imgui.same_line()
    w.row(label, help_text(setting), on, small)
    imgui.begin_disabled(not on)
    edit = w.value(key, setting, value)
    imgui.end_disabled()
    scene_text = setting.value_text(settings[key]) or "nothing"
    if w.reset(key, on and value != settings[key], f"the scene's {scene_text}"):
        edit = Edit(settings[key])
    imgui.pop_id()
    if ticked != on:
        rest = {k: v for k, v in volume.overrides.items() if k != key}
        return Edit({**rest, key: value} if ticked else rest)
    if edit is not None and on:
        return Edit({**volume.overrides, key: edit.value}, edit.gesture)
    return None
