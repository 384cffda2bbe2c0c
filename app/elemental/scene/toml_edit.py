"""Changing single values of a TOML file so that its comments, order and layout stay.

tomlkit does the work; what it makes of rare layouts is not always what was meant, so callers read
the text that comes out before they trust it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

import tomlkit
from tomlkit.exceptions import TOMLKitError
from tomlkit.items import AoT, InlineTable, Table

from elemental.core.errors import InputError
from elemental.core.files import atomic_file, not_utf8, read_file


class CannotEditError(Exception):
    """An edit that this layout does not bear."""


def rewrite(path: Path, change: Callable[[str], str]) -> None:
    """Replace a text file by what ``change`` makes of it, whole or not at all; a link is followed.

    Raises InputError where it can't be read or written, and what ``change`` raises.
    """
    target = path.resolve()
    raw = read_file(target, path)
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise InputError(path, "", not_utf8(error)) from error
    changed = change(text).encode("utf-8")
    if changed == raw:
        return
    try:
        with atomic_file(target) as temporary:
            temporary.write_bytes(changed)
    except OSError as error:
        raise InputError(path, "", f"can't be written ({error.strerror})") from error


def edited(text: str, edit: Callable[[Any], None]) -> str | None:
    """``text`` after ``edit`` of its document, or None where that can't be done."""
    try:
        document = tomlkit.parse(text)
        edit(document)
        return tomlkit.dumps(document)
    except (CannotEditError, TOMLKitError, ValueError, KeyError, TypeError, AttributeError):
        return None


def edited_as(
    text: str, edits: Iterable[Callable[[Any], None]], reads: Callable[[str], bool]
) -> str | None:
    """``text`` after the first of ``edits`` that makes what ``reads`` as was meant; None: none."""
    for edit in edits:
        made = edited(text, edit)
        if made is not None and reads(made):
            return made
    return None


def assign(table: Any, key: str, value: Any) -> None:
    """``key = value``; a comment behind the old value stays."""
    value = plain(value)
    if key in table:
        table[key] = value
    else:
        _append(table, tomlkit.key(key), value)


def assign_setting(table: Any, section: str, key: str, value: Any) -> None:
    """A dotted setting in ``section`` of a table, wherever the file has it; else appended there."""
    if section not in table:
        if isinstance(table, InlineTable):
            table[section] = tomlkit.inline_table()
        else:
            table[section] = tomlkit.table()
    holder, name = next(_places(table[section], key), (None, ""))
    if holder is not None:
        holder[name] = plain(value)
    elif isinstance(table[section], InlineTable):
        table[section][key] = plain(value)  # quoted: tomlkit breaks dotted keys in inline tables
    else:
        _append(table[section], tomlkit.key(key.split(".")), plain(value))


def drop_setting(table: Any, section: str, key: str) -> None:
    """Remove a dotted setting from ``section`` of a table."""
    for holder, name in list(_places(table[section], key)):
        del holder[name]


def append_table(document: Any, name: str, content: Mapping[str, Any]) -> None:
    """One more ``[[name]]`` at the end of its like; ``settings`` becomes a table of its own."""
    table = tomlkit.table()
    for key, value in content.items():
        if key != "settings":
            table[key] = plain(value)
    for key, value in content.get("settings", {}).items():
        assign_setting(table, "settings", key, value)
    if name not in document:
        if len(document):
            document.add(tomlkit.nl())
        document[name] = tomlkit.aot()
    tables = document[name]
    if not isinstance(tables, AoT):
        raise CannotEditError(f"{name} is an inline array")
    if len(tables):
        tables[-1].add(tomlkit.nl())
    tables.append(table)


def replace_tables(document: Any, name: str, contents: Iterable[Mapping[str, Any]]) -> None:
    """All ``[[name]]`` anew, at the file's end; none: none."""
    if name in document:
        del document[name]
    for content in contents:
        append_table(document, name, content)


def plain(value: Any) -> Any:
    """A value as TOML has it: a tuple is a list, a whole float keeps its point."""
    return [plain(item) for item in value] if isinstance(value, tuple) else value


def _places(section: Any, key: str) -> Iterator[tuple[Any, str]]:
    """Each (table, name) under which a dotted key stands: ``a.b``, ``"a.b"`` or both in part."""
    if key in section and not isinstance(section[key], Mapping):
        yield section, key
    parts = key.split(".")
    for i in range(1, len(parts)):
        head = ".".join(parts[:i])
        if head in section and isinstance(section[head], Mapping):
            yield from _places(section[head], ".".join(parts[i:]))


def _append(table: Any, key: Any, value: Any) -> None:
    """Add a key before the blank lines and comments at the table's end: they lead to the next."""
    if not isinstance(table, Table):
        table[key] = value
        return
    body = table.value.body
    tail = []
    while body and body[-1][0] is None:
        tail.append(body.pop())
    table.append(key, value)
    body.extend(reversed(tail))
