"""A remote control over a scene without a window, and clients of it."""

from __future__ import annotations

import json
import socket
from http.client import HTTPConnection
from pathlib import Path
from typing import Any

from elemental.remote.server import LOOPBACK, Remote
from elemental.scene.model import Scene
from elemental.scene.volumes import Volume
from elemental.settings import Settings

TIMEOUT_S = 20.0


class Rig:
    """Two volumes, a server on free ports, and frames when the test says so."""

    def __init__(self, osc: bool = False) -> None:
        self.scene = Scene("test", Path("test"))
        self.reset()
        self.settings = Settings()
        self.remote = Remote(LOOPBACK, 0, 0 if osc else None)
        self.frame()

    def reset(self) -> None:
        """The volumes as they were."""
        self.scene.volumes = [
            Volume("cellar", overrides={"exposure": 1.0}),
            Volume("the lamp/ü", "sphere", priority=1.0),
        ]

    def frame(self) -> list[Volume]:
        """One frame; the volumes that it is drawn with."""
        self.remote.update(self.scene, self.settings)
        return self.scene.volumes

    @property
    def address(self) -> tuple[str, int]:
        host, _, port = (
            self.remote.http_url.removeprefix("http://").partition("/")[0].partition(":")
        )
        return host, int(port)

    def connection(self) -> HTTPConnection:
        return HTTPConnection(*self.address, timeout=TIMEOUT_S)

    def ask(
        self, method: str, path: str, body: bytes | str | None = None, token: str | None = None
    ) -> tuple[int, Any]:
        """(status, JSON) of one request with the right token, or with another."""
        connection = self.connection()
        given = self.remote.token if token is None else token
        connection.request(method, path, body, {"Authorization": f"Bearer {given}"})
        response = connection.getresponse()
        answer = response.status, json.loads(response.read())
        connection.close()
        return answer

    def put(self, path: str, value: Any) -> tuple[int, Any]:
        return self.ask("PUT", path, json.dumps(value))

    def send(self, raw: bytes) -> bytes:
        """All that comes back for raw bytes."""
        with socket.create_connection(self.address, TIMEOUT_S) as connection:
            try:
                connection.sendall(raw)
                connection.shutdown(socket.SHUT_WR)
                return b"".join(iter(lambda: connection.recv(65536), b""))
            except ConnectionError:
                return b""
