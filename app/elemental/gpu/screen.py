"""Bringing a texture onto the window's own framebuffer."""

from __future__ import annotations

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


def copy(device: Device, texture: Texture, size: tuple[int, int]) -> None:
    """Copy ``texture`` onto the window of ``size`` pixels, scaled where they differ."""
    gl = device.gl
    source = device.executor.framebuffers.get([(texture, 0, -1)], None, (0, 0))
    device.executor.barrier([(texture, c.FRAMEBUFFER_BARRIER, False)])
    gl.glDisable(c.SCISSOR_TEST)
    gl.glBindFramebuffer(c.READ_FRAMEBUFFER, source)
    gl.glBindFramebuffer(c.DRAW_FRAMEBUFFER, _WINDOW)
    extent = (0, 0, *texture.size[:2], 0, 0, *size)
    smooth = c.NEAREST if texture.size[:2] == size else c.LINEAR
    gl.glBlitFramebuffer(*extent, c.COLOR_BUFFER_BIT, smooth)
    gl.glBindFramebuffer(c.FRAMEBUFFER, _WINDOW)


def draw(
    device: Device, shader: Raster, name: str, texture: TextureRef, size: tuple[int, int]
) -> None:
    """Draw a full-screen triangle that reads ``texture`` as ``name``, and no other resource."""
    gl, executor = device.gl, device.executor
    program = device.program(shader)
    require_all(program, {n for n, slot in program.slots.items() if slot.active} - {name})
    bound = looks(program.slots[name], texture, program)
    executor.binder.forget()
    executor.barrier([(resource, look.barrier, False) for look, resource in bound])
    gl.glDisable(c.SCISSOR_TEST)
    gl.glBindFramebuffer(c.FRAMEBUFFER, _WINDOW)
    gl.glViewport(0, 0, *size)
    raster_state.apply(gl, raster_state.DEFAULT)
    binding = [(look, number) for number, (look, _) in enumerate(bound)]
    executor.binder.bind(binding, [resource for _, resource in bound])
    vertex_array = program.vertex_arrays.get(0)
    if vertex_array is None:
        vertex_array = program.vertex_arrays[0] = device.ctx.vertex_array(program.mgl, [])
    vertex_array.render(vertices=3)
    gl.glBindSampler(bound[0][0].unit, 0)
