"""Framebuffers by what they hold, made on first use and dropped with their textures."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence

from elemental.gpu import gl as c
from elemental.gpu.resources import Texture

Attached = tuple[Texture, int, int]
"""(texture, level, layer or -1 for all)."""
_Key = tuple[tuple[int, ...], ...]
_DEPTH, _SIZE = -1, -2
"""First numbers of a key's parts that are no colour attachments; serials are positive."""


class Framebuffers:
    """Cache of framebuffer objects."""

    def __init__(self, gl: c.GL) -> None:
        self._gl = gl
        self._made: dict[_Key, int] = {}
        self._holders: dict[int, set[_Key]] = {}

    def get(self, color: Sequence[Attached], depth: Attached | None, size: tuple[int, int]) -> int:
        """GL name of the framebuffer; ``size`` counts where nothing is attached.

        Raises RuntimeError for a combination that the driver can't render to.
        """
        key: _Key = tuple((t.serial, level, layer) for t, level, layer in color)
        if depth is not None:
            key = (*key, (_DEPTH, depth[0].serial, depth[1], depth[2]))
        elif not color:
            key = ((_SIZE, *size),)
        glo = self._made.get(key)
        if glo is None:
            glo = self._make(color, depth, size)
            self._made[key] = glo
            for texture, _, _ in (*color, *((depth,) if depth else ())):
                self._holders.setdefault(texture.serial, set()).add(key)
        return glo

    def _make(
        self, color: Sequence[Attached], depth: Attached | None, size: tuple[int, int]
    ) -> int:
        gl = self._gl
        glo = gl.generate("Framebuffers")
        gl.glBindFramebuffer(c.FRAMEBUFFER, glo)
        for number, attached in enumerate(color):
            self._attach(c.COLOR_ATTACHMENT0 + number, attached)
        if depth is not None:
            stencil = depth[0].format.kind == "depth_stencil"
            self._attach(c.DEPTH_STENCIL_ATTACHMENT if stencil else c.DEPTH_ATTACHMENT, depth)
        if not color and depth is None:
            gl.glFramebufferParameteri(c.FRAMEBUFFER, c.FRAMEBUFFER_DEFAULT_WIDTH, size[0])
            gl.glFramebufferParameteri(c.FRAMEBUFFER, c.FRAMEBUFFER_DEFAULT_HEIGHT, size[1])
        buffers = [c.COLOR_ATTACHMENT0 + number for number in range(len(color))] or [0]
        gl.glDrawBuffers(len(buffers), (ctypes.c_uint * len(buffers))(*buffers))
        status = gl.glCheckFramebufferStatus(c.FRAMEBUFFER)
        if status != c.FRAMEBUFFER_COMPLETE:
            gl.delete("Framebuffers", glo)
            names = ", ".join(f"{t.name} ({t.format})" for t, _, _ in color)
            raise RuntimeError(f"framebuffer of {names} is incomplete: 0x{status:X}")
        gl.label(c.LABEL_FRAMEBUFFER, glo, "+".join(t.name for t, _, _ in color) or "targetless")
        return glo

    def _attach(self, point: int, attached: Attached) -> None:
        texture, level, layer = attached
        gl = self._gl
        if layer < 0:
            gl.glFramebufferTexture(c.FRAMEBUFFER, point, texture.glo, level)
        elif texture.target == c.TEXTURE_CUBE_MAP:
            face = c.TEXTURE_CUBE_MAP_POSITIVE_X + layer
            gl.glFramebufferTexture2D(c.FRAMEBUFFER, point, face, texture.glo, level)
        elif texture.target == c.TEXTURE_2D:
            gl.glFramebufferTexture(c.FRAMEBUFFER, point, texture.glo, level)
        else:
            gl.glFramebufferTextureLayer(c.FRAMEBUFFER, point, texture.glo, level, layer)

    def __len__(self) -> int:
        return len(self._made)

    def forget(self, serial: int) -> None:
        """Delete the framebuffers that hold the texture of ``serial``."""
        for key in self._holders.pop(serial, ()):
            self._gl.delete("Framebuffers", self._made.pop(key))
            for part in key:
                holder = part[1] if part[0] == _DEPTH else part[0]
                if holder != serial:
                    self._holders[holder].discard(key)

    def release(self) -> None:
        """Delete every framebuffer."""
        for glo in self._made.values():
            self._gl.delete("Framebuffers", glo)
        self._made.clear()
        self._holders.clear()
