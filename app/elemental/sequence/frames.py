"""Rendering the frames of a sequence that are not there yet, exactly as if none had been.

A frame can depend on those before it: the eye adapts, motion is blurred, and a moving scene's
voxels stand where they came to stand. So the sequence is cut into blocks. A block starts from a
fresh renderer with the eye's history of two frames before, renders the frame before it unseen, and
goes on from there, whether or not the run was interrupted. A block with a missing frame is rendered
again from its start; of a whole one only the history at its end is needed, and that is in the
manifest.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from elemental.core.errors import InputError
from elemental.frame import Renderer
from elemental.gpu.device import Device
from elemental.picture import is_picture, save_picture
from elemental.sequence.manifest import Manifest, identity, scene_file
from elemental.session import Stage

BLOCK = 32
"""Frames that an interruption can cost at most; a moving scene's voxels are rebuilt as often."""
LEAD_IN = 1
"""Frames before a block that are rendered unseen: what moves knows where it came from."""


@dataclass(frozen=True)
class Step:
    """One frame is there: it was rendered now, or it was there before."""

    frame: int
    file: Path
    rendered: bool
    problems: tuple[str, ...] = ()
    """What is wrong with materials and effects so far, a line each."""


@dataclass(frozen=True)
class Sequence:
    """Frames ``first`` to ``last``, the latter included, ``fps`` a second of scene time.

    ``file`` gives each frame's path, all in one existing folder.
    """

    stage: Stage
    size: tuple[int, int]
    view: str
    first: int
    last: int
    fps: float
    file: Callable[[int], Path]

    def render(self, device: Device, *, overwrite: bool = False) -> Iterator[Step]:
        """Make every frame; a step each, in order. May be dropped at any step and begun again.

        Frames that are there whole are kept, unless ``overwrite``. Raises InputError where frames
        or a manifest are there that don't belong to this sequence, before the first step.
        """
        stage = self.stage
        shapes = identity(stage, device, self.size, self.view, self.fps, self.first)
        folder = self.file(self.first).parent
        manifest = Manifest(folder, shapes, scene_file(stage.scene))
        resumes = False
        if overwrite:
            self._remove(manifest.told_range())
        else:
            resumes = manifest.resume()
            if not resumes and any(self.file(f).exists() for f in self._range):
                reason = (
                    "holds such frames without a note of what they show; --overwrite begins anew"
                )
                raise InputError("-o", str(folder), reason)
        manifest.include(self.first, self.last)
        manifest.write()
        run = _Run(self, device, manifest)
        try:
            yield from run.steps(keeps=resumes)
        finally:
            run.release()

    @property
    def _range(self) -> range:
        return range(self.first, self.last + 1)

    def _remove(self, others: range) -> None:
        """Frames of before, those outside this sequence too, else a later run would keep them."""
        for frame in {*self._range, *others}:
            self.file(frame).unlink(missing_ok=True)

    def is_there(self, frame: int) -> bool:
        """Whether a frame's file is whole."""
        return is_picture(self.file(frame), self.size)


class _Run:
    """One call of ``Sequence.render``; holds the renderer between its frames."""

    def __init__(self, sequence: Sequence, device: Device, manifest: Manifest) -> None:
        self.sequence, self.device, self.manifest = sequence, device, manifest
        self._renderer: Renderer | None = None
        self._next = -1
        """The frame that the renderer's history fits."""

    def steps(self, keeps: bool) -> Iterator[Step]:
        sequence, states = self.sequence, self.manifest.states
        for start in range(sequence.first, sequence.last + 1, BLOCK):
            end = start + BLOCK - 1
            frames = range(start, min(end, sequence.last) + 1)
            there = {frame for frame in frames if keeps and sequence.is_there(frame)}
            goes_on = end < sequence.last
            if len(there) == len(frames) and (not goes_on or end - LEAD_IN in states):
                for frame in frames:
                    yield Step(frame, sequence.file(frame), rendered=False)
                continue
            yield from self._block(frames, there)

    def release(self) -> None:
        """Free the renderer."""
        if self._renderer is not None:
            self._renderer.release()
            self._renderer = None

    def _block(self, frames: range, there: set[int]) -> Iterator[Step]:
        self._begin(frames[0])
        for frame in frames:
            is_new = frame not in there
            self._render(frame, save=is_new)
            assert self._renderer is not None, "a frame has just been rendered"
            if frame == frames[0] + BLOCK - 1 - LEAD_IN:
                self.manifest.states[frame] = self._renderer.history()
                self.manifest.write()
            problems = tuple(self._renderer.problems())
            yield Step(frame, self.sequence.file(frame), is_new, problems)

    def _begin(self, start: int) -> None:
        """A renderer whose next frame is ``start``, the same however the run came here."""
        stage = self.sequence.stage
        if self._next == start and stage.scene.motion is None:
            return  # nothing but the history is carried over
        self.release()
        self._renderer = Renderer(self.device, stage.scene, stage.settings, self.sequence.size)
        if start > self.sequence.first:
            self._renderer.restore_history(self.manifest.states[start - 1 - LEAD_IN])
            for frame in range(start - LEAD_IN, start):
                self._render(frame, save=False)

    def _render(self, frame: int, save: bool) -> None:
        sequence, renderer = self.sequence, self._renderer
        assert renderer is not None, "a block has begun"
        time_s = frame / sequence.fps
        drawn = renderer.render(sequence.stage.camera_at(time_s), time_s, frame, sequence.view)
        self.device.finish()
        self._next = frame + 1
        if save:
            save_picture(sequence.file(frame), renderer.read(drawn), drawn.is_linear)
