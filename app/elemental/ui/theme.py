"""The panel's look: neutral greys that leave colours to the picture, one accent, even spacing."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import imgui_bundle
from imgui_bundle import imgui

TEXT_PX = 15.0
"""Height of the text at a UI scale of 1, on a display without scaling."""
ICON_PX = 12.5
"""Height of an icon that stands among text of TEXT_PX."""

Rgb = tuple[float, float, float]

TEXT: Rgb = (0.86, 0.86, 0.85)
MUTED: Rgb = (0.56, 0.57, 0.58)
ACCENT: Rgb = (0.93, 0.60, 0.27)
"""What was changed, what is held, what is chosen; ember, as the demo's."""
RED: Rgb = (0.94, 0.36, 0.30)
GREEN: Rgb = (0.52, 0.76, 0.45)
BLUE: Rgb = (0.42, 0.62, 0.84)

BACKDROP: Rgb = (0.075, 0.078, 0.082)
"""Behind the panels, where no picture is."""
_PANEL: Rgb = (0.125, 0.129, 0.134)
_FIELD: Rgb = (0.185, 0.190, 0.197)
_RAISED: Rgb = (0.225, 0.231, 0.239)
_LIT: Rgb = (0.290, 0.298, 0.308)
_GRAB: Rgb = (0.360, 0.370, 0.382)
_EDGE: Rgb = (0.060, 0.062, 0.065)

_COLORS: dict[str, tuple[Rgb, float]] = {
    "text": (TEXT, 1.0), "text_disabled": (MUTED, 1.0),
    "window_bg": (_PANEL, 1.0), "child_bg": (_PANEL, 0.0), "popup_bg": (_PANEL, 0.98),
    "border": (_EDGE, 1.0), "border_shadow": (_EDGE, 0.0),
    "frame_bg": (_FIELD, 1.0), "frame_bg_hovered": (_RAISED, 1.0), "frame_bg_active": (_LIT, 1.0),
    "title_bg": (BACKDROP, 1.0), "title_bg_active": (BACKDROP, 1.0),
    "title_bg_collapsed": (BACKDROP, 1.0), "menu_bar_bg": (BACKDROP, 1.0),
    "scrollbar_bg": (_PANEL, 0.0), "scrollbar_grab": (_RAISED, 1.0),
    "scrollbar_grab_hovered": (_LIT, 1.0), "scrollbar_grab_active": (ACCENT, 1.0),
    "check_mark": (ACCENT, 1.0), "slider_grab": (_GRAB, 0.75), "slider_grab_active": (ACCENT, 1.0),
    "button": (_FIELD, 1.0), "button_hovered": (_RAISED, 1.0), "button_active": (_LIT, 1.0),
    "header": (_FIELD, 0.75), "header_hovered": (_RAISED, 1.0), "header_active": (_LIT, 1.0),
    "separator": (_EDGE, 1.0), "separator_hovered": (ACCENT, 0.6), "separator_active": (ACCENT, 1),
    "resize_grip": (_FIELD, 0.0), "resize_grip_hovered": (ACCENT, 0.6),
    "resize_grip_active": (ACCENT, 1.0),
    "tab": (BACKDROP, 1.0), "tab_hovered": (_RAISED, 1.0), "tab_selected": (_PANEL, 1.0),
    "tab_selected_overline": (ACCENT, 1.0), "tab_dimmed": (BACKDROP, 1.0),
    "tab_dimmed_selected": (_PANEL, 1.0), "tab_dimmed_selected_overline": (MUTED, 0.6),
    "docking_preview": (ACCENT, 0.5), "docking_empty_bg": (BACKDROP, 1.0),
    "plot_lines": (TEXT, 1.0), "plot_histogram": (BLUE, 1.0),
    "table_header_bg": (_FIELD, 1.0), "table_border_strong": (_EDGE, 1.0),
    "table_border_light": (_EDGE, 1.0), "table_row_bg": (_PANEL, 0.0),
    "table_row_bg_alt": ((1.0, 1.0, 1.0), 0.02), "text_selected_bg": (ACCENT, 0.35),
    "modal_window_dim_bg": (_EDGE, 0.55),
    "drag_drop_target": (ACCENT, 1.0), "nav_cursor": (ACCENT, 0.7),
}  # fmt: skip


@dataclass(frozen=True)
class Fonts:
    """``text`` for words, with icons; ``figures`` for columns, all of one width."""

    text: imgui.ImFont
    figures: imgui.ImFont


def color(rgb: Rgb, opacity: float = 1.0) -> imgui.ImVec4:
    """A colour as ImGui takes it in its styles."""
    return imgui.ImVec4(*rgb, opacity)


def packed(rgb: Rgb, opacity: float = 1.0) -> int:
    """A colour as draw lists take it."""
    return int(imgui.color_convert_float4_to_u32(color(rgb, opacity)))


def load_fonts() -> Fonts:
    """The fonts that come with imgui_bundle; ImGui's own where it was packed without them."""
    folder = Path(imgui_bundle.__file__).parent / "assets" / "fonts"
    atlas = imgui.get_io().fonts
    files = (
        folder / "Roboto" / "Roboto-Regular.ttf",
        folder / "Font_Awesome_6_Free-Solid-900.otf",
        folder / "Inconsolata-Medium.ttf",
    )
    if not all(file.is_file() for file in files):
        plain = atlas.add_font_default_vector()
        return Fonts(plain, plain)
    text = atlas.add_font_from_file_ttf(str(files[0]), TEXT_PX)
    icons = imgui.ImFontConfig()
    icons.merge_mode = True
    icons.glyph_offset = imgui.ImVec2(0.0, 1.0)
    atlas.add_font_from_file_ttf(str(files[1]), ICON_PX, icons)
    return Fonts(text, atlas.add_font_from_file_ttf(str(files[2]), TEXT_PX))


def apply(display_scale: float) -> None:
    """Set colours and spacing; ``display_scale`` is what the display asks for."""
    style = imgui.get_style()
    style.font_size_base = TEXT_PX
    style.font_scale_dpi = display_scale
    style.window_padding = imgui.ImVec2(10.0, 8.0)
    style.frame_padding = imgui.ImVec2(7.0, 3.0)
    style.item_spacing = imgui.ImVec2(7.0, 5.0)
    style.item_inner_spacing = imgui.ImVec2(6.0, 4.0)
    style.indent_spacing = 14.0
    style.scrollbar_size = 11.0
    style.grab_min_size = 9.0
    style.window_border_size = 1.0
    style.frame_border_size = 0.0
    style.tab_bar_overline_size = 2.0
    style.docking_separator_size = 3.0
    for rounding in ("frame", "grab", "popup", "scrollbar", "tab", "child"):
        setattr(style, f"{rounding}_rounding", 3.0)
    style.window_rounding = 4.0
    style.window_menu_button_position = imgui.Dir.none
    for name, (rgb, opacity) in _COLORS.items():
        style.set_color_(getattr(imgui.Col_, name).value, color(rgb, opacity))
