"""The thread that listens: bounded in connections, sizes, times and rates."""

from __future__ import annotations

import asyncio
import contextlib
import secrets
import socket
import threading
from collections import Counter
from collections.abc import Coroutine, Iterator
from functools import partial
from typing import Any

from elemental.core.errors import InputError
from elemental.remote import osc
from elemental.remote.http import MAX_HEAD, Access, Connection, Peer
from elemental.remote.mailbox import Mailbox
from elemental.remote.rate_limit import HostLimits, RateLimit
from elemental.scene.model import Scene
from elemental.settings import Settings

LOOPBACK = "127.0.0.1"
MAX_CONNECTIONS = 16
"""Served at once. One more takes the place of a client that has not shown the token yet; where all
have, it waits, and those after it in the system's queue."""
BACKLOG = 128
"""Connections in the system's queue."""
ARRIVALS_PER_S = 1000.0
"""Connections accepted: bounds what those without the token cost the frame."""
MAX_CLIENTS = 32
"""Hosts with the token whose limit is kept; each has its own."""
REQUESTS_PER_S = 200.0
"""HTTP requests of a host with the token: three faders at 60 Hz. Faster clients wait."""
BURST = 50.0
"""Requests that may come at once."""
REFUSALS_PER_S = 20.0
"""Answers to clients without the token, all together: a hand that errs gets one."""
DATAGRAMS_PER_S = 1000.0
"""Of a host with the token: sixteen faders at 60 Hz. Faster ones get lost."""
DATAGRAM_BURST = 250.0
DRAINS_PER_S = 200.0
"""Looks at arrived datagrams a second."""
DRAINED = 256
"""Datagrams taken at a look, about what the system's queue holds; those without the token cost a
search for it each."""
STOP_S = 2.0
"""How long the end of the program waits for the thread."""
ACCEPT_RETRY_S = 0.2
"""Pause after an accept that failed, as where the process has no file handles left."""


