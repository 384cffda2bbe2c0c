"""A rendered view as a picture file, PNG or EXR.

PNG holds display values: a view of linear radiance is clipped to [0, 1] and sRGB encoded, any
other is written as shown. EXR holds linear light in float32: linear views to the bit (scene_color:
scene-referred radiance, no exposure, no post), and views in display values decoded from sRGB, so
that an EXR viewer shows what the PNG shows.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from elemental.core.errors import InputError
from elemental.core.images import check_png, read_exr, write_exr, write_png
from elemental.core.srgb import decode_srgb, encode_srgb

SUFFIXES = (".png", ".exr")


def save_picture(path: Path, pixels: npt.NDArray[Any], is_linear: bool) -> None:
    """Write ``pixels`` (H, W, 3 or 4), uint8 or float32, row 0 on top; opacity is left out.

    Raises InputError where the file can't be written; then no file is left.
    """
    rgb = pixels[:, :, :3]
    if path.suffix.lower() == ".exr":
        values = rgb if is_linear else decode_srgb(_unit(rgb))
        write_exr(path, np.ascontiguousarray(values, np.float32))
    else:
        write_png(path, _bytes(encode_srgb(_unit(rgb))) if is_linear else _bytes(_unit(rgb)))


def is_picture(path: Path, size: tuple[int, int]) -> bool:
    """Whether a file is a whole PNG or EXR of ``size`` = (width, height) pixels."""
    try:
        if path.suffix.lower() == ".exr":
            height, width = read_exr(path).shape[:2]
            return (width, height) == size
        return check_png(path) == size
    except InputError:
        return False


def _unit(rgb: npt.NDArray[Any]) -> npt.NDArray[np.float32]:
    """Values in [0, 1] as float32; a texel that is not a number is black."""
    scale = np.float32(1 / 255 if rgb.dtype == np.uint8 else 1)
    unit: npt.NDArray[np.float32] = np.nan_to_num(rgb.astype(np.float32) * scale, posinf=1.0)
    return np.clip(unit, 0.0, 1.0)


def _bytes(unit: npt.NDArray[np.float32]) -> npt.NDArray[np.uint8]:
    return np.ascontiguousarray((unit * 255.0 + 0.5).astype(np.uint8))
