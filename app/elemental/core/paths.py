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


def named_file(name: str, folder: Path) -> Path:
    """The file that a setting of a scene in `folder` names: there, else one of content/textures/.

    One that is in neither is told as of `folder`; an absolute name is itself.
    """
    beside, shipped = folder / name, content_root() / "textures" / name
    return shipped if not is_file(beside) and is_file(shipped) else beside


def is_file(path: Path) -> bool:
    """Whether there is a file; a path that none can have is of none."""
    try:
        return path.is_file()
    except OSError:  # too long, or not to be looked into
        return False


@cache
def content_root() -> Path:
    """Folder of scenes, materials and textures that come with the program."""
    return _root("content")
