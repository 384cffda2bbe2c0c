"""The buffer viewer: any target of the frame, live, down to a texel's exact values.

[Mittring12 "Compositing Graph"], "tools to look at intermediate buffers".
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
from imgui_bundle import imgui

from elemental.gpu.graph_report import GraphReport
from elemental.passes.inspect import CHANNELS, COLORS, STENCIL, Inspector, Look, Target
from elemental.passes.texels import Pixels
from elemental.ui import icons, theme
from elemental.ui.panel.targets import describe, memory_facts, targets_of, title_of
from elemental.ui.widgets import Widgets

LIST_SHARE = 0.26
"""Of the page's width, for the list of targets."""
LEAST_LIST_EM = 8.0
"""Where that is less, in heights of the text, they drop down."""
FIRST_TARGET = "scene_color"
"""Looked at until another is chosen."""
VALUES_EM = 45.0
"""Width of the figures below the picture, in heights of the text, if all stand on one line."""
MEMORY_LINES = 4
"""Of figures below the list of targets, where it is at least twice as high."""
MEMORY_HELP = (
    "age: frames since its memory was allocated; reused: how often it was handed out again; "
    "pool: what all transient targets hold, and the most that they ever held"
)
LEAST_PICTURE_EM = 5.0
ZOOM_PER_NOTCH = 1.25
LARGEST_TEXEL_PX = 64.0


@dataclass
class BufferView:
    """What the page keeps: the look, the zoom, a search."""

    searched: str = ""
    look: Look | None = None
    step: float = 0.0
    """Texels a pixel; 0 fits the target into the page."""
    center: tuple[float, float] = (0.0, 0.0)
    """Texel in the middle."""
    ranges: dict[str, tuple[float, float]] = field(default_factory=dict)
    """(black, white) by the target's name."""
    counts: dict[Target, tuple[int, int]] = field(default_factory=dict)
    """(levels, layers or slices) of the frame's targets."""


Save = Callable[[Target, Pixels], None]


def buffers_page(
    w: Widgets, view: BufferView, inspector: Inspector, report: GraphReport | None, save: Save
) -> None:
    """Draw the page: the targets at the left, the chosen one at the right."""
    width = imgui.get_content_region_avail().x
    _follow(view, report)
    if LIST_SHARE * width >= LEAST_LIST_EM * imgui.get_font_size():
        if imgui.begin_child("targets", imgui.ImVec2(LIST_SHARE * width, 0.0)):
            _list(w, view, report)
        imgui.end_child()
        imgui.same_line()
    else:
        _drop_down(w, view, report)
    if imgui.begin_child("look"):
        if view.look is None:
            w.hint("Choose a target of the frame.")
        else:
            _controls(w, view, view.look, inspector, save)
            _picture(w, view, inspector)
    imgui.end_child()
    inspector.look = view.look


def choose(view: BufferView, target: Target) -> None:
    """Look at another target, all of it."""
    low, high = view.ranges.get(target.name, (0.0, 1.0))
    colors = "Plain" if target.format.startswith(("RGBA8", "RGB10", "D")) else "sRGB"
    view.look = Look(target, low=low, high=high, colors=colors)
    if target.format.startswith(("D", "R8", "R16", "R32")):
        view.look = replace(view.look, channel="R", colors="Plain")
    view.step = 0.0


def _follow(view: BufferView, report: GraphReport | None) -> None:
    """Take over which targets there are; look at the first one at first."""
    if report is None:
        return
    for target, resource in targets_of(report):
        slices = resource.size[2] if len(resource.size) == 3 else resource.layers
        view.counts[target] = (resource.mips, slices)
        if view.look is None and target.name == FIRST_TARGET:
            choose(view, target)


def _drop_down(w: Widgets, view: BufferView, report: GraphReport | None) -> None:
    """The targets where there is no room for a list."""
    targets = {title_of(target): target for target, _ in targets_of(report)} if report else {}
    shown = title_of(view.look.target) if view.look is not None else ""
    chosen = w.choose("target", shown, list(targets), imgui.get_content_region_avail().x)
    if chosen != shown:
        choose(view, targets[chosen])


def _list(w: Widgets, view: BufferView, report: GraphReport | None) -> None:
    view.searched = w.search("search", view.searched)
    if report is None:
        return
    memory = MEMORY_LINES * imgui.get_text_line_height_with_spacing()
    tells = imgui.get_content_region_avail().y > 2.0 * memory and view.look is not None
    if imgui.begin_child("names", imgui.ImVec2(0.0, -memory if tells else 0.0)):
        for target, resource in targets_of(report):
            if view.searched.lower() not in target.name.lower():
                continue
            chosen = view.look is not None and view.look.target == target
            label = f"{title_of(target)}###{target.name}{target.size}{target.occurrence}"
            if imgui.selectable(label, chosen)[0]:
                choose(view, target)
            w.note(target.name)
            w.tooltip(describe(resource))
    imgui.end_child()
    if tells and view.look is not None:
        imgui.separator()
        w.facts("memory", memory_facts(view.look.target, report))
        w.tooltip(MEMORY_HELP)


