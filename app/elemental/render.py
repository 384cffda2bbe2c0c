"""``elemental render``: a frame sequence or a video, resumable and the same every time."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)

from elemental.core.errors import InputError
from elemental.frame import VIEWS
from elemental.picture import SUFFIXES
from elemental.report import say
from elemental.sequence.frames import Sequence, Step
from elemental.sequence.manifest import FILE_NAME
from elemental.sequence.video import encode, find_ffmpeg
from elemental.session import (
    FRAME_NUMBER,
    Point,
    Stage,
    Viewpoint,
    check_output,
    frame_file,
    headless_device,
    known_name,
    set_stage,
)

VIDEO_SUFFIX = ".mp4"
OTHER_VIDEOS = frozenset({".avi", ".gif", ".mkv", ".mov", ".webm"})
DEFAULT_NAME = "%05d.png"
"""Of the frames in a folder."""
VIDEO_FRAMES = ".frames"
"""What a video's name gets as the folder of its frames, until it is whole."""


@dataclass(frozen=True)
class Render:
    """The words of one ``elemental render``; ``frames`` are (first, last + 1), None: the path's."""

    scene: str | None
    output: Path
    size: tuple[int, int]
    frames: tuple[int, int] | None
    fps: float
    camera: str | None
    eye: Point | None
    target: Point | None
    fov: float | None
    view: str
    assignments: list[str]
    overwrite: bool


def render(words: Render) -> None:
    """Make what is not there yet and say where it is. Raises InputError before the first frame."""
    known_name("--view", words.view, list(VIEWS))
    is_video = words.output.suffix.lower() == VIDEO_SUFFIX
    ffmpeg = _check_video(words) if is_video else ""
    pattern = _pattern(words.output)
    viewpoint = Viewpoint(words.camera, words.eye, words.target, words.fov)
    stage = set_stage(words.scene, words.assignments, viewpoint, words.size)
    first, end = _frames(words, stage)
    _make_folder(pattern.parent)
    sequence = Sequence(
        stage, words.size, words.view, first, end - 1, words.fps,
        lambda frame: frame_file(pattern, frame),
    )  # fmt: skip
    device = headless_device()
    steps = sequence.render(device, overwrite=words.overwrite)
    rendered = 0
    problems: dict[str, None] = {}
    for step in _told(steps, end - first):
        rendered += step.rendered
        problems.update(dict.fromkeys(step.problems))
    say([*stage.scene.warnings, *problems], stage.scene.notes)
    if is_video:
        encode(ffmpeg, pattern, first, end - first, words.fps, words.output)
        _remove_frames(pattern.parent, (sequence.file(frame) for frame in range(first, end)))
    where = words.output if is_video else pattern.parent
    print(f"{where}: {end - first} frames, {rendered} of them rendered now")


def _check_video(words: Render) -> str:
    """The encoder. Raises InputError for a video that can't be made."""
    check_output("-o", words.output, (VIDEO_SUFFIX,))
    if any(side % 2 for side in words.size):
        size = "x".join(map(str, words.size))
        raise InputError("--size", size, "an .mp4 needs even sides")
    return find_ffmpeg()


def _pattern(output: Path) -> Path:
    """Frames' path with %d in its name: a folder's, a video's, or as it was given."""
    if output.suffix.lower() == VIDEO_SUFFIX:
        return output.with_name(output.name + VIDEO_FRAMES) / DEFAULT_NAME
    if FRAME_NUMBER.search(output.name):
        if output.suffix.lower() not in SUFFIXES:
            raise InputError("-o", str(output), f"the name must end in {' or '.join(SUFFIXES)}")
        frame_file(output, 0)
        return output
    if output.suffix.lower() in SUFFIXES:
        raise InputError("-o", str(output), "needs a frame number, as in %05d.png, or a folder")
    if output.suffix.lower() in OTHER_VIDEOS and not output.is_dir():
        raise InputError(
            "-o", str(output), f"videos are {VIDEO_SUFFIX}; else a folder, or %05d.png"
        )
    return output / DEFAULT_NAME


def _frames(words: Render, stage: Stage) -> tuple[int, int]:
    """(first, last + 1) as asked for, else as long as the camera's path."""
    if words.frames is not None:
        return words.frames
    if stage.path is None:
        raise InputError("--frames", "", "needs A:B: the scene has no camera path")
    return 0, max(math.ceil(float(stage.path.times[-1]) * words.fps), 1)


def _make_folder(folder: Path) -> None:
    try:
        folder.mkdir(exist_ok=True)
    except OSError as error:
        is_file = isinstance(error, FileExistsError)
        reason = "is a file, not a folder" if is_file else f"can't be made ({error.strerror})"
        raise InputError("-o", str(folder), reason) from error


def _told(steps: Iterable[Step], count: int) -> Iterator[Step]:
    """The steps, with progress on a terminal."""
    console = Console(stderr=True)
    columns = (
        TextColumn("frame {task.fields[frame]}"), BarColumn(), MofNCompleteColumn(),
        TimeElapsedColumn(), TextColumn("left"), TimeRemainingColumn(),
    )  # fmt: skip
    with Progress(*columns, console=console, disable=not console.is_terminal) as progress:
        task = progress.add_task("", total=count, frame="")
        for step in steps:
            progress.update(task, advance=1, frame=step.frame)
            yield step


def _remove_frames(folder: Path, frames: Iterable[Path]) -> None:
    """What a video was made from; a folder that holds anything else stays."""
    for file in (*frames, folder / FILE_NAME):
        file.unlink(missing_ok=True)
    if not any(folder.iterdir()):
        folder.rmdir()
