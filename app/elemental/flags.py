"""The flags of the command line: each with its unit, range and default, checked as it is read."""

from __future__ import annotations

import argparse
import math
import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NoReturn

from elemental import __version__
from elemental.core.errors import InputError

DEFAULT_SIZE = (1280, 720)
"""(width, height) of a picture, pixels."""
MAX_FRAME = 10**6
"""Last frame of a sequence, nine hours at 30 a second."""
MAX_SIDE_PX = 16384
"""Largest image side; the texture limit of common drivers."""

MAX_COORDINATE_M = 1e9
"""Farthest camera; beyond it 32-bit positions hold no scene."""

VECTOR_FLAGS = frozenset({"--eye", "--target"})
REMOTE_PORT, OSC_PORT = 8012, 8013
"""Where ``--remote`` and ``--osc`` listen unless told; free of well-known services [IANA]."""
LISTS = (
    "views", "settings", "scenes", "cameras", "animations", "materials", "bindings", "graph",
)  # fmt: skip

Command = Callable[[argparse.Namespace], None]


class _Parser(argparse.ArgumentParser):
    """Refuses by InputError instead of a usage page, and takes no abbreviated flags."""

    def __init__(self, **options: Any) -> None:
        super().__init__(**options, allow_abbrev=False)

    def error(self, message: str) -> NoReturn:
        raise InputError("", "", message.removeprefix("argument "))

    def flag(self, name: str, metavar: str, kind: Any, default: Any, text: str) -> None:
        """A flag with a value; ``kind`` makes the value of a text or raises ArgumentTypeError."""
        self.add_argument(name, metavar=metavar, type=kind, default=default, help=text)


def parse(words: list[str], commands: Mapping[str, Command]) -> argparse.Namespace:
    """The options of one command line, ``command`` among them. Raises InputError."""
    return build_parser(commands).parse_args(_join_vectors(words))


def build_parser(commands: Mapping[str, Command]) -> argparse.ArgumentParser:
    """The parser of all commands; ``commands`` maps each command's name to what it calls."""
    parser = _Parser(
        prog="elemental", description="A renderer lit by voxel cone tracing in a sparse octree."
    )
    parser.add_argument("--version", action="version", version=f"elemental {__version__}")
    subparsers = parser.add_subparsers(title="commands", metavar="COMMAND", required=True)
    for name, (text, add_flags) in _COMMANDS.items():
        command = subparsers.add_parser(name, help=text, description=text)
        command.set_defaults(command=commands[name])
        add_flags(command)
    return parser


def _add_common_flags(parser: _Parser) -> None:
    parser.add_argument(
        "scene",
        nargs="?",
        metavar="SCENE",
        help=".gltf, .glb, .toml or a name of `elemental list scenes` (default: the demo)",
    )
    flag = parser.flag
    flag("--size", "WxH", _size, DEFAULT_SIZE, "width and height in pixels (default: 1280x720)")
    _add_set_flag(parser)


def _add_set_flag(parser: _Parser) -> None:
    parser.add_argument(
        "--set",
        dest="assignments",
        action="append",
        default=[],
        metavar="KEY=VALUE",
        help="assign a setting of `elemental list settings`, repeatable (default: the scene's)",
    )


def _add_output_flags(parser: _Parser, metavar: str, text: str) -> None:
    """What a command writes, and the time from one of its frames to the next."""
    parser.add_argument(
        "-o",
        "--output",
        type=Path,
        required=True,
        metavar=metavar,
        help=f"{text} (required, no default)",
    )
    fps = "frames a second of scene time (default: 30)"
    parser.flag("--fps", "F", _number(1e-3, 1e4), 30.0, fps)


def _add_shot_flags(parser: _Parser) -> None:
    text = "picture to write, one a frame if its name holds %%04d"
    _add_output_flags(parser, "OUT.png|OUT.exr", text)
    _add_common_flags(parser)
    flag = parser.flag
    flag("--frames", "N", _whole(1, 10**6), 1, "frames to render; the last is kept (default: 1)")
    flag("--time", "S", _number(0, 1e6), 0.0, "scene time of frame 0 in seconds (default: 0)")
    flag("--seed", "K", _whole(0, 2**31 - 1), 0, "seed of random choices, none so far (default: 0)")
    _add_viewpoint_flags(parser)
    parser.add_argument(
        "--ui", action="store_true", help="draw the panel around the picture (default: off)"
    )
    flag("--ui-page", "NAME", str, None, "the same with a page in front (default: Settings)")
    flag("--report", "R.json", Path, None, "also write times in ms and bytes (default: none)")


def _add_viewpoint_flags(parser: _Parser) -> None:
    flag = parser.flag
    flag("--camera", "NAME", str, None, "a camera of the scene (default: its path, else its first)")
    flag("--eye", "X,Y,Z", _vector, None, "camera position in metres (default: the camera's)")
    flag("--target", "X,Y,Z", _vector, None, "point looked at in metres (default: the camera's)")
    flag("--fov", "DEG", _number(1, 179), None, "vertical angle, degrees (default: the camera's)")
    flag("--view", "NAME", str, "final", "a buffer of `elemental list views` (default: final)")


def _add_render_flags(parser: _Parser) -> None:
    metavar = "DIR|NAME%05d.png|FILE.mp4"
    _add_output_flags(parser, metavar, "folder, numbered pictures (.png, .exr) or video to make")
    _add_common_flags(parser)
    flag = parser.flag
    flag("--frames", "A:B", _span, None, "frames A to B-1 (default: the camera path's)")
    _add_viewpoint_flags(parser)
    parser.add_argument(
        "--overwrite", action="store_true", help="make every frame anew (default: keep whole ones)"
    )


