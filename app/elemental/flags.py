"""The flags of the command line: each with its unit, range and default, checked as it is read.

`flag_values` has the kinds of their values.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping
from pathlib import Path

from elemental import __version__
from elemental.flag_values import (
    Parser,
    frame_span,
    join_vectors,
    number,
    port,
    size,
    vector,
    whole,
)

DEFAULT_SIZE = (1280, 720)
"""(width, height) of a picture, pixels."""

REMOTE_PORT, OSC_PORT = 8012, 8013
"""Where ``--remote`` and ``--osc`` listen unless told; free of well-known services [IANA]."""
LISTS = (
    "views", "settings", "scenes", "cameras", "animations", "materials", "bindings", "graph",
)  # fmt: skip

Command = Callable[[argparse.Namespace], None]


def parse(words: list[str], commands: Mapping[str, Command]) -> argparse.Namespace:
    """The options of one command line, ``command`` among them. Raises InputError."""
    return build_parser(commands).parse_args(join_vectors(words))


def build_parser(commands: Mapping[str, Command]) -> argparse.ArgumentParser:
    """The parser of all commands; ``commands`` maps each command's name to what it calls."""
    parser = Parser(
        prog="elemental", description="A renderer lit by voxel cone tracing in a sparse octree."
    )
    parser.add_argument("--version", action="version", version=f"elemental {__version__}")
    subparsers = parser.add_subparsers(title="commands", metavar="COMMAND", required=True)
    for name, (text, add_flags) in _COMMANDS.items():
        command = subparsers.add_parser(name, help=text, description=text)
        command.set_defaults(command=commands[name])
        add_flags(command)
    return parser


def _add_common_flags(parser: Parser) -> None:
    parser.add_argument(
        "scene",
        nargs="?",
        metavar="SCENE",
        help=".gltf, .glb, .toml or a name of `elemental list scenes` (default: the demo)",
    )
    flag = parser.flag
    flag("--size", "WxH", size, DEFAULT_SIZE, "width and height in pixels (default: 1280x720)")
    _add_set_flag(parser)


def _add_set_flag(parser: Parser) -> None:
    parser.add_argument(
        "--set",
        dest="assignments",
        action="append",
        default=[],
        metavar="KEY=VALUE",
        help="assign a setting of `elemental list settings`, repeatable (default: the scene's)",
    )


def _add_output_flags(parser: Parser, metavar: str, text: str) -> None:
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
    parser.flag("--fps", "F", number(1e-3, 1e4), 30.0, fps)


def _add_shot_flags(parser: Parser) -> None:
    text = "picture to write, one a frame if its name holds %%04d"
    _add_output_flags(parser, "OUT.png|OUT.exr", text)
    _add_common_flags(parser)
    flag = parser.flag
    flag("--frames", "N", whole(1, 10**6), 1, "frames to render; the last is kept (default: 1)")
    flag("--time", "S", number(0, 1e6), 0.0, "scene time of frame 0 in seconds (default: 0)")
    flag("--seed", "K", whole(0, 2**31 - 1), 0, "seed of random choices, none so far (default: 0)")
    _add_viewpoint_flags(parser)
    parser.add_argument(
        "--ui", action="store_true", help="draw the panel around the picture (default: off)"
    )
    flag("--ui-page", "NAME", str, None, "the same with a page in front (default: Settings)")
    flag("--report", "R.json", Path, None, "also write times in ms and bytes (default: none)")


def _add_viewpoint_flags(parser: Parser) -> None:
    flag = parser.flag
    flag("--camera", "NAME", str, None, "a camera of the scene (default: its path, else its first)")
    flag("--eye", "X,Y,Z", vector, None, "camera position in metres (default: the camera's)")
    flag("--target", "X,Y,Z", vector, None, "point looked at in metres (default: the camera's)")
    flag("--fov", "DEG", number(1, 179), None, "vertical angle, degrees (default: the camera's)")
    flag("--view", "NAME", str, "final", "a buffer of `elemental list views` (default: final)")


def _add_render_flags(parser: Parser) -> None:
    metavar = "DIR|NAME%05d.png|FILE.mp4"
    _add_output_flags(parser, metavar, "folder, numbered pictures (.png, .exr) or video to make")
    _add_common_flags(parser)
    flag = parser.flag
    flag("--frames", "A:B", frame_span, None, "frames A to B-1 (default: the camera path's)")
    _add_viewpoint_flags(parser)
    parser.add_argument(
        "--overwrite", action="store_true", help="make every frame anew (default: keep whole ones)"
    )


def _add_run_flags(parser: Parser) -> None:
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
    flag("--frames", "N", whole(1, 10**9), None, "exit after N frames (default: never)")
    for name, const, what in (("--remote", REMOTE_PORT, "HTTP"), ("--osc", OSC_PORT, "OSC")):
        parser.add_argument(
            name,
            nargs="?",
            metavar="PORT",
            type=port,
            const=const,
            help=f"let {what} drive the volumes, 0: any free port (default: off; alone: {const})",
        )
    text = "address that --remote and --osc listen on (default: 127.0.0.1, this machine alone)"
    flag("--remote-host", "IP", str, None, text)


def _add_bench_flags(parser: Parser) -> None:
    _add_common_flags(parser)
    flag = parser.flag
    flag("--frames", "N", whole(1, 10**6), 30, "frames to measure (default: 30)")
    flag("--warmup", "N", whole(0, 10**6), 5, "frames to render before (default: 5)")
    parser.add_argument(
        "--rebuild",
        choices=("none", "view", "light", "geometry"),
        default="none",
        help="work forced in each frame: none, cones as of a moving view, relight, revoxelize "
        "(default: none)",
    )
    flag("--time", "S", number(0, 1e6), 0.0, "scene time of the first frame, s (default: 0)")
    fps = "frames a second of scene time; 0 stands still (default: 30)"
    flag("--fps", "F", number(0, 1e4), 30.0, fps)
    flag("--json", "B.json", Path, None, "also write the figures, in ms (default: none)")


def _add_list_words(parser: Parser) -> None:
    parser.add_argument("what", choices=LISTS, help="what to list")
    parser.add_argument(
        "scene",
        nargs="?",
        metavar="SCENE",
        help="whose cameras, animations or graph (default: the demo's graph)",
    )
    flag = parser.flag
    flag("--size", "WxH", size, None, "of the graph's frame, in pixels (default: 1280x720)")
    flag("--view", "NAME", str, None, "the graph's buffer of `list views` (default: final)")
    flag("--json", "G.json", Path, None, "also write the graph, in ms and bytes (default: none)")
    _add_set_flag(parser)


_COMMANDS: dict[str, tuple[str, Callable[[Parser], None]]] = {
    "shot": ("render a picture or a numbered sequence, headless", _add_shot_flags),
    "render": ("render a frame sequence or a video, resumable", _add_render_flags),
    "run": ("open a window with a fly camera and pass times", _add_run_flags),
    "bench": ("time each pass of the frame, headless", _add_bench_flags),
    "list": ("list what can be named on the command line", _add_list_words),
}
