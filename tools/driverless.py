"""Frames without a driver: every GL call of a pass an empty function, so that Python is left."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from elemental.gpu.device import Device
from elemental.gpu.resources import Buffer

SIGNALLED = 0x911A
"""GL_ALREADY_SIGNALED: what a fence is asked for."""

COMPLETE = 0x8CD5
"""GL_FRAMEBUFFER_COMPLETE"""


class _Nothing:
    def __getattr__(self, _: str) -> Callable[..., int]:
        return _nothing


def _nothing(*_: Any, **__: Any) -> int:
    return SIGNALLED


def _available(_query: int, _parameter: int, answer: Any) -> None:
    answer._obj.value = 1


ANSWERS: dict[str, Callable[..., Any]] = {
    "glGetQueryObjectiv": _available,
    "glCheckFramebufferStatus": lambda _: COMPLETE,
    "glGetError": lambda: 0,
}


@contextmanager
def without_driver(device: Device) -> Iterator[None]:
    """Replace the GL calls of a warm device: its programs are compiled, its targets made."""
    stub: Any = _Nothing()
    gl = device.gl
    real = {name: value for name, value in vars(gl).items() if name.startswith("gl")}
    programs = list(device.library._programs.values())
    kept = [(program, program.mgl, dict(program.vertex_arrays)) for program in programs]
    write = Buffer.write
    try:
        for name in real:
            setattr(gl, name, ANSWERS.get(name, _nothing))
        for program in programs:
            program.mgl = stub
            program.vertex_arrays.update(dict.fromkeys(program.vertex_arrays, stub))
        Buffer.write = _nothing  # type: ignore[method-assign, assignment]
        yield
    finally:
        Buffer.write = write  # type: ignore[method-assign]
        for program, mgl, vertex_arrays in kept:
            program.mgl, program.vertex_arrays = mgl, vertex_arrays
        for name, value in real.items():
            setattr(gl, name, value)