def _add_run_flags(parser: _Parser) -> None:
    _add_common_flags(parser)
    parser.add_argument(
        "--fullscreen", action="store_true", help="cover the primary monitor (default: off)"
    )
    parser.add_argument(
        "--panel",
        action=argparse.BooleanOptionalAction,
        default=None,
        help="show the panel at first (default: as it was left, F5 changes it)",
    )
    flag = parser.flag
    flag("--frames", "N", _whole(1, 10**9), None, "exit after N frames (default: never)")
    for name, const, what in (("--remote", REMOTE_PORT, "HTTP"), ("--osc", OSC_PORT, "OSC")):
        parser.add_argument(
            name,
            nargs="?",
            metavar="PORT",
            type=_port,
            const=const,
            help=f"let {what} drive the volumes, 0: any free port (default: off; alone: {const})",
        )
    text = "address that --remote and --osc listen on (default: 127.0.0.1, this machine alone)"
    flag("--remote-host", "IP", str, None, text)


def _add_bench_flags(parser: _Parser) -> None:
    _add_common_flags(parser)
    flag = parser.flag
    flag("--frames", "N", _whole(1, 10**6), 30, "frames to measure (default: 30)")
    flag("--warmup", "N", _whole(0, 10**6), 5, "frames to render before (default: 5)")
    parser.add_argument(
        "--rebuild",
        choices=("none", "light", "geometry"),
        default="none",
        help="voxel work forced in each frame: none, relight, revoxelize (default: none)",
    )
    flag("--time", "S", _number(0, 1e6), 0.0, "scene time of the first frame, s (default: 0)")
    fps = "frames a second of scene time; 0 stands still (default: 30)"
    flag("--fps", "F", _number(0, 1e4), 30.0, fps)
    flag("--json", "B.json", Path, None, "also write the figures, in ms (default: none)")


def _add_list_words(parser: _Parser) -> None:
    parser.add_argument("what", choices=LISTS, help="what to list")
    parser.add_argument(
        "scene",
        nargs="?",
        metavar="SCENE",
        help="whose cameras, animations or graph (default: the demo's graph)",
    )
    flag = parser.flag
    flag("--size", "WxH", _size, None, "of the graph's frame, in pixels (default: 1280x720)")
    flag("--view", "NAME", str, None, "the graph's buffer of `list views` (default: final)")
    flag("--json", "G.json", Path, None, "also write the graph, in ms and bytes (default: none)")
    _add_set_flag(parser)


_COMMANDS: dict[str, tuple[str, Callable[[_Parser], None]]] = {
    "shot": ("render a picture or a numbered sequence, headless", _add_shot_flags),
    "render": ("render a frame sequence or a video, resumable", _add_render_flags),
    "run": ("open a window with a fly camera and pass times", _add_run_flags),
    "bench": ("time each pass of the frame, headless", _add_bench_flags),
    "list": ("list what can be named on the command line", _add_list_words),
}


def _join_vectors(words: list[str]) -> list[str]:
    """``--eye -1,2,3`` as ``--eye=-1,2,3``: argparse takes the former's value for a flag."""
    joined: list[str] = []
    for word in words:
        if joined and joined[-1] in VECTOR_FLAGS and re.match(r"-[\d.]", word):
            joined[-1] += f"={word}"
        else:
            joined.append(word)
    return joined


def _size(text: str) -> tuple[int, int]:
    match = re.fullmatch(r"(\d{1,5})[xX](\d{1,5})", text, re.ASCII)
    size = (int(match[1]), int(match[2])) if match else (0, 0)
    if not all(1 <= side <= MAX_SIDE_PX for side in size):
        raise argparse.ArgumentTypeError(f"{text!r} is not WIDTHxHEIGHT, 1 to {MAX_SIDE_PX} pixels")
    return size


def _vector(text: str) -> tuple[float, float, float]:
    try:
        x, y, z = (float(part) for part in text.split(","))
    except ValueError:
        x = y = z = math.nan
    if not all(abs(component) <= MAX_COORDINATE_M for component in (x, y, z)):
        raise argparse.ArgumentTypeError(f"{text!r} is not X,Y,Z in metres")
    return x, y, z


def _whole(lo: int, hi: int) -> Callable[[str], int]:
    def parse_whole(text: str) -> int:
        value = int(text) if re.fullmatch(r"-?\d{1,12}", text, re.ASCII) else None
        if value is None or not lo <= value <= hi:
            raise argparse.ArgumentTypeError(f"{text!r} is not a whole number, {lo} to {hi}")
        return value

    return parse_whole


def _span(text: str) -> tuple[int, int]:
    match = re.fullmatch(r"(\d{1,7}):(\d{1,7})", text, re.ASCII)
    first, end = (int(match[1]), int(match[2])) if match else (0, 0)
    if not first < end <= MAX_FRAME:
        raise argparse.ArgumentTypeError(f"{text!r} is not A:B with A < B, up to {MAX_FRAME}")
    return first, end


_PORT = _whole(0, 65535)


def _port(text: str) -> int:
    try:
        return _PORT(text)
    except argparse.ArgumentTypeError:
        raise argparse.ArgumentTypeError(f"{text!r} is not a port, 0 to 65535") from None


def _number(lo: float, hi: float) -> Callable[[str], float]:
    def parse_number(text: str) -> float:
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not lo <= value <= hi:
            raise argparse.ArgumentTypeError(f"{text!r} is not a number, {lo:g} to {hi:g}")
        return value

    return parse_number
