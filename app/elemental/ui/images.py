"""Image files that an artist chooses: read by a thread, so that no frame waits for them."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import NamedTuple

from elemental.core.errors import InputError
from elemental.scene.materials import Texture
from elemental.scene.scene_materials import read_texture

Place = tuple[int, str]
"""A material's number, and the name of its parameter."""
Taker = Callable[[Texture], None]


class _Task(NamedTuple):
    texture: Future[Texture]
    take: Taker


class ImageReader:
    """Reads one file after another; the newest for a place is the one that counts.

    `problems` tells by place why what was asked for last is not there.
    """

    def __init__(self, largest_px: int) -> None:
        self.largest_px = largest_px
        """Longest side that the device takes."""
        self.problems: dict[Place, InputError] = {}
        self._tasks: dict[Place, _Task] = {}
        self._thread: ThreadPoolExecutor | None = None

    def ask(self, place: Place, path: Path, take: Taker) -> None:
        """Have a file read and given to ``take`` by one of the next `deliver`."""
        if self._thread is None:
            self._thread = ThreadPoolExecutor(1, "images")
        self.forget(place)
        self._tasks[place] = _Task(self._thread.submit(self._read, path), take)

    def _read(self, path: Path) -> Texture:
        try:
            texture = read_texture(path)
        except InputError:
            raise
        except MemoryError as error:
            raise InputError(path, "", "is larger than this machine's memory") from error
        except Exception as error:  # no frame may end for a file that an artist chose
            raise InputError(path, "", f"can't be read ({error})") from error
        height, width = texture.pixels.shape[:2]
        if max(width, height) > self.largest_px:
            reason = f"is {width}x{height}; this driver takes {self.largest_px} pixels a side"
            raise InputError(path, "", reason)
        return texture

    def is_reading(self, place: Place) -> bool:
        """Whether a file for a place is still on its way."""
        return place in self._tasks

    def forget(self, place: Place) -> None:
        """What was asked for a place is no longer wanted, nor why it could not be had."""
        self.problems.pop(place, None)
        task = self._tasks.pop(place, None)
        if task is not None:
            task.texture.cancel()

    def deliver(self, wait: bool = False) -> list[InputError]:
        """Hand over what has been read. Returns what could not be read since."""
        broken = []
        for place, task in list(self._tasks.items()):
            if not (wait or task.texture.done()):
                continue
            del self._tasks[place]
            try:
                task.take(task.texture.result())
            except InputError as error:
                self.problems[place] = error
                broken.append(error)
        return broken

    def clear(self) -> None:
        """Forget everything: the scene is another one."""
        for place in {*self._tasks, *self.problems}:
            self.forget(place)

    def release(self) -> None:
        """End the thread."""
        self.clear()
        if self._thread is not None:
            self._thread.shutdown(wait=True, cancel_futures=True)
            self._thread = None
