"""A rendered frame on the window's framebuffer."""

from __future__ import annotations

from elemental.frame import Frame
from elemental.gpu.device import Device
from elemental.gpu.resources import Texture
from elemental.gpu.screen import Area
from elemental.gpu.shaders import Raster

LINEAR = Raster("ui/present.vert.glsl", "ui/present.frag.glsl")


def present(device: Device, frame: Frame, area: Area, onto: Texture | None = None) -> None:
    """Show ``frame`` in an area of the window, or of ``onto``, and leave its framebuffer bound.

    Display values are copied. Linear radiance is sRGB encoded, so the window shows what
    ``save_picture`` writes as PNG.
    """
    through = (LINEAR, "u_radiance") if frame.is_linear else None
    device.present(frame.image, area, through, onto)
