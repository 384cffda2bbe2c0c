"""The panel's own state between runs: its layout, scale, and what shows. Never a scene's."""

from __future__ import annotations

import json
import math
from dataclasses import asdict, dataclass, field, fields
from pathlib import Path
from typing import Any

from elemental.core.errors import InputError
from elemental.core.files import atomic_file, read_file
from elemental.core.user_files import config_folder

FILE = "panel.json"
VERSION = 1
"""Of the default layout: a file of another is left aside."""
SCALE_RANGE = (0.5, 4.0)


@dataclass
class Preferences:
    """What is kept. ``layout`` is ImGui's own text of places and docks, empty for the default."""

    version: int = VERSION
    layout: str = ""
    scale: float = 1.0
    shows_panel: bool = True
    shows_hud: bool = False
    hidden: list[str] = field(default_factory=list)
    """Pages that do not show."""


def preferences_file() -> Path:
    """Where they are kept, in the user's configuration folder."""
    return config_folder() / FILE


def load(path: Path) -> Preferences:
    """What the file holds; the defaults for what it lacks or holds wrongly, or all of them."""
    default = Preferences()
    try:
        held = json.loads(read_file(path))
    except (InputError, ValueError, RecursionError):
        return default
    if not isinstance(held, dict) or held.get("version") != VERSION:
        return default
    values: dict[str, Any] = {}
    for kept in fields(Preferences):
        value, expected = held.get(kept.name), getattr(default, kept.name)
        if isinstance(expected, float) and type(value) is int:
            value = float(value)
        if isinstance(value, list):
            value = [item for item in value if isinstance(item, str)]
        if type(value) is type(expected):
            values[kept.name] = value
    found = Preferences(**values)
    lo, hi = SCALE_RANGE
    found.scale = min(max(found.scale, lo), hi) if math.isfinite(found.scale) else 1.0
    return found


def save(path: Path, preferences: Preferences) -> None:
    """Write them, whole or not at all. Raises InputError where the folder can't be written."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(path.parent, "", f"can't be made ({error.strerror})") from error
    with atomic_file(path) as temporary:
        temporary.write_text(json.dumps(asdict(preferences), indent=1), encoding="utf-8")
