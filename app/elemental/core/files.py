"""Reading whole files and writing them atomically, with errors that the user can act on."""

from __future__ import annotations

import errno
import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from elemental.core.errors import InputError


def read_file(path: Path, file: str | Path | None = None, field: str = "") -> bytes:
    """A regular file's bytes.

    Raises InputError(`file`, `field`, reason) for anything else; `file` is `path` by default.
    """
    blamed = path if file is None else file
    check_file(path, blamed, field)
    try:
        return path.read_bytes()
    except OSError as error:
        raise InputError(blamed, field, f"can't be read ({error.strerror})") from error


def check_file(path: Path, file: str | Path | None = None, field: str = "") -> None:
    """Raises InputError as ``read_file`` does for what is no regular file."""
    blamed = path if file is None else file
    try:
        if path.is_dir():
            raise InputError(blamed, field, "is a folder")
        if not path.is_file():
            raise InputError(blamed, field, "is not a file" if path.exists() else "does not exist")
    except OSError as error:
        raise InputError(blamed, field, f"can't be read ({error.strerror})") from error
    except ValueError:  # a null character
        raise InputError(blamed, field, "can't be a file name") from None


def read_text(path: Path) -> str:
    """A text file in UTF-8, with or without a byte order mark. Raises InputError."""
    try:
        return read_file(path).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise InputError(path, "", not_utf8(error)) from error


def not_utf8(error: UnicodeDecodeError) -> str:
    """The reason in our own words."""
    return f"is not UTF-8 text (byte {error.start + 1})"


def check_writable(path: Path) -> None:
    """Raises PermissionError for a file that its owner marked read-only; others may be replaced."""
    if path.exists() and not os.access(path, os.W_OK):
        raise PermissionError(errno.EACCES, "it is read-only")


@contextmanager
def atomic_file(path: Path) -> Iterator[Path]:
    """A temporary path in `path`'s folder that replaces `path` when the block ends well.

    Raises InputError where the folder is missing or can't be written, or the disk is full.
    """
    temporary: Path | None = None
    try:
        check_writable(path)
        handle, name = tempfile.mkstemp(path.suffix, ".elemental-", path.parent)
        os.close(handle)
        temporary = Path(name)
        yield temporary
        temporary.chmod(0o666 & ~_umask())
        os.replace(temporary, path)
    except OSError as error:
        reason = error.strerror or str(error)
        raise InputError(path, "", f"can't be written ({reason})") from error
    finally:
        if temporary is not None:
            temporary.unlink(missing_ok=True)


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
