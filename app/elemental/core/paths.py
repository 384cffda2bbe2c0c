"""Where the shaders and the content live: beside ``app/`` in a checkout, inside the wheel else."""

from __future__ import annotations

from functools import cache
from pathlib import Path

_PACKAGE = Path(__file__).resolve().parent.parent


def _root(folder: str) -> Path:
    installed = _PACKAGE / folder
    checkout = _PACKAGE.parent.parent / folder
    for candidate in (installed, checkout):
        if candidate.is_dir():
            return candidate
    raise FileNotFoundError(f"neither {installed} nor {checkout} exists")


@cache
def glsl_root() -> Path:
    """Folder that every ``#include`` and every shader name is relative to.

    Raises FileNotFoundError where neither a checkout nor a wheel holds it.
    """
    return _root("glsl")


def texture_file(name: str) -> Path:
    """The file that a setting names: one of content/textures/, else a path."""
    shipped = content_root() / "textures" / name
    return shipped if shipped.is_file() else Path(name)


@cache
def content_root() -> Path:
    """Folder of scenes, materials and textures that come with the program."""
    return _root("content")
