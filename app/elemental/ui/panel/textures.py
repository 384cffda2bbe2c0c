"""The row of a material's texture: what it is, a file's name to type or to look for."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from imgui_bundle import imgui

from elemental.core.errors import InputError
from elemental.scene.materials import Material, Texture
from elemental.scene.parameters import Parameter
from elemental.scene.save_names import relative
from elemental.settings import Setting
from elemental.ui import theme
from elemental.ui.images import Place
from elemental.ui.rows import spelled
from elemental.ui.widgets import Widgets

PREVIEW_EM = 14.0
"""Longest side of the picture in the tooltip, in heights of the text."""


@dataclass(frozen=True)
class Images:
    """What rows are told of images, and whom they ask for others."""

    textures: Sequence[Texture]
    folder: Path
    """Of the scene's file: names count from here."""
    picture: Callable[[int], int]
    """GL's name of a small copy of one of the textures."""
    choose: Callable[[Place, str], None]
    """Have a file for a place; an empty name: nothing."""
    put_back: Callable[[Place], None]
    """Have what is saved."""
    is_reading: Callable[[Place], bool]
    problem: Callable[[Place], InputError | None]
    projected: frozenset[int] = frozenset()
    """Materials that decals project."""


def texture_row(
    w: Widgets,
    images: Images,
    index: int,
    material: Material,
    saved: Material,
    parameter: Parameter,
) -> None:
    """Draw the row of one of the textures of a scene's material ``index``."""
    label = label_of(parameter)
    if w.is_out_of_sight(label):
        return
    name, place = parameter.name, (index, parameter.name)
    slot, before = material.texture(name), saved.texture(name)
    number = -1 if slot is None else slot.texture
    saved_number = -1 if before is None else before.texture
    changed = number != saved_number
    imgui.push_id(name)
    w.row(label, f"{parameter.help}\n{_file_help(images.folder)}".strip(), changed)
    texture = images.textures[number] if slot is not None else None
    _swatch(w, images, name, number, texture)
    plain = material.values.get(name, parameter.default)
    hint = "reading…" if images.is_reading(place) else f"none: {plain}"
    setting = Setting(name, "text", "", parameter.help, unit="file")
    edit = w.file(name, setting, shown_name(texture, images.folder), hint, images.folder)
    problem = images.problem(place)
    if w.reset(name, changed or problem is not None, _reset_text(images, saved_number)):
        images.put_back(place)
    elif edit is not None:
        images.choose(place, edit.value)
    imgui.pop_id()
    if problem is not None:
        w.paragraph(f"{Path(problem.file).name}: {problem.reason}", theme.RED)
        w.note(f"problem {name}")


def label_of(parameter: Parameter) -> str:
    """``Base colour map``: shorter than the parameter's name, and as artists say it."""
    return f"{spelled(parameter.name.removesuffix('_texture'))} map"


def shown_name(texture: Texture | None, folder: Path) -> str:
    """A texture as its row tells it: its file from the scene's folder, or its model's image."""
    if texture is None:
        return ""
    if texture.file is None:
        return f"{texture.name or 'an image'} (in the model)"
    return relative(texture.file, folder)


def _file_help(folder: Path) -> str:
    return f"a PNG, JPEG or WebP file, seen from {folder}; nothing typed: none"


def _reset_text(images: Images, number: int) -> str:
    if number < 0:
        return "none"
    return shown_name(images.textures[number], images.folder)


def _swatch(w: Widgets, images: Images, name: str, number: int, texture: Texture | None) -> None:
    """A small picture before the name, a large one when the mouse is on it."""
    width = imgui.calc_item_width()
    side = imgui.get_frame_height()
    size = imgui.ImVec2(side, side)
    if texture is None:
        imgui.color_button(f"##none {name}", theme.color(theme.BACKDROP),
                           imgui.ColorEditFlags_.no_tooltip, size)  # fmt: skip
    else:
        imgui.image(imgui.ImTextureRef(images.picture(number)), size)
        w.note(f"picture {name}")
        if imgui.is_item_hovered():
            _preview(images.picture(number), texture)
    imgui.same_line(0.0, imgui.get_style().item_inner_spacing.x)
    imgui.set_next_item_width(width - side - imgui.get_style().item_inner_spacing.x)


def _preview(glo: int, texture: Texture) -> None:
    height, width = texture.pixels.shape[:2]
    scale = PREVIEW_EM * imgui.get_font_size() / max(width, height)
    if imgui.begin_tooltip():
        imgui.image(imgui.ImTextureRef(glo), imgui.ImVec2(scale * width, scale * height))
        imgui.text_unformatted(f"{texture.name}  {width}x{height}")
        imgui.end_tooltip()
