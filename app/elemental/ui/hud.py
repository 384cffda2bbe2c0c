"""What the window says over the picture: pass times and counters, the bindings, short messages."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from imgui_bundle import imgui

from elemental.passes.inspect import PICTURE_NAME, Probed
from elemental.ui import theme
from elemental.ui.bindings import BINDINGS
from elemental.ui.theme import Fonts
from elemental.ui.words import Rect

MARGIN_PX = 10.0
BACKGROUND_OPACITY = 0.85
BLOCK_EM = 29.0
"""Width of the bindings in one block, in heights of the text."""
LEAST_PROBLEM_EM = 20.0
"""Width of what went wrong, at least, in heights of the text."""
LINES_AROUND = 12
"""Of the HUD, beside passes, counters and bytes."""
LEAST_PASSES = 4
MESSAGE_EM = 40.0
"""Width of a message at most, in heights of the text."""

_PANEL = (
    imgui.WindowFlags_.no_decoration.value
    | imgui.WindowFlags_.always_auto_resize.value
    | imgui.WindowFlags_.no_saved_settings.value
    | imgui.WindowFlags_.no_focus_on_appearing.value
    | imgui.WindowFlags_.no_nav.value
    | imgui.WindowFlags_.no_inputs.value
    | imgui.WindowFlags_.no_docking.value
)
_TABLE = imgui.TableFlags_.sizing_fixed_fit.value | imgui.TableFlags_.row_bg.value


@dataclass(frozen=True)
class Figures:
    """What the HUD shows of one frame; times in ms, sizes in pixels and bytes."""

    scene: str
    driver: str
    view: str
    size: tuple[int, int]
    voxels: int
    """Lattice points a side of the octree, 0 without indirect light."""
    frame_ms: float | None
    """From one picture to the next; None before the second."""
    cpu_ms: float
    """Spent in Python and the driver's calls for the frame."""
    passes: Mapping[str, float]
    """Averaged GPU time by pass."""
    counters: Mapping[str, int]
    bytes: Mapping[str, int]
    time_s: float
    paused: bool
    speed: float
    """Of the fly camera, m/s."""
    problems: Sequence[str]
    """Shader errors and GL messages that still stand."""


def draw_hud(figures: Figures, place: Rect, fonts: Fonts) -> None:
    """At the top left of the picture's place."""
    _begin("hud", (place[0] + MARGIN_PX, place[1] + MARGIN_PX), (0.0, 0.0))
    imgui.push_font(fonts.figures, 0.0)
    width, height = figures.size
    voxels = f"  {figures.voxels}³ voxels" if figures.voxels else ""
    imgui.text_unformatted(f"{figures.scene}  {width}x{height}{voxels}  {figures.view}")
    _colored(theme.MUTED, figures.driver)
    frame_ms = figures.frame_ms
    rate = f"{1e3 / frame_ms:.1f} frames/s  {frame_ms:.2f} ms  " if frame_ms else ""
    imgui.text_unformatted(f"{rate}CPU {figures.cpu_ms:.2f} ms")
    paused = "  paused" if figures.paused else ""
    _colored(theme.MUTED, f"time {figures.time_s:.2f} s{paused}  speed {figures.speed:.3g} m/s")
    room = max(place[2] - place[0] - 4.0 * MARGIN_PX, LEAST_PROBLEM_EM * imgui.get_font_size())
    imgui.push_text_wrap_pos(room)
    for problem in figures.problems:
        _colored(theme.RED, problem)
    imgui.pop_text_wrap_pos()
    for name, count in figures.counters.items():
        if "dropped" in name and count:
            _colored(theme.RED, f"{name.replace('_', ' ').upper()}: {count:,}")
    others = len(figures.counters) + len(figures.bytes) + LINES_AROUND
    line = imgui.get_text_line_height() + 2.0 * imgui.get_style().cell_padding.y
    fitting = max(int((place[3] - place[1]) / line) - others, LEAST_PASSES)
    _figures("passes", _longest(figures.passes, fitting))
    _figures("counters", [(n.replace("_", " "), f"{c:,}") for n, c in figures.counters.items()])
    _figures("bytes", [(n, f"{b / 2**20:.1f} MiB") for n, b in figures.bytes.items()])
    _colored(theme.MUTED, "F1 keys, F5 panel, F6 hides this")
    imgui.pop_font()
    imgui.end()


def _longest(passes: Mapping[str, float], count: int) -> list[tuple[str, str]]:
    """Rows of the longest passes, in the order of the frame; the rest of them in one."""
    kept = sorted(passes, key=lambda name: -passes[name])[:count]
    rows = [(name, f"{ms:.3f} ms") for name, ms in passes.items() if name in kept]
    rest = [ms for name, ms in passes.items() if name not in kept]
    if rest:
        rows.append((f"{len(rest)} more", f"{sum(rest):.3f} ms"))
    return [*rows, ("all passes", f"{sum(passes.values()):.3f} ms")]


