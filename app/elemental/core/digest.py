"""A fingerprint of plain values: dataclasses, arrays, containers, numbers, texts, paths."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping, Sequence, Set
from dataclasses import fields, is_dataclass
from pathlib import PurePath
from typing import Any

import numpy as np


def digest(value: Any) -> str:
    """32 hex digits that differ where anything inside ``value`` does. Raises TypeError."""
    made = hashlib.blake2b(digest_size=16)
    for part in _parts(value):
        made.update(part)
    return made.hexdigest()


def _parts(value: Any) -> Iterator[bytes | memoryview]:
    """Each value after its kind and length, so that no two nestings give the same bytes."""
    if isinstance(value, np.ndarray | np.generic):
        array = np.ascontiguousarray(value)
        yield f"a{array.dtype.str}{array.shape};".encode()
        yield array.tobytes()
    elif is_dataclass(value) and not isinstance(value, type):
        yield f"d{type(value).__name__};".encode()
        for field in fields(value):
            yield from _parts(getattr(value, field.name))
    elif isinstance(value, Mapping):
        yield f"m{len(value)};".encode()
        for key in sorted(value, key=repr):
            yield from _parts(key)
            yield from _parts(value[key])
    elif isinstance(value, Sequence) and not isinstance(value, str | bytes):
        yield f"s{len(value)};".encode()
        for item in value:
            yield from _parts(item)
    elif isinstance(value, Set):
        yield from _parts(sorted(digest(item) for item in value))
    elif isinstance(value, PurePath):
        yield from _parts(str(value))
    elif value is None or isinstance(value, bool | int | float | str | bytes):
        text = value if isinstance(value, bytes) else repr(value).encode()
        yield f"{type(value).__name__}{len(text)};".encode()
        yield text
    else:
        raise TypeError(f"no digest of {type(value).__name__}")
