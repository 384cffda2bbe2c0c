"""What the driver says about itself."""

from __future__ import annotations

from dataclasses import dataclass

import moderngl

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
