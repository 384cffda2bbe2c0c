"""The command line: words to calls, nothing else.

Exit codes: 0 done; 2 bad input, told in one line on stderr; 130 interrupted. What needs GL,
images or a window is imported by the command that uses it: help and refusals come at once.
"""

from __future__ import annotations

import argparse
import os
import sys
import warnings
from collections.abc import Sequence
from dataclasses import fields
from typing import TypeVar

from elemental.core.collector import collect_rarely
from elemental.core.errors import InputError
from elemental.flags import DEFAULT_SIZE, parse

T = TypeVar("T")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command; returns the exit code."""
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="backslashreplace")
    if not sys.warnoptions:
        warnings.simplefilter("ignore")  # libraries' own words, which no user can act on
    collect_rarely()
    words = list(sys.argv[1:] if arguments is None else arguments)
    commands = {"shot": _shot, "run": _run, "bench": _bench, "render": _render, "list": _list}
    try:
        options = parse(words, commands)
        options.command(options)
        if sys.stdout is not None:
            sys.stdout.flush()
    except InputError as error:
        first, *more = error.lines
        return _refuse("; ".join([first, *(line.removeprefix(f"{error.file}: ") for line in more)]))
    except MemoryError as error:
        return _refuse(f"out of memory: {error}" if str(error) else "out of memory")
    except ImportError as error:
        if error.name is None or error.name.partition(".")[0] == __package__:
            raise
        return _refuse(f"needs {error.name}: pip install elemental ({error})")
    except BrokenPipeError:
        _drop_output()
    except OSError as error:
        if error.filename is not None:
            raise  # not a stream
        _drop_output()
        return _refuse(f"standard output: can't be written ({error.strerror or error})")
    except KeyboardInterrupt:
        return 130
    return 0


def _drop_output() -> None:
    """Let what stdout still holds go nowhere, else Python complains of it at its end."""
    if sys.stdout is not None:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _refuse(message: str) -> int:
    line = "".join(c if c.isprintable() else "?" for c in " ".join(message.split()))
    print(f"elemental: error: {line}", file=sys.stderr)
    return 2


def _filled(kind: type[T], options: argparse.Namespace) -> T:
    """The dataclass ``kind`` from the options that bear its fields' names."""
    values = {field.name: getattr(options, field.name) for field in fields(kind)}  # type: ignore[arg-type]
    return kind(**values)


def _shot(options: argparse.Namespace) -> None:
    from elemental.shot import Shot, shoot  # noqa: PLC0415

    shoot(_filled(Shot, options))


def _run(options: argparse.Namespace) -> None:
    from elemental.ui.app import Run, run  # noqa: PLC0415

    run(_filled(Run, options))


def _bench(options: argparse.Namespace) -> None:
    from elemental.bench import Bench, bench  # noqa: PLC0415

    bench(_filled(Bench, options))


def _render(options: argparse.Namespace) -> None:
    from elemental.render import Render, render  # noqa: PLC0415

    render(_filled(Render, options))


def _list(options: argparse.Namespace) -> None:
    from elemental.listing import OF_A_SCENE, lines  # noqa: PLC0415

    of_graph = [f for f in ("size", "view", "assignments", "json") if getattr(options, f)]
    if options.what != "graph" and of_graph:
        flag = "--set" if of_graph[0] == "assignments" else f"--{of_graph[0]}"
        raise InputError(f"list {options.what}", flag, "is a flag of list graph")
    if options.what in OF_A_SCENE and options.scene is None:
        raise InputError(f"list {options.what}", "SCENE", "name a scene")
    if options.what not in (*OF_A_SCENE, "graph") and options.scene is not None:
        raise InputError(f"list {options.what}", options.scene, "takes no scene")
    if sys.stdout is None:
        raise InputError(f"list {options.what}", "", "the standard output is closed")
    found = _graph(options) if options.what == "graph" else lines(options.what, options.scene)
    for line in found:
        print(line)
    if not found:
        print(f"elemental: note: no {options.what}", file=sys.stderr)


def _graph(options: argparse.Namespace) -> list[str]:
    from elemental.graph_listing import GraphListing, list_graph  # noqa: PLC0415

    options.size = options.size or DEFAULT_SIZE
    options.view = options.view or "final"
    return list_graph(_filled(GraphListing, options))
