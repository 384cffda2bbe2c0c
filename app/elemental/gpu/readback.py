"""Buffers on their way to the CPU: copied on the GPU, read frames later when a fence has passed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from elemental.gpu import gl as c

if TYPE_CHECKING:
    from elemental.gpu.device import Device
    from elemental.gpu.resources import Buffer

MIN_FRAMES = 2
"""Frames between a request and its arrival at the least."""


@dataclass(slots=True)
class _Pending:
    staging: Buffer
    callback: Callable[[bytes], None]
    fence: int
    frame: int


class ReadbackQueue:
    """Requests in flight, oldest first."""

    def __init__(self, device: Device) -> None:
        self._device = device
        self._pending: list[_Pending] = []
        self._spare: dict[int, list[Buffer]] = {}

    def request(self, source: Buffer, callback: Callable[[bytes], None], frame: int) -> None:
        """Copy ``source`` now and hand its bytes to ``callback`` later."""
        gl = self._device.gl
        spare = self._spare.get(source.nbytes)
        staging = spare.pop() if spare else self._device.buffer("read-back", source.nbytes)
        gl.glBindBuffer(c.COPY_READ_BUFFER, source.glo)
        gl.glBindBuffer(c.COPY_WRITE_BUFFER, staging.glo)
        gl.glCopyBufferSubData(c.COPY_READ_BUFFER, c.COPY_WRITE_BUFFER, 0, 0, source.nbytes)
        fence = gl.glFenceSync(c.SYNC_GPU_COMMANDS_COMPLETE, 0)
        self._pending.append(_Pending(staging, callback, fence, frame))

    def poll(self, frame: int, wait: bool = False) -> None:
        """Deliver what has arrived; with ``wait``, everything."""
        gl = self._device.gl
        if wait:
            gl.glFinish()
        while self._pending:
            head = self._pending[0]
            if not wait:
                if frame - head.frame < MIN_FRAMES:
                    return
                state = gl.glClientWaitSync(head.fence, 0, 0)
                if state not in (c.ALREADY_SIGNALED, c.CONDITION_SATISFIED):
                    return
            self._pending.pop(0)
            gl.glDeleteSync(head.fence)
            received = head.staging.mgl.read()
            self._spare.setdefault(head.staging.nbytes, []).append(head.staging)
            head.callback(received)

    def release(self) -> None:
        """Drop what is in flight and free the staging buffers."""
        for item in self._pending:
            self._device.gl.glDeleteSync(item.fence)
            item.staging.release()
        for buffers in self._spare.values():
            for buffer in buffers:
                buffer.release()
        self._pending.clear()
        self._spare.clear()
