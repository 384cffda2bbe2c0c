"""GPU time of each pass by timestamps, read frames later and when asked for: nothing waits."""

from __future__ import annotations

import ctypes
from dataclasses import dataclass
from typing import NamedTuple

from elemental.gpu import gl as c


class PassTiming(NamedTuple):
    """Time of one pass of one frame."""

    name: str
    gpu_ms: float
    cpu_ms: float
    """Time of Python and of the driver's calls."""


@dataclass(slots=True)
class _Frame:
    names: list[str]
    cpu_ms: list[float]
    queries: list[int]


class PassTimers:
    """Timestamp queries in reused sets, one set a frame in flight."""

    def __init__(self, gl: c.GL) -> None:
        self._gl = gl
        self._spare: list[int] = []
        self._pending: list[_Frame] = []
        self._finished: _Frame | None = None
        """The newest frame that the GPU has finished, until somebody wants to know its times."""
        self._timings: list[PassTiming] = []
        self._frame_ms = 0.0
        self.made = 0
        """Queries made so far."""

    @property
    def timings(self) -> list[PassTiming]:
        """Passes of the newest finished frame."""
        self._read()
        return self._timings

    @property
    def frame_ms(self) -> float:
        """GPU time from the start of its first pass to the end of its last."""
        self._read()
        return self._frame_ms

    def begin(self, count: int) -> list[int]:
        """``count + 1`` queries for a frame of ``count`` passes."""
        while len(self._spare) <= count:
            self.made += 1
            self._spare.append(self._gl.generate("Queries"))
        queries = self._spare[: count + 1]
        del self._spare[: count + 1]
        return queries

    def end(self, names: list[str], cpu_ms: list[float], queries: list[int]) -> None:
        """Hand in the queries of a frame after all were issued."""
        self._pending.append(_Frame(names, cpu_ms, queries))

    def discard(self, queries: list[int]) -> None:
        """Take back the queries of a frame that broke off."""
        self._spare.extend(queries)

    def collect(self, wait: bool = False) -> None:
        """See which frames the GPU has finished; with ``wait``, it has finished all of them."""
        available = ctypes.c_int()
        while self._pending:
            frame = self._pending[0]
            if not wait:
                self._gl.glGetQueryObjectiv(
                    frame.queries[-1], c.QUERY_RESULT_AVAILABLE, ctypes.byref(available)
                )
                if not available.value:
                    return
            if self._finished is not None:
                self._spare.extend(self._finished.queries)
            self._finished = self._pending.pop(0)

    def _read(self) -> None:
        frame, self._finished = self._finished, None
        if frame is None:
            return
        value = ctypes.c_uint64()
        stamps = []
        for query in frame.queries:
            self._gl.glGetQueryObjectui64v(query, c.QUERY_RESULT, ctypes.byref(value))
            stamps.append(value.value)
        self._timings = [
            PassTiming(name, (stamps[i + 1] - stamps[i]) * 1e-6, frame.cpu_ms[i])
            for i, name in enumerate(frame.names)
        ]
        self._frame_ms = (stamps[-1] - stamps[0]) * 1e-6
        self._spare.extend(frame.queries)

    def release(self) -> None:
        """Delete every query."""
        if self._finished is not None:
            self._pending.append(self._finished)
            self._finished = None
        for frame in self._pending:
            self._spare.extend(frame.queries)
        self._pending.clear()
        for query in self._spare:
            self._gl.delete("Queries", query)
        self._spare.clear()
