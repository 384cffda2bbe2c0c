"""Between the server's thread and the frame: what was asked for, and what there is to ask about."""

from __future__ import annotations

import threading
from collections.abc import Sequence
from typing import Any

from elemental.remote.changes import Change, applied, checked
from elemental.scene.volumes import Volume
from elemental.settings import Settings


class Mailbox:
    """Checked changes on their way to the frame.

    Bounded by itself: a later change of one property replaces the earlier, so there are never more
    than volumes times properties, and the newest value of each always arrives.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._volumes: tuple[Volume, ...] = ()
        self._settings = Settings()
        self._pending: dict[tuple[str, str], Change] = {}

    def put(self, name: str, property: str, value: Any) -> Change:
        """Check a change and leave it for the next frame. Raises RefusedError."""
        with self._lock:
            change = checked(self._volumes, self._settings, name, property, value)
            self._pending[name, property] = change
        return change

    def volumes(self) -> list[Volume]:
        """The volumes as they will be once what waits here is taken."""
        with self._lock:
            return applied(self._volumes, self._pending.values())

    def exchange(self, volumes: Sequence[Volume], settings: Settings) -> Sequence[Volume]:
        """Called once a frame: its volumes and settings in, the changed volumes out.

        Without a change the same object comes back.
        """
        with self._lock:
            changes, self._pending = self._pending, {}
            if changes:
                volumes = applied(volumes, changes.values())
            self._volumes, self._settings = tuple(volumes), settings
        return volumes
