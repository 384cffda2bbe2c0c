"""Notices edits of shader files without asking the file system each frame."""

from __future__ import annotations

import threading
from collections.abc import Collection
from pathlib import Path

from watchfiles import watch


class ShaderWatcher:
    """A thread that waits for changes below some folders."""

    def __init__(self, roots: Collection[Path]) -> None:
        self._changed = threading.Event()
        self._stop = threading.Event()
        self._thread = threading.Thread(
            target=self._wait, args=(tuple(roots),), name="shader watcher", daemon=True
        )
        self._thread.start()

    def _wait(self, roots: tuple[Path, ...]) -> None:
        for _ in watch(*roots, stop_event=self._stop, debounce=50, step=10):
            self._changed.set()

    def take(self) -> bool:
        """Whether something changed since the last call."""
        if not self._changed.is_set():
            return False
        self._changed.clear()
        return True

    def release(self) -> None:
        """End the thread."""
        self._stop.set()
        self._thread.join(timeout=5)
