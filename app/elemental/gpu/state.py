"""Fixed-function state of a raster pass."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from elemental.gpu import gl as c

_COMPARE = {
    "never": c.NEVER, "less": c.LESS, "equal": c.EQUAL, "lequal": c.LEQUAL, "greater": c.GREATER,
    "notequal": c.NOTEQUAL, "gequal": c.GEQUAL, "always": c.ALWAYS,
}  # fmt: skip
_STENCIL_OPS = {
    "keep": c.KEEP, "zero": c.ZERO, "replace": c.REPLACE, "incr": c.INCR, "decr": c.DECR,
    "invert": c.INVERT,
}  # fmt: skip
_FACES = {"back": c.BACK, "front": c.FRONT}
_BLENDS = {
    # colour source, colour destination, alpha source, alpha destination
    "add": (c.ONE, c.ONE, c.ONE, c.ONE),
    "alpha": (c.SRC_ALPHA, c.ONE_MINUS_SRC_ALPHA, c.ONE, c.ONE_MINUS_SRC_ALPHA),
    "premultiplied": (c.ONE, c.ONE_MINUS_SRC_ALPHA, c.ONE, c.ONE_MINUS_SRC_ALPHA),
}


ColorMask: TypeAlias = tuple[bool, bool, bool, bool]


@dataclass(frozen=True, slots=True)
class Stencil:
    """Stencil test, the same for both faces."""

    test: str = "always"
    reference: int = 0
    read_mask: int = 0xFF
    write_mask: int = 0xFF
    fail: str = "keep"
    depth_fail: str = "keep"
    on_pass: str = "keep"

    @property
    def writes(self) -> bool:
        """Whether it may change the stencil buffer."""
        kept = self.fail == self.depth_fail == self.on_pass == "keep"
        return self.write_mask != 0 and not kept


@dataclass(frozen=True, slots=True, eq=False)
class RasterState:
    """State of a raster pass; make it a module constant: it is known by its identity."""

    cull: str = "none"
    """back, front or none; counter-clockwise triangles face front."""
    depth_test: str = "none"
    """none, or the comparison that a fragment must pass: less, lequal, equal, always, …"""
    depth_write: bool = True
    """Written only where ``depth_test`` is not none."""
    blend: str | tuple[str | None, ...] | None = None
    """None, add, alpha or premultiplied; a tuple holds one for each colour target."""
    stencil: Stencil | None = None
    color_mask: ColorMask | tuple[ColorMask, ...] = (True, True, True, True)
    """Channels written; a tuple of masks holds one for each colour target."""
    polygon_offset: tuple[float, float] | None = None
    """(slope factor, constant units)."""
    depth_clamp: bool = False
    """Near and far plane cut nothing off; what lies beyond them has their depth."""

    def __post_init__(self) -> None:
        if self.cull not in (*_FACES, "none"):
            raise ValueError(f"cull {self.cull!r}")
        if self.depth_test not in (*_COMPARE, "none"):
            raise ValueError(f"depth_test {self.depth_test!r}")
        blends = self.blend if isinstance(self.blend, tuple) else (self.blend,)
        if any(blend is not None and blend not in _BLENDS for blend in blends):
            raise ValueError(f"blend {self.blend!r}")
        if self.stencil:
            operations = (self.stencil.fail, self.stencil.depth_fail, self.stencil.on_pass)
            if self.stencil.test not in _COMPARE or any(o not in _STENCIL_OPS for o in operations):
                raise ValueError(f"stencil {self.stencil}")


DEFAULT = RasterState()
SCENE = RasterState(cull="back", depth_test="lequal")


def apply(gl: c.GL, state: RasterState, before: RasterState | None = None) -> None:
    """Set every piece of state in which ``state`` differs from ``before`` (None: unknown)."""
    if before is None or state.cull != before.cull:
        _switch(gl, c.CULL_FACE, state.cull != "none")
        if state.cull != "none":
            gl.glCullFace(_FACES[state.cull])
    if before is None or (state.depth_test, state.depth_write) != (
        before.depth_test, before.depth_write,
    ):  # fmt: skip
        depth = state.depth_test != "none"
        _switch(gl, c.DEPTH_TEST, depth)
        if depth:
            gl.glDepthFunc(_COMPARE[state.depth_test])
        gl.glDepthMask(state.depth_write and depth)
    if before is None or state.depth_clamp != before.depth_clamp:
        _switch(gl, c.DEPTH_CLAMP, state.depth_clamp)
    if before is None or state.blend != before.blend:
        _apply_blend(gl, state.blend)
    if before is None or state.stencil != before.stencil:
        _apply_stencil(gl, state.stencil)
    if before is None or state.color_mask != before.color_mask:
        _apply_color_mask(gl, state.color_mask)
    if before is None or state.polygon_offset != before.polygon_offset:
        _switch(gl, c.POLYGON_OFFSET_FILL, state.polygon_offset is not None)
        if state.polygon_offset is not None:
            gl.glPolygonOffset(*state.polygon_offset)


def prepare_clear(gl: c.GL) -> None:
    """Open every write mask, which clears obey."""
    gl.glColorMask(True, True, True, True)
    gl.glDepthMask(True)
    gl.glStencilMask(0xFF)


def _apply_blend(gl: c.GL, blend: str | tuple[str | None, ...] | None) -> None:
    if isinstance(blend, tuple):
        gl.glDisable(c.BLEND)
        for target, mode in enumerate(blend):
            if mode is not None:
                gl.glEnablei(c.BLEND, target)
                gl.glBlendFuncSeparatei(target, *_BLENDS[mode])
        return
    _switch(gl, c.BLEND, blend is not None)
    if blend is not None:
        gl.glBlendFuncSeparate(*_BLENDS[blend])


def _apply_stencil(gl: c.GL, stencil: Stencil | None) -> None:
    _switch(gl, c.STENCIL_TEST, stencil is not None)
    if stencil is not None:
        gl.glStencilFunc(_COMPARE[stencil.test], stencil.reference, stencil.read_mask)
        gl.glStencilOp(
            _STENCIL_OPS[stencil.fail],
            _STENCIL_OPS[stencil.depth_fail],
            _STENCIL_OPS[stencil.on_pass],
        )
        gl.glStencilMask(stencil.write_mask)


def _apply_color_mask(gl: c.GL, color_mask: ColorMask | tuple[ColorMask, ...]) -> None:
    if isinstance(color_mask[0], tuple):
        for target, mask in enumerate(color_mask):
            gl.glColorMaski(target, *mask)
    else:
        gl.glColorMask(*color_mask)


def _switch(gl: c.GL, capability: int, on: bool) -> None:
    if on:
        gl.glEnable(capability)
    else:
        gl.glDisable(capability)
