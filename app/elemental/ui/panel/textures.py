"""The row of a material's texture."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from elemental.scene.materials import Material, Texture
from elemental.scene.parameters import Parameter
from elemental.ui.images import Place
from elemental.ui.panel.image_row import ImageRow, Images, image_row
from elemental.ui.rows import spelled
from elemental.ui.widgets import Widgets


@dataclass(frozen=True)
class MaterialImages:
    """The images of a scene's materials."""

    images: Images
    textures: Sequence[Texture]
    projected: frozenset[int] = frozenset()
    """Materials that decals project."""


def texture_row(
    w: Widgets,
    all_images: MaterialImages,
    index: int,
    material: Material,
    saved: Material,
    parameter: Parameter,
) -> None:
    """Draw the row of one of the textures of a scene's material ``index``."""
    name = parameter.name
    slot, before = material.texture(name), saved.texture(name)
    row = ImageRow(
        label=label_of(parameter),
        help=parameter.help,
        image=None if slot is None else all_images.textures[slot.texture],
        key=None if slot is None else slot.texture,
        saved=None if before is None else all_images.textures[before.texture],
        plain=str(material.values.get(name, parameter.default)),
    )
    image_row(w, all_images.images, Place("material", index, name), row)


def label_of(parameter: Parameter) -> str:
    """``Base colour map``: shorter than the parameter's name, and as artists say it."""
    return f"{spelled(parameter.name.removesuffix('_texture'))} map"
