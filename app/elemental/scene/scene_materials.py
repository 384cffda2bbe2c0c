"""A scene file's materials: artist's definitions and values for what the models bring along."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from fnmatch import fnmatchcase
from pathlib import Path

from elemental.core.errors import InputError, named_by
from elemental.core.images import check_side, read_png_jpeg_webp
from elemental.scene.definitions import COMMON_PARAMETERS, MaterialDefinition, find_definition
from elemental.scene.materials import Material, Texture
from elemental.scene.model import Scene
from elemental.scene.parameters import PLAIN_TEXTURES
from elemental.scene.tables.materials import MaterialTable


def dress(scene: Scene, tables: Sequence[MaterialTable]) -> None:
    """Apply each table to the materials that its name, a pattern, fits; later ones come on top.

    Raises InputError for a name that fits none, and for an unknown definition, parameter, value or
    image.
    """
    images: dict[Path, int] = {}
    for number, table in enumerate(tables):
        field = f"materials[{number}]"
        fitting = [n for n, m in enumerate(scene.materials) if fnmatchcase(m.name, table.name)]
        if not fitting:
            known = ", ".join(repr(m.name) for m in scene.materials)
            reason = f"no material is named {table.name!r}; known: {known or 'none'}"
            raise InputError(scene.path, f"{field}.name", reason)
        definition = None
        if table.shader is not None:
            folder = scene.path.parent
            definition = find_definition(table.shader, folder, scene.path, f"{field}.shader")
        for index in fitting:
            worn = _worn(scene.materials[index], table, definition)
            place = f"{field}.parameters"
            scene.materials[index] = valued(worn, table.parameters, scene, place, images)


def _worn(
    material: Material, table: MaterialTable, definition: MaterialDefinition | None
) -> Material:
    if definition is not None:
        material = material.with_definition(definition)
    if table.double_sided is not None:
        material = replace(material, double_sided=table.double_sided)
    if table.alpha_mode is not None:
        material = replace(material, alpha_mode=table.alpha_mode)
    return material


def valued(
    material: Material,
    parameters: Mapping[str, object],
    scene: Scene,
    field: str,
    images: dict[Path, int],
) -> Material:
    """A material with values for its parameters as a scene file has them.

    `images`: those read already, by path, as numbers of the scene's textures. Raises InputError,
    which names the file's `field`.
    """
    for name, value in parameters.items():
        try:
            checked = material.definition.check_value(name, value)
            parameter = material.definition.parameter(name)
            if parameter is None or parameter.kind != "texture":
                material = material.with_value(name, value)
                continue
        except InputError as error:
            raise InputError(scene.path, f"{field}.{name}", error.reason) from None
        if checked == parameter.default and checked in PLAIN_TEXTURES:
            material = material.without_image(name)
        elif checked in PLAIN_TEXTURES and name not in COMMON_PARAMETERS:
            material = material.without_image(name).with_value(name, checked)
        else:
            number = _image(scene, str(checked), f"{field}.{name}", images)
            material = material.with_image(name, number)
    return material


def _image(scene: Scene, name: str, field: str, images: dict[Path, int]) -> int:
    """An image beside the scene file as one of the scene's textures, each read once."""
    path = scene.path.parent / name
    if path not in images:
        with named_by(scene.path, field, name):
            texture = read_texture(path)
        images[path] = len(scene.textures)
        scene.textures.append(texture)
    return images[path]


def read_texture(path: Path) -> Texture:
    """An image file as a texture that repeats. Raises InputError."""
    pixels = read_png_jpeg_webp(path)
    check_side(path, pixels.shape)
    return Texture(path.stem, pixels, file=path)
