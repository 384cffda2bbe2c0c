"""Image files that an artist chooses: read by a thread, so that no frame waits for them."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, NamedTuple, TypeAlias, TypeVar

from elemental.core.errors import InputError
from elemental.scene.lights import LightMask
from elemental.scene.materials import Texture
from elemental.scene.scene_materials import read_texture

Picture: TypeAlias = Texture | LightMask
_Picture = TypeVar("_Picture", Texture, LightMask)


@dataclass(frozen=True)
class Place:
    """Where an image goes: the number of a material or light, and the name of its parameter."""

    of: Literal["material", "light"]
    index: int
    name: str


class _Task(NamedTuple):
    image: Future[Any]
    take: Callable[[Any], None]


def read_fitting(path: Path, largest_px: int) -> Texture:
    """An image file as a texture of at most ``largest_px`` a side. Raises InputError."""
    texture = read_texture(path)
    height, width = texture.pixels.shape[:2]
    if max(width, height) > largest_px:
        reason = f"is {width}x{height}; this driver takes {largest_px} pixels a side"
        raise InputError(path, "", reason)
    return texture


class ImageReader:
    """Reads one file after another; the newest for a place is the one that counts.

    `problems` tells by place why what was asked for last is not there.
    """

    def __init__(self) -> None:
        self.problems: dict[Place, InputError] = {}
        self._tasks: dict[Place, _Task] = {}
        self._thread: ThreadPoolExecutor | None = None

    def ask(
        self,
        place: Place,
        path: Path,
        read: Callable[[Path], _Picture],
        take: Callable[[_Picture], None],
    ) -> None:
        """Have a file read and given to ``take`` by one of the next `deliver`."""
        if self._thread is None:
            self._thread = ThreadPoolExecutor(1, "images")
        self.forget(place)
        self._tasks[place] = _Task(self._thread.submit(_told, read, path), take)

    def is_reading(self, place: Place) -> bool:
        """Whether a file for a place is still on its way."""
        return place in self._tasks

    def forget(self, place: Place) -> None:
        """What was asked for a place is no longer wanted, nor why it could not be had."""
        self.problems.pop(place, None)
        task = self._tasks.pop(place, None)
        if task is not None:
            task.image.cancel()

    def deliver(self, wait: bool = False) -> list[InputError]:
        """Hand over what has been read. Returns what could not be read since."""
        broken = []
        for place, task in list(self._tasks.items()):
            if not (wait or task.image.done()):
                continue
            del self._tasks[place]
            try:
                task.take(task.image.result())
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


def _told(read: Callable[[Path], _Picture], path: Path) -> _Picture:
    """What ``read`` makes of a file; whatever it raises is an InputError."""
    try:
        return read(path)
    except InputError:
        raise
    except MemoryError as error:
        raise InputError(path, "", "is larger than this machine's memory") from error
    except Exception as error:  # no frame may end for a file that an artist chose
        raise InputError(path, "", f"can't be read ({error})") from error
