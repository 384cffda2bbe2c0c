"""This frame's graph: passes as boxes, what they hand on as edges, targets with size and format.

[Mittring12 "Compositing Graph"]
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

from imgui_bundle import imgui

from elemental.gpu.graph_report import GraphPass, GraphReport
from elemental.ui import theme
from elemental.ui.panel.targets import KIB, describe
from elemental.ui.panel.timeline import hues_of, system_of
from elemental.ui.widgets import Widgets

BOX = (13.0, 2.7)
"""Of a pass, in heights of the text."""
GAP = (3.0, 0.7)
"""Between boxes."""
DETAIL_SHARE = 0.28
"""Of the page's width, for what is told of the chosen pass."""
LEAST_DETAIL_EM = 12.0
"""Width at least, in heights of the text; where this is over half, it stands below the graph."""


@dataclass
class GraphView:
    """What the page keeps: where the graph is, and which pass is chosen by name."""

    pan: tuple[float, float] = (0.0, 0.0)
    zoom: float = 0.7
    chosen: str = ""


Places = tuple[tuple[int, int], ...]


@lru_cache(maxsize=4)
def places(edges: tuple[tuple[int, int], ...], count: int) -> Places:
    """(column, row) of each pass: right of all it waits for, below what stands there already."""
    column = [0] * count
    for producer, consumer in sorted(edges, key=lambda edge: edge[1]):
        column[consumer] = max(column[consumer], column[producer] + 1)
    rows: dict[int, int] = {}
    found = []
    for number in range(count):
        row = rows.get(column[number], 0)
        rows[column[number]] = row + 1
        found.append((column[number], row))
    return tuple(found)


def graph_page(w: Widgets, view: GraphView, report: GraphReport | None) -> str | None:
    """Draw the page. Returns the name of a target that was asked to be looked at."""
    if report is None:
        w.hint("The graph shows with the next frame.")
        return None
    pool = report.pool
    w.facts(
        "pool",
        [
            ("passes", f"{len(report.passes)}"),
            ("edges", f"{len(report.edges)}"),
            ("targets", f"{report.transient_bytes / KIB**2:.1f} MiB"),
            ("in", f"{report.shared_bytes / KIB**2:.1f} MiB"),
            ("pool", f"{pool.bytes / KIB**2:.1f} MiB"),
            ("at most", f"{pool.high_water / KIB**2:.1f} MiB"),
            ("allocations", f"{pool.allocations:,}"),
            ("reuses", f"{pool.reuses:,}"),
        ],
    )
    room, em = imgui.get_content_region_avail(), imgui.get_font_size()
    flags = imgui.WindowFlags_.no_scrollbar.value | imgui.WindowFlags_.no_scroll_with_mouse.value
    detail = max(DETAIL_SHARE * room.x, LEAST_DETAIL_EM * em)
    beside = detail <= 0.5 * room.x
    size = (
        imgui.ImVec2(room.x - detail, 0.0)
        if beside
        else imgui.ImVec2(0.0, max(0.6 * room.y, 4.0 * em))
    )
    if imgui.begin_child("graph", size, 0, flags):
        _canvas(w, view, report)
    imgui.end_child()
    if beside:
        imgui.same_line()
    asked = None
    if imgui.begin_child("detail"):
        asked = _detail(w, view, report)
    imgui.end_child()
    return asked


def _canvas(w: Widgets, view: GraphView, report: GraphReport) -> None:
    em = imgui.get_font_size() * view.zoom
    corner, room = imgui.get_cursor_screen_pos(), imgui.get_content_region_avail()
    if room.x < 1.0 or room.y < 1.0:
        return
    imgui.invisible_button("canvas", room)
    w.note("canvas")
    hovered = imgui.is_item_hovered()
    clicked = imgui.is_item_clicked()
    _navigate(view, hovered)
    where = places(tuple((e.producer, e.consumer) for e in report.edges), len(report.passes))
    origin = (corner.x + view.pan[0] + 0.5 * em, corner.y + view.pan[1] + 0.5 * em)
    pitch = ((BOX[0] + GAP[0]) * em, (BOX[1] + GAP[1]) * em)
    boxes = [(origin[0] + c * pitch[0], origin[1] + r * pitch[1]) for c, r in where]
    canvas = imgui.get_window_draw_list()
    chosen = next((k for k, p in enumerate(report.passes) if p.name == view.chosen), -1)
    for edge in report.edges:
        lit = chosen in (edge.producer, edge.consumer)
        start, end = boxes[edge.producer], boxes[edge.consumer]
        _edge(canvas, start, end, em, lit)
    hues = hues_of([item.name for item in report.passes])
    mouse = imgui.get_mouse_pos()
    right, bottom = corner.x + room.x, corner.y + room.y
    for number, (item, (x, y)) in enumerate(zip(report.passes, boxes, strict=True)):
        far = (x + BOX[0] * em, y + BOX[1] * em)
        if far[0] < corner.x or x > right or far[1] < corner.y or y > bottom:
            continue
        over = hovered and x <= mouse.x < far[0] and y <= mouse.y < far[1]
        hue = theme.packed(hues[system_of(item.name)], 1.0 if number == chosen else 0.75)
        _box(w, canvas, item, told(item, report), (x, y, *far), hue, number == chosen or over)
        if over and clicked:
            view.chosen = item.name


