"""Uniform blocks of a frame: gathered on the CPU, uploaded once, bound by range."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from elemental.gpu import gl as c

if TYPE_CHECKING:
    from elemental.gpu.device import Device
    from elemental.gpu.resources import Buffer

_SEGMENTS = 3
"""Frames in flight, so that an upload never waits for a block still being read."""


class ParamRing:
    """One buffer of three segments; each frame fills the next one."""

    def __init__(self, device: Device) -> None:
        self._device = device
        self.alignment = device.gl.integer(c.UNIFORM_BUFFER_OFFSET_ALIGNMENT)
        self._capacity = 64 * 1024
        self._segment = 0
        self._chunks: list[bytes] = []
        self._offsets: dict[bytes, int] = {}
        self._places: dict[int, tuple[tuple[int, int], npt.NDArray[np.void]]] = {}
        self.used = 0
        """Bytes of the frame so far."""
        self._buffer: Buffer | None = None

    def add(self, values: npt.NDArray[np.void]) -> tuple[int, int]:
        """(offset in the frame's segment, bytes) of ``values``; equal bytes are stored once.

        An array that can't be written to, as `pack` makes them, is known by its identity.
        """
        met = self._places.get(id(values))
        if met is not None:
            return met[0]
        raw = values.tobytes()
        offset = self._offsets.get(raw)
        if offset is None:
            offset = self._offsets[raw] = self.used
            padding = -len(raw) % self.alignment
            self._chunks.append(raw + bytes(padding))
            self.used += len(raw) + padding
        place = offset, len(raw)
        if not values.flags.writeable:
            self._places[id(values)] = place, values
        return place

    def upload(self) -> tuple[int, int]:
        """Upload the frame's blocks. (GL buffer name, byte offset of the segment)."""
        if self._buffer is None or self.used > self._capacity:
            if self._buffer is not None:
                self._buffer.release()
            while self._capacity < self.used:
                self._capacity *= 2
            self._buffer = self._device.buffer("params", self._capacity * _SEGMENTS)
        self._segment = (self._segment + 1) % _SEGMENTS
        base = self._segment * self._capacity
        if self._chunks:
            self._buffer.mgl.write(b"".join(self._chunks), base)
        self.discard()
        return self._buffer.glo, base

    def discard(self) -> None:
        """Forget the blocks of the frame that was begun."""
        self._chunks.clear()
        self._offsets.clear()
        self._places.clear()
        self.used = 0

    def release(self) -> None:
        """Free the buffer."""
        if self._buffer is not None:
            self._buffer.release()
            self._buffer = None
