"""Scene files: TOML that names glTF files, lights, an environment, cameras and settings.

`docs/scene-files.md` has the format; `tables/` has its tables, a module a topic.
"""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Annotated, Any

from pydantic import Field, ValidationError, model_validator

from elemental.core.errors import CombinedInputError, InputError
from elemental.core.files import read_file
from elemental.scene.tables.base import Name, Table
from elemental.scene.tables.cameras import CameraTable, PathTable
from elemental.scene.tables.decals import DecalTable
from elemental.scene.tables.lights import EnvironmentTable, LightChangeTable, LightTable
from elemental.scene.tables.materials import MaterialTable
from elemental.scene.tables.models import ModelTable
from elemental.scene.tables.motions import MotionTable
from elemental.scene.tables.regions import RegionTable
from elemental.scene.tables.volumes import VolumeTable


class SceneFile(Table):
    """The whole file, checked but for what it names."""

    name: Name | None = None
    exposure_ev: Annotated[float, Field(ge=-32.0, le=32.0)] | None = None
    models: Annotated[list[ModelTable], Field(min_length=1)]
    lights: list[LightTable] = []
    light_changes: list[LightChangeTable] = []
    materials: list[MaterialTable] = []
    motions: list[MotionTable] = []
    environment: EnvironmentTable | None = None
    cameras: list[CameraTable] = []
    camera_path: PathTable | None = None
    regions: list[RegionTable] = []
    volumes: list[VolumeTable] = []
    decals: list[DecalTable] = []
    settings: dict[str, Any] = {}

    @model_validator(mode="after")
    def _names_differ(self) -> SceneFile:
        names = [camera.name for camera in self.cameras]
        doubled = sorted({name for name in names if names.count(name) > 1})
        if doubled:
            raise ValueError(f"two cameras are named {doubled[0]!r}")
        return self


def read_scene_file(path: Path) -> SceneFile:
    """Parse and check a scene file.

    Raises InputError for a file that can't be read or is no TOML, and CombinedInputError with a
    line for each wrong, missing or unknown key.
    """
    try:
        text = read_file(path).decode("utf-8")
    except UnicodeDecodeError as error:
        raise InputError(path, "TOML", f"is broken ({error})") from error
    return parse_scene_file(text, path)


def parse_scene_file(text: str, path: Path) -> SceneFile:
    """Check a scene file's text; raises as ``read_scene_file``."""
    try:
        tables = tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        raise InputError(path, "TOML", f"is broken ({error})") from error
    try:
        return SceneFile.model_validate(tables)
    except ValidationError as error:
        found = error.errors(include_url=False, include_input=False)
        reasons = [
            (_field(e["loc"]), _reason(e["type"], e["msg"], e.get("ctx", {}))) for e in found
        ]
        raise CombinedInputError(path, reasons) from error


def flat_settings(settings: dict[str, Any], prefix: str = "") -> dict[str, Any]:
    """Nested tables as dotted keys: {"gi": {"resolution": 256}} -> {"gi.resolution": 256}."""
    flat: dict[str, Any] = {}
    for key, value in settings.items():
        if isinstance(value, dict):
            flat |= flat_settings(value, f"{prefix}{key}.")
        else:
            flat[prefix + key] = value
    return flat


def _field(place: tuple[int | str, ...]) -> str:
    """("lights", 0, "kind") as lights[0].kind."""
    field = ""
    for step in place:
        field += f"[{step}]" if isinstance(step, int) else f".{step}" if field else step
    return field


def _reason(kind: str, message: str, context: dict[str, Any]) -> str:
    """pydantic's words in those of the other errors."""
    if kind == "extra_forbidden":
        return "is an unknown key"
    if kind == "missing":
        return "is missing"
    if kind == "too_short":
        return f"needs {context['min_length']} items or more, not {context['actual_length']}"
    if kind == "too_long":
        return f"needs {context['max_length']} items or fewer, not {context['actual_length']}"
    return message.removeprefix("Value error, ").replace("Input should", "should")
