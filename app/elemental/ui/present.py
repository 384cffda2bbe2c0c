"""A rendered frame on the window's framebuffer."""

from __future__ import annotations

from elemental.frame import Frame
from elemental.gpu import gl as c
from elemental.gpu import state
from elemental.gpu.device import Device
from elemental.gpu.shaders import Raster

LINEAR = Raster("ui/present.vert.glsl", "ui/present.frag.glsl")


def present(device: Device, frame: Frame, size: tuple[int, int]) -> None:
    """Show ``frame`` in the window of ``size`` pixels and leave its framebuffer bound.

    Display values are copied. Linear radiance is sRGB encoded, so the window shows what
    ``save_picture`` writes as PNG.
    """
    if not frame.is_linear:
        device.present(frame.image, size)
        return
    gl, program = device.gl, device.program(LINEAR)
    unit = program.slots["u_radiance"].unit
    gl.glMemoryBarrier(c.TEXTURE_FETCH_BARRIER)
    gl.glBindFramebuffer(c.FRAMEBUFFER, 0)
    gl.glViewport(0, 0, *size)
    state.apply(gl, state.DEFAULT)
    gl.glActiveTexture(c.TEXTURE0 + unit)
    gl.glBindTexture(c.TEXTURE_2D, frame.image.glo)
    gl.glBindSampler(unit, 0)
    vertex_array = program.vertex_arrays.get(0)
    if vertex_array is None:
        vertex_array = program.vertex_arrays[0] = device.ctx.vertex_array(program.mgl, [])
    vertex_array.render(vertices=3)