def _controls(w: Widgets, view: BufferView, look: Look, inspector: Inspector, save: Save) -> None:
    em = imgui.get_font_size()
    channels = list(CHANNELS)
    if look.target.format == "D24S8":
        channels = ["R", STENCIL]
    channel = w.choose("channel", look.channel, channels, 6.5 * em)
    w.flow(7.0 * em)
    colors = w.choose("colours", look.colors, COLORS, 7.0 * em)
    w.flow(8.0 * em)
    imgui.set_next_item_width(8.0 * em)
    ranged, (low, high) = imgui.drag_float2("##range", [look.low, look.high], 0.01, 0, 0, "%.4g")
    w.note("range")
    w.tooltip("values shown as black and white")
    w.flow(3.0 * em)
    wants_range = w.button("Auto", help="from the least to the largest value")
    level, layer = _level_and_layer(w, look, view.counts.get(look.target, (1, 1)))
    w.flow(4.0 * em)
    frozen = w.tick(icons.FREEZE, inspector.frozen, "freeze")
    w.tooltip("keep what is in it now")
    w.flow(2.0 * em)
    if w.button(icons.SAVE, "save", help="save the level as EXR, exactly"):
        inspector.capture(lambda pixels: save(look.target, pixels))
    w.flow(2.0 * em)
    if w.button("Fit", help="all of it; the wheel zooms, a drag moves"):
        view.step = 0.0
    changed = replace(look, channel=channel, colors=colors, level=level, layer=layer)
    if ranged:
        changed = replace(changed, low=low, high=high)
        view.ranges[look.target.name] = (low, high)
    view.look = changed
    if wants_range:
        inspector.capture(lambda pixels: _take_range(view, pixels))
    if frozen != inspector.frozen:
        inspector.freeze(frozen)


def _level_and_layer(w: Widgets, look: Look, counts: tuple[int, int]) -> tuple[int, int]:
    """Numbers to step through, each only where there is more than one."""
    level, layer = look.level, look.layer
    for name, count in zip(("level", "layer"), counts, strict=True):
        if count < 2:
            continue
        width = 6.0 * imgui.get_font_size()
        w.flow(width)
        imgui.set_next_item_width(width)
        value = level if name == "level" else layer
        _, value = imgui.slider_int(f"##{name}", value, 0, count - 1, f"{name} %d")
        w.note(name)
        level, layer = (value, layer) if name == "level" else (level, value)
    return level, layer


def _take_range(view: BufferView, pixels: Pixels) -> None:
    if view.look is None:
        return
    finite = pixels[..., :3][np.isfinite(pixels[..., :3])]
    if finite.size:
        low, high = float(finite.min()), float(finite.max())
        view.look = replace(view.look, low=low, high=high if high > low else low + 1.0)
        view.ranges[view.look.target.name] = (view.look.low, view.look.high)


def _picture(w: Widgets, view: BufferView, inspector: Inspector) -> None:
    look = view.look
    assert look is not None
    room = imgui.get_content_region_avail()
    lines = math.ceil(VALUES_EM * imgui.get_font_size() / max(room.x, 1.0))
    line = lines * imgui.get_text_line_height_with_spacing() + imgui.get_style().item_spacing.y
    least = LEAST_PICTURE_EM * imgui.get_font_size()
    size = (max(int(room.x), 1), max(int(room.y - line), int(least)))
    width, height = (max(extent >> look.level, 1) for extent in look.target.size[:2])
    if view.step <= 0.0:
        view.center = (width / 2, height / 2)
    step = view.step or max(width / size[0], height / size[1])
    corner = (view.center[0] - step * size[0] / 2, view.center[1] - step * size[1] / 2)
    place = imgui.get_cursor_screen_pos()
    extent = imgui.ImVec2(*size)
    picture = inspector.picture
    if picture is not None and inspector.found and picture.size == size:
        flipped = (imgui.ImVec2(0.0, 1.0), imgui.ImVec2(1.0, 0.0))
        imgui.image(imgui.ImTextureRef(picture.glo), extent, *flipped)
    else:
        imgui.dummy(extent)
    w.note("picture")
    probe = look.probe
    if imgui.is_item_hovered():
        mouse = imgui.get_mouse_pos()
        x, y = mouse.x - place.x, size[1] - (mouse.y - place.y)
        under = (corner[0] + step * x, corner[1] + step * y)
        probe = (int(under[0] // 1), int(under[1] // 1))
        _navigate(view, step, under, (x - size[0] / 2, y - size[1] / 2))
    inspector.size = size
    view.look = replace(look, corner=corner, step=step, probe=probe)
    _values(w, look, inspector, (width, height))


def _navigate(
    view: BufferView, step: float, under: tuple[float, float], from_center: tuple[float, float]
) -> None:
    """The wheel zooms about the texel under the mouse, a drag moves."""
    io = imgui.get_io()
    if io.mouse_wheel:
        view.step = max(step * ZOOM_PER_NOTCH**-io.mouse_wheel, 1.0 / LARGEST_TEXEL_PX)
        view.center = (
            under[0] - view.step * from_center[0], under[1] - view.step * from_center[1]
        )  # fmt: skip
    elif imgui.is_mouse_dragging(0):
        view.step = step
        delta = io.mouse_delta
        view.center = (view.center[0] - step * delta.x, view.center[1] + step * delta.y)


def _values(w: Widgets, look: Look, inspector: Inspector, size: tuple[int, int]) -> None:
    """The texel under the mouse: its place, row 0 on top, and its values."""
    shape = f"{size[0]}x{size[1]} {look.target.format}"
    if not inspector.found:
        w.text("this frame has no such target", theme.ACCENT)
        return
    probed = inspector.probed
    facts = [("", shape)]
    if probed is not None:
        x, y = probed.texel
        facts.append(("texel", f"{x}, {size[1] - 1 - y}"))
        numbers = probed.words if probed.words is not None else probed.values
        digits = [f"{n:,}" if isinstance(n, int) else f"{n:.6g}" for n in numbers]
        facts += [(name, digit) for name, digit in zip("RGBA", digits, strict=False)]
    w.facts("values", facts)
