"""One HTTP connection of a remote client: requests read within bounds, answered in JSON."""

from __future__ import annotations

import asyncio
import hmac
import json
import re
from dataclasses import dataclass
from http import HTTPStatus
from typing import Any, NoReturn
from urllib.parse import unquote

from elemental.remote.changes import RefusedError, description
from elemental.remote.mailbox import Mailbox
from elemental.remote.rate_limit import HostLimits, RateLimit

MAX_HEAD = 8192
"""Bytes of a request line with its headers."""
MAX_BODY = 4096
"""Bytes of a request's body: a colour takes sixty."""
REQUEST_S = 5.0
"""Seconds within which a request must arrive whole, and its answer be taken."""

_LINE = re.compile(r"([A-Z]{1,16}) (/[\x21-\x7e]*) HTTP/1\.([01])")
_HEADER = re.compile(r"([!#$%&'*+.^_`|~0-9A-Za-z-]+):([^\x00-\x08\x0a-\x1f\x7f]*)")
"""One way to match: the blanks around a value are stripped afterwards."""


@dataclass(frozen=True)
class Request:
    """One request; header names in lower case."""

    method: str
    minor: int
    """Of the version, HTTP/1.x."""
    path: str
    headers: dict[str, str]
    body: bytes


@dataclass(eq=False)
class Peer:
    """Who is at the other end of a connection."""

    host: str
    is_known: bool = False
    """Whether it has shown the token."""


@dataclass(frozen=True)
class Access:
    """What all connections share. Those who know the token never wait for those who don't."""

    mailbox: Mailbox
    token: str
    known: HostLimits
    """Of those who know the token, by host: faster ones wait."""
    unknown: RateLimit
    """Answers to all others together; without a permit they are cut without one."""


class Connection:
    """Serves requests of one client until it goes, errs, is too slow or lacks the token."""

    def __init__(
        self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter, access: Access, peer: Peer
    ) -> None:
        self._reader, self._writer = reader, writer
        self._access, self._peer = access, peer

    async def serve(self) -> None:
        """Answer one request after the other; ends by itself."""
        try:
            while await self._serve_one():
                pass
        except (OSError, EOFError, TimeoutError):  # the client went or is too slow
            pass
        finally:
            self._writer.transport.abort()

    async def _serve_one(self) -> bool:
        """Answer a request; whether another may follow."""
        goes_on = False
        try:
            async with asyncio.timeout(REQUEST_S):
                request = await self._read()
            self._check_token(request)
            goes_on = request.minor > 0 and request.headers.get("connection", "") != "close"
            await self._access.known.of(self._peer.host).wait()
            status, answer = HTTPStatus.OK, self._answer(request)
        except RefusedError as error:
            if not (self._peer.is_known or self._access.unknown.take()):
                return False
            status, answer = HTTPStatus(error.status), {"error": str(error)}
        async with asyncio.timeout(REQUEST_S):
            await self._write(status, answer, goes_on)
        return goes_on

    async def _read(self) -> Request:
        try:
            head = await self._reader.readuntil(b"\r\n\r\n")
        except asyncio.LimitOverrunError:
            raise RefusedError(431, f"more than {MAX_HEAD} bytes of headers") from None
        line, *lines = head.decode("latin-1").split("\r\n")[:-2]
        match = _LINE.fullmatch(line)
        if match is None:
            raise RefusedError(400, "not a request of HTTP/1.1")
        headers: dict[str, str] = {}
        for text in lines:
            header = _HEADER.fullmatch(text)
            if header is None or header[1].lower() in headers:
                raise RefusedError(400, "a broken or doubled header")
            headers[header[1].lower()] = header[2].strip(" \t")
        if "transfer-encoding" in headers:
            raise RefusedError(411, "give a Content-Length")
        length = headers.get("content-length", "0")
        if not re.fullmatch(r"[0-9]{1,9}", length):
            raise RefusedError(400, "Content-Length is not a number")
        if int(length) > MAX_BODY:
            raise RefusedError(413, f"more than {MAX_BODY} bytes")
        if headers.get("expect", "").lower() == "100-continue":
            self._writer.write(b"HTTP/1.1 100 Continue\r\n\r\n")
        body = await self._reader.readexactly(int(length))
        return Request(match[1], int(match[3]), match[2], headers, body)

    def _check_token(self, request: Request) -> None:
        given = request.headers.get("authorization", "").encode("latin-1")
        self._peer.is_known = hmac.compare_digest(given, f"Bearer {self._access.token}".encode())
        if not self._peer.is_known:
            raise RefusedError(401, "the token is missing or wrong")

    def _answer(self, request: Request) -> dict[str, Any]:
        """What the request asks for, done. Raises RefusedError."""
        path = request.path.partition("?")[0]
        root, *parts = [unquote(part) for part in path.removeprefix("/").split("/")]
        if root != "volumes" or len(parts) > 2:
            raise RefusedError(404, "known are /volumes, /volumes/NAME, /volumes/NAME/PROPERTY")
        if request.method != ("PUT" if len(parts) == 2 else "GET"):
            raise RefusedError(405, "GET /volumes, GET /volumes/NAME, PUT /volumes/NAME/PROPERTY")
        if len(parts) == 2:
            change = self._access.mailbox.put(parts[0], parts[1], parse_value(request.body))
            return {"volume": change.volume, "property": change.property, "value": change.value}
        volumes = [description(volume) for volume in self._access.mailbox.volumes()]
        if not parts:
            return {"volumes": volumes}
        for volume in volumes:
            if volume["name"] == parts[0]:
                return volume
        raise RefusedError(404, f"no volume is named {parts[0]!r}")

    async def _write(self, status: HTTPStatus, answer: dict[str, Any], goes_on: bool) -> None:
        body = json.dumps(answer, allow_nan=False).encode() + b"\n"
        head = (
            f"HTTP/1.1 {status.value} {status.phrase}\r\n"
            "Content-Type: application/json\r\n"
            f"Content-Length: {len(body)}\r\n"
            "Cache-Control: no-store\r\n"
            f"Connection: {'keep-alive' if goes_on else 'close'}\r\n\r\n"
        )
        self._writer.write(head.encode() + body)
        await self._writer.drain()
        if not goes_on:
            self._writer.write_eof()
            await self._reader.read(MAX_BODY)  # else what is unread resets the answer


def parse_value(body: bytes) -> Any:
    """The JSON value of a body. Raises RefusedError."""
    try:
        return json.loads(body.decode("utf-8"), parse_constant=_refuse_constant)
    except (ValueError, RecursionError):
        raise RefusedError(400, "the body is not a JSON value") from None


def _refuse_constant(word: str) -> NoReturn:
    raise ValueError(f"{word} is not JSON")
