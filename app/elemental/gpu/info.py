"""What the driver says about itself."""

from __future__ import annotations

from dataclasses import dataclass

import moderngl

from elemental.gpu import gl as c

SOFTWARE_RENDERERS = ("llvmpipe", "softpipe", "swrast")
"""Words in the names of Mesa's drivers that draw on the CPU."""


@dataclass(frozen=True, slots=True)
class DeviceInfo:
    """The driver's own words; ``software``: it draws on the CPU."""

    renderer: str
    version: str
    vendor: str
    software: bool

    @classmethod
    def of(cls, ctx: moderngl.Context) -> DeviceInfo:
        """Ask the context."""
        info = ctx.info
        renderer = str(info["GL_RENDERER"])
        software = any(word in renderer.lower() for word in SOFTWARE_RENDERERS)
        return cls(renderer, str(info["GL_VERSION"]), str(info["GL_VENDOR"]), software)


OUTPUT_RESOURCES = 10
"""Storage blocks, images and targets of the program that has most of them together: the leaves'
compression. GL 4.3 guarantees 8, hardware has more [inferred: 64 since Direct3D 11.1]; in all else
programs keep to what GL guarantees."""


def check_limits(gl: c.GL) -> None:
    """Raise RuntimeError where the driver has less than the programs need."""
    has = gl.integer(c.MAX_COMBINED_SHADER_OUTPUT_RESOURCES)
    if has < OUTPUT_RESOURCES:
        raise RuntimeError(
            f"this OpenGL driver lets a program have {has} storage blocks and images together "
            f"(GL_MAX_COMBINED_SHADER_OUTPUT_RESOURCES); {OUTPUT_RESOURCES} are needed"
        )
