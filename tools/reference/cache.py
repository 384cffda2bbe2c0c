"""References by the hash of everything that they depend on: path tracing is the slow part."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from dataclasses import fields, is_dataclass
from pathlib import Path

import numpy as np

from elemental.core.images import read_environment, write_exr
from elemental.scene.model import FloatArray

CODE = tuple(
    Path(__file__).with_name(f"{name}.py") for name in ("bsdf", "emission", "mitsuba_scene", "ply")
)
"""What converts the scene: an edit there makes every reference anew."""


def fingerprint(*parts: object) -> str:
    """A short hash of dataclasses, arrays, and plain values, and of the converter's own text."""
    digest = hashlib.sha256()
    for path in CODE:
        digest.update(path.read_bytes())
    for part in parts:
        _feed(digest, part)
    return digest.hexdigest()[:16]


def _feed(digest: hashlib._Hash, part: object) -> None:
    if isinstance(part, np.ndarray):
        digest.update(f"{part.dtype}{part.shape}".encode())
        digest.update(np.ascontiguousarray(part).tobytes())
    elif is_dataclass(part):
        for f in fields(part):
            _feed(digest, getattr(part, f.name))
    elif isinstance(part, list | tuple):
        digest.update(f"[{len(part)}".encode())
        for inner in part:
            _feed(digest, inner)
    else:
        digest.update(f"{part!r};".encode())


def cached(folder: Path, key: str, make: Callable[[], FloatArray]) -> FloatArray:
    """The picture (H, W, 3) of `folder/key.exr`, made if it is missing."""
    path = folder / f"{key}.exr"
    if not path.is_file():
        folder.mkdir(parents=True, exist_ok=True)
        write_exr(path, make())
    return read_environment(path)
