"""Scene files: TOML that names glTF files, lights, an environment, cameras and settings.

`docs/scene-files.md` has the format; `tables/` has its tables, a module a topic.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any

from pydantic import Field, ValidationError

from elemental.core.errors import CombinedInputError, InputError
from elemental.core.files import read_text
from elemental.core.toml import parse_toml
from elemental.scene.tables.base import Name, Table
from elemental.scene.tables.cameras import CameraTable, PathTable
from elemental.scene.tables.decals import DecalTable
from elemental.scene.tables.lights import EnvironmentTable, LightChangeTable, LightTable
from elemental.scene.tables.materials import MaterialTable
from elemental.scene.tables.models import ModelTable
from elemental.scene.tables.motions import MotionTable
from elemental.scene.tables.reasons import field, reason
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


def read_scene_file(path: Path) -> SceneFile:
    """Parse and check a scene file.

    Raises InputError for a file that can't be read or is no TOML, and CombinedInputError with a
    line for each wrong, missing or unknown key.
    """
    return parse_scene_file(read_text(path), path)


def parse_scene_file(text: str, path: Path) -> SceneFile:
    """Check a scene file's text; raises as ``read_scene_file``."""
    try:
        tables = parse_toml(text)
    except ValueError as error:
        raise InputError(path, "TOML", f"is broken ({error})") from error
    try:
        file = SceneFile.model_validate(tables)
    except ValidationError as error:
        found = error.errors(include_url=False, include_input=False)
        reasons = [(field(e["loc"]), reason(e["type"], e.get("ctx", {}))) for e in found]
        raise CombinedInputError(path, reasons) from error
    doubled = _doubled_names(file)
    if doubled:
        raise CombinedInputError(path, doubled)
    return file


def _doubled_names(file: SceneFile) -> list[tuple[str, str]]:
    """(field, reason) of each name that another thing of its kind has already."""
    named: dict[str, Sequence[ModelTable | LightTable | CameraTable]] = {
        "models": file.models,
        "lights": file.lights,
        "cameras": file.cameras,
    }
    doubled = []
    for section, tables in named.items():
        taken: set[str] = set()
        for number, table in enumerate(tables):
            if table.name is not None and table.name in taken:
                kind = section.removesuffix("s")
                taken_already = f"another {kind} is named {table.name!r}"
                doubled.append((f"{section}[{number}].name", taken_already))
            taken.add(table.name or "")
    return doubled


def flat_settings(settings: Mapping[str, Any], prefix: str = "") -> dict[str, Any]:
    """Nested tables as dotted keys: {"gi": {"resolution": 256}} -> {"gi.resolution": 256}."""
    flat: dict[str, Any] = {}
    for key, value in settings.items():
        if isinstance(value, Mapping):
            flat |= flat_settings(value, f"{prefix}{key}.")
        else:
            flat[prefix + key] = value
    return flat
