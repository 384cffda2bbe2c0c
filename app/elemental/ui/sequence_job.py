"""A frame sequence rendered from the panel, a frame at a time between the frames of the window."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

from elemental.core.errors import InputError
from elemental.gpu.device import Device
from elemental.scene.model import Camera
from elemental.sequence.frames import Sequence, Step
from elemental.session import Stage, frame_file
from elemental.settings import Settings


@dataclass(frozen=True)
class SequenceWords:
    """What the page asks for; ``frames`` are first and last, the latter included."""

    folder: Path
    name: str = "%05d.png"
    frames: tuple[int, int] = (0, 119)
    fps: float = 30.0
    size: tuple[int, int] = (1280, 720)
    view: str = "final"
    overwrite: bool = False


class SequenceJob:
    """Begun by its constructor, which raises InputError for what can't be written."""

    def __init__(self, device: Device, stage: Stage, words: SequenceWords) -> None:
        first, last = words.frames
        if last < first:
            raise InputError("frames", f"{first} to {last}", "the last is before the first")
        pattern = words.folder / words.name
        if frame_file(pattern, 0) == frame_file(pattern, 1):
            raise InputError("name", words.name, "needs a frame number such as %05d")
        try:
            words.folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise InputError(words.folder, "", f"can't be made ({error.strerror})") from error
        sequence = Sequence(
            stage, words.size, words.view, first, last, words.fps,
            lambda frame: frame_file(pattern, frame),
        )  # fmt: skip
        self.count = last - first + 1
        self.done = self.rendered = 0
        self.folder = words.folder
        self.newest = ""
        self._began = time.perf_counter()
        self._steps: Iterator[Step] | None = sequence.render(device, overwrite=words.overwrite)

    @property
    def is_over(self) -> bool:
        """Whether no frame is left, or it was stopped."""
        return self._steps is None

    @property
    def seconds_left(self) -> float | None:
        """At the pace of the frames that were made; None before the first of them."""
        if not self.rendered:
            return None
        passed = time.perf_counter() - self._began
        return passed / self.rendered * (self.count - self.done)

    def advance(self) -> None:
        """Make one frame. Raises InputError where it can't be written; the job is over then."""
        if self._steps is None:
            return
        try:
            step = next(self._steps, None)
        except InputError:
            self.stop()
            raise
        if step is None or self.done + 1 == self.count:
            self.stop()
        if step is not None:
            self.done += 1
            self.rendered += step.rendered
            self.newest = step.file.name

    def stop(self) -> None:
        """Leave the rest to another time: what is there is kept and gone on from."""
        if self._steps is not None:
            close = getattr(self._steps, "close", None)
            if close is not None:
                close()
            self._steps = None


def staged(stage: Stage, settings: Settings, camera: Camera | None) -> Stage:
    """The stage with the document's settings, from ``camera`` (None: as the scene moves it)."""
    if camera is None:
        return replace(stage, settings=settings)
    return replace(stage, settings=settings, camera=replace(camera, node=-1), path=None)