class Remote:
    """Remote control of a scene's volumes while it runs."""

    def __init__(self, host: str, http_port: int | None, osc_port: int | None) -> None:
        """Listen on the given ports (0: any free one). Raises InputError."""
        self.token = secrets.token_urlsafe(16)
        self.mailbox = Mailbox()
        self.faults = 0
        """Requests that broke the server's own code; none are known."""
        self._sockets: list[socket.socket] = []
        self._http = self._osc = None
        try:
            if http_port is not None:
                self._http = self._listen("--remote", socket.SOCK_STREAM, host, http_port)
            if osc_port is not None:
                osc.require_osc()
                self._osc = self._listen("--osc", socket.SOCK_DGRAM, host, osc_port)
        except InputError:
            self._close()
            raise
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._run, name="remote", daemon=True)
        self._thread.start()

    @property
    def http_url(self) -> str:
        """Where volumes are listed; empty without HTTP."""
        return "" if self._http is None else f"http://{_place(self._http)}/volumes"

    @property
    def announcement(self) -> list[str]:
        """What the user needs to know, a line each."""
        lines = []
        if self._http is not None:
            lines.append(f"remote: {self.http_url}, Authorization: Bearer {self.token}")
        if self._osc is not None:
            place = _place(self._osc)
            lines.append(f"remote: OSC on {place}, /{self.token}/volumes/NAME/PROPERTY")
        return lines

    def update(self, scene: Scene, settings: Settings) -> None:
        """Once a frame: take what arrived over to the scene's volumes."""
        volumes = self.mailbox.exchange(scene.volumes, settings)
        if volumes is not scene.volumes:
            scene.volumes = list(volumes)

    def release(self) -> None:
        """Stop listening and end the thread."""
        if self._thread.is_alive():
            self._loop.call_soon_threadsafe(self._stop)
            self._thread.join(STOP_S)
        self._close()

    def _listen(self, flag: str, kind: int, host: str, port: int) -> socket.socket:
        try:
            family, _, _, _, address = socket.getaddrinfo(
                host, port, type=kind, flags=socket.AI_NUMERICHOST
            )[0]
        except OSError:
            raise InputError("--remote-host", host, "is not an IP address") from None
        listener = socket.socket(family, kind)
        self._sockets.append(listener)
        listener.setblocking(False)
        try:
            if kind == socket.SOCK_STREAM:
                listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            listener.bind(address)
            if kind == socket.SOCK_STREAM:
                listener.listen(BACKLOG)
        except OSError as error:
            reason = f"can't be listened on ({error.strerror})"
            raise InputError(flag, f"{host} port {port}", reason) from error
        return listener

    def _close(self) -> None:
        for listener in self._sockets:
            listener.close()
        self._sockets.clear()

    # In the thread -----------------------------------------------------------------------------

    def _run(self) -> None:
        asyncio.set_event_loop(self._loop)
        self._stopped = asyncio.Event()
        with contextlib.closing(self._loop):
            self._loop.run_until_complete(self._serve())

    def _stop(self) -> None:
        self._stopped.set()

    async def _serve(self) -> None:
        self._tasks: set[asyncio.Task[None]] = set()
        self._peers: dict[asyncio.Task[None], Peer] = {}
        self._left = asyncio.Event()
        known = HostLimits(REQUESTS_PER_S, BURST, MAX_CLIENTS)
        unknown = RateLimit(REFUSALS_PER_S, REFUSALS_PER_S)
        self._access = Access(self.mailbox, self.token, known, unknown)
        if self._http is not None:
            self._start(self._accept(self._http))
        if self._osc is not None:
            self._start(self._receive(self._osc))
        await self._stopped.wait()
        for task in list(self._tasks):
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)

    def _start(self, work: Coroutine[Any, Any, None]) -> asyncio.Task[None]:
        task = self._loop.create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._ended)
        return task

    def _ended(self, task: asyncio.Task[None]) -> None:
        self._tasks.discard(task)
        if not task.cancelled() and task.exception() is not None:
            self.faults += 1

    async def _accept(self, listener: socket.socket) -> None:
        arrivals = RateLimit(ARRIVALS_PER_S, BURST)
        while True:
            await arrivals.wait()
            try:
                client, address = await self._loop.sock_accept(listener)
            except OSError:
                await asyncio.sleep(ACCEPT_RETRY_S)
                continue
            try:
                await self._make_room()
            except asyncio.CancelledError:
                client.close()
                raise
            peer = Peer(address[0])
            task = self._start(self._converse(client, peer))
            self._peers[task] = peer
            task.add_done_callback(self._gone)
            task.add_done_callback(partial(_close, client))

    async def _make_room(self) -> None:
        """Wait until one more may be served, for whom a stranger is cut."""
        while len(self._peers) >= MAX_CONNECTIONS:
            stranger = self._stranger()
            self._left.clear()
            if stranger is not None:
                stranger.cancel()
            await self._left.wait()

    def _stranger(self) -> asyncio.Task[None] | None:
        """Who makes room: the oldest without the token, of the host that has most of them."""
        unknown = {task: peer.host for task, peer in self._peers.items() if not peer.is_known}
        crowds = Counter(unknown.values())
        return max(unknown, key=lambda task: crowds[unknown[task]], default=None)

    def _gone(self, task: asyncio.Task[None]) -> None:
        self._peers.pop(task, None)
        self._left.set()

    async def _converse(self, client: socket.socket, peer: Peer) -> None:
        reader = asyncio.StreamReader(limit=MAX_HEAD, loop=self._loop)
        protocol = asyncio.StreamReaderProtocol(reader, loop=self._loop)
        try:
            transport, _ = await self._loop.connect_accepted_socket(lambda: protocol, client)
        except OSError:
            return
        writer = asyncio.StreamWriter(transport, protocol, reader, self._loop)
        await Connection(reader, writer, self._access, peer).serve()

    async def _receive(self, listener: socket.socket) -> None:
        looks = RateLimit(DRAINS_PER_S, 1.0)
        known = HostLimits(DATAGRAMS_PER_S, DATAGRAM_BURST, MAX_CLIENTS)
        token = self.token.encode()
        while True:
            await looks.wait()
            try:
                first = await self._loop.sock_recvfrom(listener, osc.MAX_DATAGRAM + 1)
            except OSError:  # such as a port that is closed on the other side
                await asyncio.sleep(ACCEPT_RETRY_S)
                continue
            for datagram, host in _arrived(listener, *first):
                if token in datagram and known.of(host).take():
                    osc.receive(datagram, self.mailbox, self.token)


def _close(client: socket.socket, _: asyncio.Task[None]) -> None:
    """The end of a conversation; one that was cut before its first step, too."""
    client.close()


def _arrived(listener: socket.socket, datagram: bytes, address: Any) -> Iterator[tuple[bytes, str]]:
    """Datagrams and their hosts: the given one and those that wait behind it."""
    for _ in range(DRAINED):
        yield datagram, address[0]
        try:
            datagram, address = listener.recvfrom(osc.MAX_DATAGRAM + 1)
        except OSError:  # none is left, or a port is closed on the other side
            return


def _place(listener: socket.socket) -> str:
    """host:port as a URL has it."""
    host, port = listener.getsockname()[:2]
    return f"[{host}]:{port}" if ":" in host else f"{host}:{port}"
