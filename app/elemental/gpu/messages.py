"""The driver's debug messages (KHR_debug), kept for the report and fatal in tests."""

from __future__ import annotations

import ctypes
from collections import deque
from typing import Any, NamedTuple

from elemental.gpu import gl as c

_SEVERITIES = {
    c.DEBUG_SEVERITY_HIGH: "high",
    c.DEBUG_SEVERITY_MEDIUM: "medium",
    c.DEBUG_SEVERITY_LOW: "low",
}
_KEPT = 256


class GlError(RuntimeError):
    """A GL error or a high severity message of the driver."""


class Message(NamedTuple):
    """One debug message."""

    severity: str
    """high, medium or low."""
    is_error: bool
    is_performance: bool
    """Advice about speed."""
    text: str

    def __str__(self) -> str:
        return f"{'error' if self.is_error else self.severity}: {self.text}"


class Messages:
    """Receives what the driver says, in the call that caused it."""

    def __init__(self, gl: c.GL) -> None:
        self._gl = gl
        self.messages: deque[Message] = deque(maxlen=_KEPT)
        self._unchecked: list[Message] = []
        self._callback = c.DEBUG_CALLBACK(self._receive)
        gl.glEnable(c.DEBUG_OUTPUT)
        gl.glEnable(c.DEBUG_OUTPUT_SYNCHRONOUS)
        gl.glDebugMessageControl(c.DONT_CARE, c.DONT_CARE, c.DONT_CARE, 0, None, True)
        quiet = c.DEBUG_SEVERITY_NOTIFICATION
        gl.glDebugMessageControl(c.DONT_CARE, c.DONT_CARE, quiet, 0, None, False)
        gl.glDebugMessageCallback(self._callback, None)

    def _receive(
        self, source: int, kind: int, _id: int, severity: int, length: int, text: Any, _user: Any
    ) -> None:
        compiler_error = source == c.DEBUG_SOURCE_SHADER_COMPILER and kind == c.DEBUG_TYPE_ERROR
        if severity not in _SEVERITIES or compiler_error:  # those are raised as ShaderError
            return
        words = ctypes.string_at(text, length if length >= 0 else -1).decode("utf-8", "replace")
        message = Message(
            _SEVERITIES[severity],
            kind == c.DEBUG_TYPE_ERROR,
            kind == c.DEBUG_TYPE_PERFORMANCE,
            words.strip(),
        )
        self.messages.append(message)
        if message.is_error or severity == c.DEBUG_SEVERITY_HIGH:
            self._unchecked.append(message)

    def check(self) -> None:
        """Raise GlError for the errors since the last check."""
        error = self._gl.glGetError()
        if self._unchecked or error:
            text = "; ".join(str(message) for message in self._unchecked)
            self._unchecked.clear()
            raise GlError(text or f"GL error 0x{error:X}")

    def drop_out_of_memory(self) -> None:
        """Forget the message of a failed allocation, which is reported as an exception."""
        for kept in (self._unchecked, self.messages):
            for message in [m for m in kept if "OUT_OF_MEMORY" in m.text]:
                kept.remove(message)

    def release(self) -> None:
        """Stop receiving."""
        self._gl.glDebugMessageCallback(c.DEBUG_CALLBACK(), None)
