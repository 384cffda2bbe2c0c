"""Whether a JSON value has the shape of a TypedDict: all its keys, no other, each of its type."""

from __future__ import annotations

import typing
from collections.abc import Iterator
from typing import Any


def mismatches(value: Any, kind: Any) -> list[str]:
    """Where ``value`` is not of ``kind``; empty if it is."""
    return list(_walk(value, kind, "$"))


def _walk(value: Any, kind: Any, place: str) -> Iterator[str]:
    arguments = typing.get_args(kind)
    container = typing.get_origin(kind) or (dict if typing.is_typeddict(kind) else None)
    if container is not None and not isinstance(value, container):
        yield f"{place}: {value!r} is no {container.__name__}"
    elif typing.is_typeddict(kind):
        hints = typing.get_type_hints(kind)
        yield from (f"{place}.{key}: is missing" for key in hints.keys() - value.keys())
        yield from (f"{place}.{key}: is not in the schema" for key in value.keys() - hints.keys())
        for key in hints.keys() & value.keys():
            yield from _walk(value[key], hints[key], f"{place}.{key}")
    elif container is list:
        for index, item in enumerate(value):
            yield from _walk(item, arguments[0], f"{place}[{index}]")
    elif container is dict:
        for key, item in value.items():
            yield from _walk(item, arguments[1], f"{place}.{key}")
    elif kind not in (Any, object):
        fits = isinstance(value, (int, float) if kind is float else kind)
        if not fits or (isinstance(value, bool) and kind is not bool):
            yield f"{place}: {value!r} is no {kind.__name__}"