def draw_keys() -> None:
    """All bindings, in the middle of the window: they may need more room than the picture has.

    On a low window they stand in two blocks; where these are too wide, the wheel scrolls.
    """
    viewport = imgui.get_main_viewport()
    center, room, em = viewport.get_center(), viewport.size, imgui.get_font_size()
    rows = [(binding.keys_text(), binding.help) for binding in BINDINGS]
    line = imgui.get_text_line_height() + 2.0 * imgui.get_style().cell_padding.y
    low = (len(rows) + 3) * line > room.y - 2.0 * MARGIN_PX
    blocks = 2 if low and room.x > 2.0 * BLOCK_EM * em else 1
    largest = imgui.ImVec2(room.x - 2.0 * MARGIN_PX, room.y - 2.0 * MARGIN_PX)
    imgui.set_next_window_size_constraints(imgui.ImVec2(0.0, 0.0), largest)
    passive = imgui.WindowFlags_.no_inputs.value | imgui.WindowFlags_.no_scrollbar.value
    passive |= imgui.WindowFlags_.no_focus_on_appearing.value
    _begin("keys", (center.x, center.y), (0.5, 0.5), 0.97, _PANEL & ~passive)
    _colored(theme.ACCENT, "Keys")
    imgui.separator()
    height = -(-len(rows) // blocks)
    if imgui.begin_table("bindings", 2 * blocks, _TABLE):
        for number in range(height):
            for row in rows[number::height]:
                for text in row:
                    imgui.table_next_column()
                    imgui.text_unformatted(text)
            imgui.table_next_row()
        imgui.end_table()
    imgui.end()


def draw_pixel(values: Mapping[str, Probed], place: Rect, fonts: Fonts) -> None:
    """Beside the mouse: what the pixel under it holds. The picture's own as display codes too."""
    mouse = imgui.get_mouse_pos()
    right = mouse.x > (place[0] + place[2]) / 2
    lower = mouse.y > (place[1] + place[3]) / 2
    offset = (-MARGIN_PX if right else 2 * MARGIN_PX, -MARGIN_PX if lower else MARGIN_PX)
    _begin("pixel", (mouse.x + offset[0], mouse.y + offset[1]), (float(right), float(lower)))
    imgui.push_font(fonts.figures, 0.0)
    for name, probed in values.items():
        x, y = probed.texel
        numbers = "  ".join(f"{value:.6g}" for value in probed.values[:3])
        if name == PICTURE_NAME and max(probed.values) <= 1.0:
            codes = "  ".join(f"{255 * value:.0f}" for value in probed.values[:3])
            numbers = f"{numbers}   ({codes})"
        _colored(theme.MUTED, f"{name} ({x}, {y})")
        imgui.text_unformatted(numbers)
    imgui.pop_font()
    imgui.end()


def draw_message(text: str, place: Rect, rgb: theme.Rgb) -> None:
    """Some words at the bottom of the picture's place, wrapped within it."""
    _begin("message", ((place[0] + place[2]) / 2, place[3] - MARGIN_PX), (0.5, 1.0))
    padding = imgui.get_style().window_padding.x
    room = place[2] - place[0] - 2.0 * (MARGIN_PX + padding)
    width = min(max(room, 1.0), MESSAGE_EM * imgui.get_font_size())
    imgui.push_text_wrap_pos(imgui.get_cursor_pos_x() + width)
    _colored(rgb, text)
    imgui.pop_text_wrap_pos()
    imgui.end()


def _begin(
    name: str,
    place: tuple[float, float],
    pivot: tuple[float, float],
    opacity: float = BACKGROUND_OPACITY,
    flags: int = _PANEL,
) -> None:
    always = imgui.Cond_.always.value
    imgui.set_next_window_pos(imgui.ImVec2(*place), always, imgui.ImVec2(*pivot))
    imgui.set_next_window_bg_alpha(opacity)
    imgui.begin(name, None, flags)


def _colored(rgb: theme.Rgb, text: str) -> None:
    imgui.push_style_color(imgui.Col_.text.value, theme.color(rgb))
    imgui.text_unformatted(text)
    imgui.pop_style_color()


def _figures(name: str, rows: Sequence[tuple[str, str]]) -> None:
    """Two columns, the right one of figures that end below each other (the font is monospaced)."""
    width = max((len(figure) for _, figure in rows), default=0)
    _two_columns(name, [(left, figure.rjust(width)) for left, figure in rows])


def _two_columns(name: str, rows: Sequence[tuple[str, str]]) -> None:
    imgui.separator()
    if rows and imgui.begin_table(name, 2, _TABLE):
        for left, right in rows:
            imgui.table_next_column()
            imgui.text_unformatted(left)
            imgui.table_next_column()
            imgui.text_unformatted(right)
        imgui.end_table()
