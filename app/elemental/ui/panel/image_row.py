"""The row of an image: a small picture of it, a file's name to type or to look for."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from dataclasses import dataclass
from pathlib import Path

from imgui_bundle import imgui

from elemental.core.errors import InputError
from elemental.scene.save_names import relative
from elemental.settings import Setting
from elemental.ui import theme
from elemental.ui.images import Picture, Place
from elemental.ui.widgets import Widgets

PREVIEW_EM = 14.0
"""Longest side of the picture in the tooltip, in heights of the text."""


@dataclass(frozen=True)
class Images:
    """What rows are told of images, and whom they ask for others."""

    folder: Path
    """Of the scene's file: names count from here."""
    picture: Callable[[Hashable, Picture], int]
    """GL's name of a small copy of an image, held under a key."""
    choose: Callable[[Place, str], None]
    """Have a file for a place; an empty name: nothing."""
    put_back: Callable[[Place], None]
    """Have what is saved."""
    is_reading: Callable[[Place], bool]
    problem: Callable[[Place], InputError | None]


@dataclass(frozen=True)
class ImageRow:
    """What a row shows. ``key``: under which a small copy of ``image`` is held."""

    label: str
    help: str
    image: Picture | None
    key: Hashable
    saved: Picture | None
    plain: str
    """What is there without an image."""


def image_row(w: Widgets, images: Images, place: Place, row: ImageRow) -> None:
    """Draw the row of the image of a place."""
    if w.is_out_of_sight(row.label):
        return
    name, changed = place.name, row.image is not row.saved
    imgui.push_id(name)
    told = f"a PNG, JPEG or WebP file, seen from {images.folder}; nothing typed: none"
    w.row(row.label, f"{row.help}\n{told}".strip(), changed)
    glo = 0 if row.image is None else images.picture(row.key, row.image)
    _swatch(w, name, glo, row.image)
    hint = "reading…" if images.is_reading(place) else f"none: {row.plain}"
    setting = Setting(name, "text", "", row.help, unit="file")
    edit = w.file(name, setting, shown_name(row.image, images.folder), hint, images.folder)
    problem = images.problem(place)
    back = shown_name(row.saved, images.folder) or "none"
    if w.reset(name, changed or problem is not None, back):
        images.put_back(place)
    elif edit is not None:
        images.choose(place, edit.value)
    imgui.pop_id()
    if problem is not None:
        w.paragraph(f"{Path(problem.file).name}: {problem.reason}", theme.RED)
        w.note(f"problem {name}")


def shown_name(image: Picture | None, folder: Path) -> str:
    """An image as its row tells it: its file from the scene's folder, or its model's."""
    if image is None:
        return ""
    if image.file is None:
        return f"{image.name or 'an image'} (in the model)"
    return relative(image.file, folder)


def _swatch(w: Widgets, name: str, glo: int, image: Picture | None) -> None:
    """A small picture before the name, a large one when the mouse is on it."""
    width = imgui.calc_item_width()
    side = imgui.get_frame_height()
    size = imgui.ImVec2(side, side)
    if image is None:
        imgui.color_button(f"##none {name}", theme.color(theme.BACKDROP),
                           imgui.ColorEditFlags_.no_tooltip, size)  # fmt: skip
    else:
        imgui.image(imgui.ImTextureRef(glo), size)
        w.note(f"picture {name}")
        if imgui.is_item_hovered():
            _preview(glo, image)
    imgui.same_line(0.0, imgui.get_style().item_inner_spacing.x)
    imgui.set_next_item_width(width - side - imgui.get_style().item_inner_spacing.x)


def _preview(glo: int, image: Picture) -> None:
    height, width = image.pixels.shape[:2]
    scale = PREVIEW_EM * imgui.get_font_size() / max(width, height)
    if imgui.begin_tooltip():
        imgui.image(imgui.ImTextureRef(glo), imgui.ImVec2(scale * width, scale * height))
        imgui.text_unformatted(f"{image.name}  {width}x{height}")
        imgui.end_tooltip()
