"""Which glTF extensions are honoured, and what is said of the others."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from elemental.core.errors import InputError
from elemental.scene.gltf.container import Document
from elemental.scene.gltf.fields import printable

SUPPORTED = frozenset({
    "EXT_texture_webp",
    "KHR_draco_mesh_compression",
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_node_visibility",
    "KHR_texture_transform",
})  # fmt: skip

WARNED_WHERE_USED = frozenset({
    "KHR_animation_pointer", "KHR_texture_basisu",
})  # fmt: skip
"""Partly honoured; the animation, material or image that uses them gives the warning."""

WITHOUT_EFFECT = frozenset({"KHR_xmp", "KHR_xmp_json_ld"})
"""Nothing to draw."""

APPEARANCE_PREFIX = "KHR_materials_"
"""Extensions of materials: without them the picture is plainer, yet all of the scene is there."""


def check_extensions(document: Document) -> None:
    """Warn of each extension that is ignored.

    Raises InputError for a required one that isn't known to change materials or textures alone.
    """
    root = document.root
    required = {name.text(): name for name in root.elements("extensionsRequired")}
    used = [name.text() for name in root.elements("extensionsUsed")]
    for name in dict.fromkeys([*required, *used]):
        if name in SUPPORTED | WARNED_WHERE_USED | WITHOUT_EFFECT:
            continue
        if name in required and not name.startswith(APPEARANCE_PREFIX):
            reason = f"{name} is not supported"
            raise InputError(document.path, required[name].path, reason)
        document.report.warn("extensionsUsed", f"{name} is not supported and ignored")
    known = {*required, *used} | SUPPORTED | WARNED_WHERE_USED | WITHOUT_EFFECT
    for name, place in _extended(root.raw).items():
        if name not in known:
            reason = f"{printable(name)} is not supported and ignored; extensionsUsed lacks it"
            document.report.warn(place, reason)


def _extended(root: Any) -> dict[str, str]:
    """Each extension of any object of the JSON, and where it is met first."""
    found: dict[str, str] = {}
    pending: list[tuple[str, Any]] = [("", root)]
    while pending:
        place, value = pending.pop()
        items: Iterable[tuple[str, Any]] = ()
        if isinstance(value, dict):
            items = ((f"{place}.{key}" if place else key, part) for key, part in value.items()
                     if key != "extras")  # fmt: skip
            extensions = value.get("extensions")
            if isinstance(extensions, dict):
                for name in extensions:
                    found.setdefault(name, f"{place}.extensions" if place else "extensions")
        elif isinstance(value, list):
            items = ((f"{place}[{k}]", part) for k, part in enumerate(value))
        holding = [item for item in items if isinstance(item[1], dict | list)]
        pending += reversed(holding)
    return found
