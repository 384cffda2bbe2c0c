"""The files that settings name: tables of colours, images, a sky."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from elemental.core.cube_lut import read_cube_lut
from elemental.core.errors import named_by
from elemental.core.files import check_file
from elemental.core.images import read_lens_texture
from elemental.core.paths import named_file
from elemental.scene.volumes import Volume
from elemental.settings import SETTINGS

FILE_KEYS = frozenset(key for key, setting in SETTINGS.items() if setting.unit == "file")
"""Settings that name a file."""
READERS: Mapping[str, Callable[[Path], object]] = {
    "sky.image": check_file,  # large, and read at once by who opens the scene
    "color_grading.lut": read_cube_lut,
    "bloom.dirt_mask": read_lens_texture,
    "lens_flare.bokeh_shape": read_lens_texture,
}
"""What reads a setting's file. Raises InputError."""


def check_named(
    key: str, name: Any, folder: Path, file: str | Path, field: str, typed: str = ""
) -> None:
    """Read the file that a setting of a scene in `folder` names, if it is such a setting.

    Raises InputError(file, field, reason); the reason begins with the name, or as it was `typed`.
    """
    if key in FILE_KEYS and name:
        with named_by(file, field, typed or name):
            READERS[key](named_file(name, folder))


def check_volume_files(volumes: Sequence[Volume], path: Path) -> None:
    """Read the files that volumes name, enabled or not. Raises InputError(path, field, reason)."""
    for number, volume in enumerate(volumes):
        for key, name in volume.overrides.items():
            check_named(key, name, path.parent, path, f"volumes[{number}].settings.{key}")


def seen_from_here(key: str, value: Any) -> Any:
    """A value typed in a shell: files count from the working directory, others as in a scene."""
    if key in FILE_KEYS and value and os.path.exists(value):
        return os.path.realpath(value)
    return value
