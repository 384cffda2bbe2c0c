"""Open Sound Control: ``/TOKEN/volumes/NAME/PROPERTY value``, one datagram a message or bundle.

OSC knows no answers and no secrets: the token is the address's first part, and what can't be done
is dropped.
"""

from __future__ import annotations

import contextlib
import hmac
from collections.abc import Iterator
from typing import Any
from urllib.parse import unquote

from elemental.core.errors import InputError
from elemental.remote.changes import FIELDS, RefusedError
from elemental.remote.mailbox import Mailbox

MAX_DATAGRAM = 4096
"""Bytes; a bundle of fifty faders."""


def require_osc() -> None:
    """Raises InputError where python-osc is not installed."""
    try:
        import pythonosc  # noqa: F401, PLC0415 (an extra)
    except ImportError:
        reason = "needs python-osc: pip install 'elemental[osc]'"
        raise InputError("--osc", "", reason) from None


def receive(datagram: bytes, mailbox: Mailbox, token: str) -> int:
    """Leave what a datagram asks for in the mailbox; how many changes that were."""
    taken = 0
    for address, values in messages(datagram):
        parts = [unquote(part) for part in address.split("/")]
        if len(parts) != 5 or parts[0] != "" or parts[2] != "volumes":
            continue
        given, name, property = parts[1], parts[3], parts[4]
        if not hmac.compare_digest(given.encode(), token.encode()):
            continue
        with contextlib.suppress(RefusedError):
            mailbox.put(name, property, _value(property, values))
            taken += 1
    return taken


def messages(datagram: bytes) -> Iterator[tuple[str, list[Any]]]:
    """(address, arguments) of each message; nothing for what is broken or too long."""
    from pythonosc.osc_packet import OscPacket  # noqa: PLC0415 (an extra)

    if len(datagram) > MAX_DATAGRAM:
        return
    try:
        packet = OscPacket(datagram)
    except Exception:  # bytes from anyone: the parser raises whatever it meets
        return
    for timed in packet.messages:
        yield timed.message.address, list(timed.message)


def _value(property: str, values: list[Any]) -> Any:
    """One argument is a value, three are a colour; a button's 0 or 1 is a switch."""
    if len(values) != 1:
        return tuple(values)
    value = values[0]
    is_switch = property in FIELDS and FIELDS[property][1].kind == "bool"
    if is_switch and not isinstance(value, bool) and value in (0, 1):
        return bool(value)
    return value
