"""``elemental list``: what can be named on the command line, a line each, columns aligned."""

from __future__ import annotations

from elemental.core.text import columns
from elemental.settings import SETTINGS

OF_A_SCENE = ("cameras", "animations")
"""What is listed of one scene."""


def lines(what: str, scene: str | None = None) -> list[str]:
    """The lines of one of the lists: ``views``, ``settings``, ``scenes``, ``materials``,
    ``bindings``, or of one of OF_A_SCENE.

    Raises InputError for a scene that can't be opened.
    """
    if what in OF_A_SCENE:
        return _of_scene(what, scene or "")
    tables = {
        "views": _views,
        "settings": _settings,
        "scenes": _scenes,
        "materials": _materials,
        "bindings": _bindings,
    }
    return tables[what]()


def _settings() -> list[str]:
    return columns(
        [
            (
                s.key,
                s.value_text(s.default) or '""',
                s.range_text(),
                "volume" if s.volume else "",
                s.help,
            )
            for s in SETTINGS.values()
        ]
    )


def _scenes() -> list[str]:
    from elemental.scene.load import scene_names  # noqa: PLC0415 (100 ms to import)

    return scene_names()


def _materials() -> list[str]:
    """A material a line, each followed by its parameters, indented."""
    from elemental.scene.definitions import builtin, definition_names  # noqa: PLC0415 (as above)

    definitions = [builtin(name) for name in definition_names()]
    rows = [
        (
            f"  {p.name}",
            f"{p.kind} {p.unit}".strip(),
            p.value_text(p.default),
            p.range_text(),
            p.help,
        )
        for definition in definitions
        for p in definition.parameters
    ]
    told = iter(columns(rows))
    found = []
    for definition in definitions:
        found.append(f"{definition.name}: {definition.help}")
        found += [next(told) for _ in definition.parameters]
    return found


def _views() -> list[str]:
    from elemental.frame import VIEWS  # noqa: PLC0415 (pulls in the whole renderer)

    return columns(list(VIEWS.items()))


def _bindings() -> list[str]:
    from elemental.ui.bindings import BINDINGS  # noqa: PLC0415 (only this list needs it)

    return columns([(b.keys_text(), b.help) for b in BINDINGS])


def _of_scene(what: str, scene: str) -> list[str]:
    from elemental.session import open_scene  # noqa: PLC0415 (only these lists open a scene)

    opened, _ = open_scene(scene, ())
    if what == "cameras":
        return [camera.name for camera in opened.cameras]
    return opened.animations + [f"[[motions]] {mover}" for mover in opened.movers]
