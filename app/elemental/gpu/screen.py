"""Bringing a texture onto the window's own framebuffer, or onto a texture that stands for it."""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING

from elemental.gpu import gl as c
from elemental.gpu import state as raster_state
from elemental.gpu.binding import looks, require_all
from elemental.gpu.refs import TextureRef
from elemental.gpu.resources import Texture
from elemental.gpu.shaders import Raster

if TYPE_CHECKING:
    from elemental.gpu.device import Device

_WINDOW = 0
"""GL name of the window's framebuffer."""


Area = tuple[int, int, int, int]
"""(x, y, width, height) in pixels from the bottom left corner."""


def bind(device: Device, onto: Texture | None) -> None:
    """Make ``onto`` (None: the window) what draws outside of graphs go to."""
    device.gl.glBindFramebuffer(c.FRAMEBUFFER, _framebuffer(device, onto))


def clear(device: Device, onto: Texture | None, color: tuple[float, float, float]) -> None:
    """Fill ``onto`` (None: the window) with an opaque ``color``."""
    gl = device.gl
    bind(device, onto)
    gl.glDisable(c.SCISSOR_TEST)
    raster_state.prepare_clear(gl)
    gl.glClearBufferfv(c.COLOR, 0, (ctypes.c_float * 4)(*color, 1.0))


def copy(device: Device, texture: Texture, area: Area, onto: Texture | None = None) -> None:
    """Copy ``texture`` into ``area`` of ``onto`` (None: the window), scaled where they differ."""
    gl = device.gl
    source = device.executor.framebuffers.get([(texture, 0, -1)], None, (0, 0))
    device.executor.barrier([(texture, c.FRAMEBUFFER_BARRIER, False)])
    gl.glDisable(c.SCISSOR_TEST)
    target = _framebuffer(device, onto)
    gl.glBindFramebuffer(c.READ_FRAMEBUFFER, source)
    gl.glBindFramebuffer(c.DRAW_FRAMEBUFFER, target)
    x, y, width, height = area
    extent = (0, 0, *texture.size[:2], x, y, x + width, y + height)
    smooth = c.NEAREST if texture.size[:2] == (width, height) else c.LINEAR
    gl.glBlitFramebuffer(*extent, c.COLOR_BUFFER_BIT, smooth)
    gl.glBindFramebuffer(c.FRAMEBUFFER, target)


def draw(
    device: Device,
    shader: Raster,
    name: str,
    texture: TextureRef,
    area: Area,
    onto: Texture | None = None,
) -> None:
    """Draw over ``area`` by a program that reads ``texture`` as ``name``, and nothing else.

    The shader's ``gl_FragCoord`` counts from the corner of ``onto`` (None: the window).
    """
    gl, executor = device.gl, device.executor
    program = device.program(shader)
    require_all(program, {n for n, slot in program.slots.items() if slot.active} - {name})
    bound = looks(program.slots[name], texture, program)
    executor.binder.forget()
    executor.barrier([(resource, look.barrier, False) for look, resource in bound])
    gl.glDisable(c.SCISSOR_TEST)
    bind(device, onto)
    gl.glViewport(*area)
    raster_state.apply(gl, raster_state.DEFAULT)
    executor.binder.bind(executor.binder.prepare(bound))
    vertex_array = program.vertex_arrays.get(0)
    if vertex_array is None:
        vertex_array = program.vertex_arrays[0] = device.ctx.vertex_array(program.mgl, [])
    vertex_array.render(vertices=3)
    gl.glBindSampler(bound[0][0].unit, 0)


def _framebuffer(device: Device, onto: Texture | None) -> int:
    if onto is None:
        return _WINDOW
    return device.executor.framebuffers.get([(onto, 0, -1)], None, (0, 0))
