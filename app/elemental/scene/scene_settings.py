"""Settings out of a scene file's tables."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from elemental.core.errors import CombinedInputError, InputError
from elemental.scene.named_files import check_named
from elemental.scene.scene_file import flat_settings
from elemental.settings import check_setting


def settings_of(tables: Mapping[str, Any], path: Path) -> dict[str, Any]:
    """A scene file's settings by flat keys, as they are.

    Raises CombinedInputError with a line for each that is unknown or out of range, and for each
    that names a file that can't be read.
    """
    flat = flat_settings(tables)
    wrong: list[tuple[str, str]] = []
    for key, value in flat.items():
        try:
            check_setting("", key, value)
            check_named(key, value, path.parent, path, "")
        except InputError as error:
            wrong.append((f"settings.{key}", error.reason))
    if wrong:
        raise CombinedInputError(path, wrong)
    return flat
