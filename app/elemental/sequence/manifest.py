"""The note beside a sequence's frames: what they show, and what later frames need to know of them.

Frames of one folder belong together only if everything that shapes them is the same. The note says
what that was, so that a later run goes on with them or refuses.
"""

from __future__ import annotations

import base64
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from elemental import __version__
from elemental.core.digest import digest
from elemental.core.errors import InputError
from elemental.core.files import read_file
from elemental.core.paths import is_file, named_file
from elemental.gpu.device import Device
from elemental.report import settings_entry, write_json
from elemental.scene.model import Scene
from elemental.session import Stage
from elemental.settings import SETTINGS

SCHEMA = "elemental.sequence/1"
FILE_NAME = "sequence.json"

NOT_SEEN = frozenset({
    "name", "path", "folder", "warnings", "notes", "settings", "animations",
})  # fmt: skip
"""Fields of a scene that no frame shows (its settings count as they end up)."""


def identity(
    stage: Stage, device: Device, size: tuple[int, int], view: str, fps: float, first: int
) -> dict[str, Any]:
    """Everything that shapes the frames, in the order in which differences are told."""
    seen = {k: v for k, v in vars(stage.scene).items() if k not in NOT_SEEN}
    return {
        "elemental": __version__,
        "driver": f"{device.info.renderer}, {device.info.version}",
        "first frame": first,
        "frames a second": fps,
        "size": list(size),
        "view": view,
        "camera": digest([stage.camera, stage.path]),
        "scene": digest(seen),
        "settings": settings_entry(stage.settings),
        "file that a setting names": _named_files(stage),
    }


def _named_files(stage: Stage) -> dict[str, str]:
    """Digests of the files that settings and volumes name, by those names."""
    keys = [key for key, setting in SETTINGS.items() if setting.unit == "file"]
    overrides = [volume.overrides for volume in stage.scene.volumes]
    names = {str(s[key]) for s in (stage.settings, *overrides) for key in keys if s.get(key)}
    files = {name: named_file(name, stage.scene.folder) for name in sorted(names)}
    return {name: digest(file.read_bytes()) for name, file in files.items() if is_file(file)}


def scene_file(scene: Scene) -> str:
    """For people who read the note."""
    return str(scene.path)


class Manifest:
    """The note of one folder. ``states``: the renderer's history after some frames."""

    def __init__(self, folder: Path, shapes: Mapping[str, Any], scene: str) -> None:
        self.path = folder / FILE_NAME
        self._shapes, self._scene = dict(shapes), scene
        self.states: dict[int, bytes] = {}
        self._range = range(0)

    def resume(self) -> bool:
        """Take over the folder's note; False where there is none.

        Raises InputError where its frames were shaped by something else, or it can't be read.
        """
        if not self.path.exists():
            return False
        try:
            told = json.loads(read_file(self.path))
            known, states = told["shapes"], told["states"]
            self._range = range(*told["range"])
            self.states = {int(k): base64.b64decode(v, validate=True) for k, v in states.items()}
            if told["schema"] != SCHEMA or not isinstance(known, dict):
                raise ValueError("another kind of file")
        except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
            raise InputError(self.path, "", "is broken; --overwrite begins anew") from error
        for name, value in self._shapes.items():
            if known.get(name) != value:
                reason = f"holds frames of another {_difference(name, known.get(name), value)}"
                raise InputError("-o", str(self.path.parent), f"{reason}; --overwrite begins anew")
        return True

    def told_range(self) -> range:
        """Frames that the folder's note speaks of, whatever they show; none if it is broken."""
        try:
            first, end = json.loads(read_file(self.path))["range"]
            return range(first, end)
        except (InputError, ValueError, KeyError, TypeError, RecursionError):
            return range(0)

    def include(self, first: int, last: int) -> None:
        """Speak of these frames too."""
        known = self._range or range(first, last + 1)
        self._range = range(min(known.start, first), max(known.stop, last + 1))

    def write(self) -> None:
        """Replace the folder's note, whole or not at all. Raises InputError."""
        states = {str(k): base64.b64encode(v).decode() for k, v in sorted(self.states.items())}
        span = [self._range.start, self._range.stop]
        content = {"schema": SCHEMA, "scene": self._scene, "range": span, "shapes": self._shapes}
        write_json(self.path, {**content, "states": states})


def _difference(name: str, known: Any, value: Any) -> str:
    """What is told of a difference: which setting it is, and both values if they tell anything."""
    if name == "settings" and isinstance(known, dict):
        key = next(k for k in {**value, **known} if known.get(k) != value.get(k))
        return f"{key} ({known.get(key)}, not {value.get(key)})"
    if name in ("scene", "camera", "file that a setting names"):
        return f"{name}, or of what it was before a change"
    return f"{name} ({known}, not {value})"
