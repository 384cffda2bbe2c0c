"""docs/scene-files.md shows every key that a scene file may have, and shows them right."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from elemental.scene.scene_file import SceneFile, read_scene_file
from elemental.scene.tables.base import Table

PAGE = Path(__file__).resolve().parents[3] / "docs" / "scene-files.md"


def shown_tables(value: object) -> Iterator[Table]:
    """Every table inside."""
    if isinstance(value, Table):
        yield value
        for key in type(value).model_fields:
            yield from shown_tables(getattr(value, key))
    elif isinstance(value, list):
        for item in value:
            yield from shown_tables(item)


def test_the_page_shows_every_key_of_every_table(tmp_path: Path) -> None:
    blocks = re.findall(r"```toml\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    example = tmp_path / "yard.toml"
    example.write_text("".join(blocks), encoding="utf-8")
    shown: dict[type[Table], set[str]] = {}
    for table in shown_tables(read_scene_file(example)):
        shown.setdefault(type(table), set()).update(table.model_fields_set)
    assert SceneFile in shown
    # Tables that nothing above shows, and keys that its tables do not.
    declared = {kind for kind in every_subclass(Table) if kind.model_fields}
    assert declared == set(shown)
    missing = {(kind.__name__, key) for kind in declared for key in kind.model_fields} - {
        (kind.__name__, key) for kind, keys in shown.items() for key in keys
    }
    assert missing == set()


def every_subclass(kind: type[Table]) -> Iterator[type[Table]]:
    """All tables, at any depth."""
    for below in kind.__subclasses__():
        yield below
        yield from every_subclass(below)
