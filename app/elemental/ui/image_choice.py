"""What becomes of an image that is typed or looked for: a material's texture, a light's mask."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from elemental.core.paths import named_file
from elemental.scene.definitions import COMMON_PARAMETERS
from elemental.scene.light_masks import masked, read_light_mask
from elemental.scene.lights import LightMask
from elemental.scene.materials import Texture
from elemental.scene.parameters import PLAIN_TEXTURES
from elemental.ui.images import Place, read_fitting

if TYPE_CHECKING:
    from elemental.ui.desk import Desk


def choose_image(desk: Desk, place: Place, text: str) -> None:
    """Have another image in a place, from the next frames on; no text: none."""
    text = text.strip()
    desk.images.forget(place)
    if place.of == "light":
        _choose_mask(desk, place, text)
    else:
        _choose_texture(desk, place, text)


def put_image_back(desk: Desk, place: Place) -> None:
    """The image that is saved."""
    document, index, name = desk.document, place.index, place.name
    desk.images.forget(place)
    if place.of == "light":
        lights = document.state.lights
        document.set_light(index, masked(lights[index], document.saved.lights[index].mask))
        return
    saved = document.saved.materials[index].texture(name)
    material = document.state.materials[index].without_image(name)
    if saved is not None:
        material = material.with_slot(name, saved)
    document.set_material(index, material)


def _choose_texture(desk: Desk, place: Place, text: str) -> None:
    document, scene = desk.document, desk.stage.scene
    index, name = place.index, place.name
    material = document.state.materials[index]
    parameter = material.definition.parameter(name)
    plain = parameter is not None and parameter.default
    if text in ("", plain):
        document.set_material(index, material.without_image(name))
        return
    if text in PLAIN_TEXTURES and name not in COMMON_PARAMETERS:
        document.set_material(index, material.without_image(name).with_value(name, text))
        return

    def take(texture: Texture) -> None:
        scene.textures.append(texture)
        now = document.state.materials[index]
        document.set_material(index, now.with_image(name, len(scene.textures) - 1))

    read = partial(read_fitting, largest_px=desk.device.largest_texture_px)
    desk.images.ask(place, named_file(text, scene.path.parent.resolve()), read, take)


def _choose_mask(desk: Desk, place: Place, text: str) -> None:
    document, index = desk.document, place.index

    def take(mask: LightMask | None) -> None:
        document.set_light(index, masked(document.state.lights[index], mask))

    if text:
        path = named_file(text, desk.stage.scene.path.parent.resolve())
        desk.images.ask(place, path, read_light_mask, take)
    else:
        take(None)