def _navigate(view: GraphView, hovered: bool) -> None:
    io = imgui.get_io()
    if hovered and io.mouse_wheel:
        view.zoom = min(max(view.zoom * 1.15**io.mouse_wheel, 0.25), 2.0)
    if imgui.is_item_active() and imgui.is_mouse_dragging(0):
        view.pan = (view.pan[0] + io.mouse_delta.x, view.pan[1] + io.mouse_delta.y)


def _edge(
    canvas: imgui.ImDrawList,
    start: tuple[float, float],
    end: tuple[float, float],
    em: float,
    lit: bool,
) -> None:
    middle = BOX[1] * em / 2
    a = imgui.ImVec2(start[0] + BOX[0] * em, start[1] + middle)
    b = imgui.ImVec2(end[0], end[1] + middle)
    bend = max((b.x - a.x) / 2, 1.5 * em)
    color = theme.packed(theme.ACCENT, 0.95) if lit else theme.packed(theme.MUTED, 0.35)
    canvas.add_bezier_cubic(
        a, imgui.ImVec2(a.x + bend, a.y), imgui.ImVec2(b.x - bend, b.y), b, color,
        2.0 if lit else 1.0,
    )  # fmt: skip


def _box(
    w: Widgets,
    canvas: imgui.ImDrawList,
    item: GraphPass,
    made: str,
    place: tuple[float, float, float, float],
    hue: int,
    lit: bool,
) -> None:
    left, top, right, bottom = place
    low, high = imgui.ImVec2(left, top), imgui.ImVec2(right, bottom)
    size = (bottom - top) / BOX[1]
    canvas.add_rect_filled(low, high, theme.packed((0.19, 0.195, 0.202)), 3.0)
    canvas.add_rect_filled(low, imgui.ImVec2(left + 0.25 * size, bottom), hue, 3.0)
    if lit:
        canvas.add_rect(low, high, theme.packed(theme.ACCENT), 3.0)
    if w.items is not None:
        w.items[f"{w.page}/{item.name}"] = place
    if size < 6.0:
        return
    canvas.push_clip_rect(low, high, True)
    x = left + 0.55 * size
    canvas.add_text(
        w.fonts.text, 0.9 * size, imgui.ImVec2(x, top + 0.3 * size), theme.packed(theme.TEXT),
        item.name,
    )  # fmt: skip
    canvas.add_text(
        w.fonts.figures, 0.8 * size, imgui.ImVec2(x, top + 1.45 * size),
        theme.packed(theme.MUTED), f"{item.gpu_ms:.3f} ms {made}",
    )  # fmt: skip
    canvas.pop_clip_rect()


def told(item: GraphPass, report: GraphReport) -> str:
    """What a pass makes, in short: size and format of its first target, else of a buffer."""
    written = [report.resources[number] for number in item.writes]
    target = next((one for one in written if one.kind == "texture"), None)
    if target is not None:
        return f"{'x'.join(map(str, target.size))} {target.format}"
    return f"{written[0].nbytes / KIB:,.1f} KiB" if written else ""


def _detail(w: Widgets, view: GraphView, report: GraphReport) -> str | None:
    item = next((p for p in report.passes if p.name == view.chosen), None)
    if item is None:
        w.hint("Choose a pass. A drag moves the graph, the wheel zooms.")
        if report.culled:
            w.hint(f"Not needed in this frame: {', '.join(report.culled)}")
        return None
    w.text(item.name, theme.ACCENT)
    extent = "x".join(map(str, item.extent))
    w.facts(
        "times",
        [
            (item.kind, extent),
            ("GPU", f"{item.gpu_ms:.3f} ms"),
            ("CPU", f"{item.cpu_ms:.3f} ms"),
        ],
    )
    asked = None
    for title, numbers in (("writes", item.writes), ("reads", item.reads)):
        if numbers:
            w.text(title, theme.MUTED)
        for number in numbers:
            resource = report.resources[number]
            size = imgui.calc_text_size(resource.name)
            if imgui.selectable(f"{resource.name}##{title}{number}", False, 0, size)[0]:
                asked = resource.name if resource.kind == "texture" else None
            w.note(f"{title} {resource.name}")
            w.tooltip("a click shows it in Buffers" if resource.kind == "texture" else "")
            told = describe(resource)
            w.flow(imgui.calc_text_size(told).x)
            w.hint(told)
    return asked
