"""What the post-processing effects keep from frame to frame, and what they load."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from elemental.core.layout import Block, layouts
from elemental.gpu.device import Device
from elemental.passes.post.exposure import EyeAdaptation
from elemental.passes.post.lens_flare import Quad, SpriteCounters
from elemental.passes.post.textures import PostTextures

HERE = Path()
MASKS = ("bloom.dirt_mask", "lens_flare.bokeh_shape")
"""Settings that name an image."""
LONGEST_STEP_S = 1.0
"""More scene time than this between two frames is a cut, s [inferred]: nothing is blended over."""


class PostHistory:
    """State of the effects of one renderer."""

    def __init__(self, device: Device, settings: Mapping[str, Any], folder: Path = HERE) -> None:
        """``folder``: what names in settings count from. Raises InputError for a texture that
        ``settings`` name and that can't be loaded."""
        self.eye = EyeAdaptation(device)
        self.textures = PostTextures(device, folder)
        self.quad = Quad(device)
        self.sprites = SpriteCounters()
        self.view_before: Block | None = None
        """The block View of the frame before; None for the first one and after a cut."""
        self.elapsed_s: float | None = None
        """Scene time since that frame; None where there is none."""
        self._last_view: Block | None = None
        self.textures.lut(settings["color_grading.lut"])
        for key in MASKS:
            self.textures.mask(key, settings[key])
        for problem in self.textures.problems.values():
            self.release()
            raise problem

    def advance(self, view: Block) -> None:
        """Begin a frame as seen by ``view``."""
        before = self._last_view
        self._last_view = view
        self.view_before = self.elapsed_s = None
        if before is not None:
            elapsed_s = float(view["time_s"]) - float(before["time_s"])
            if 0.0 <= elapsed_s <= LONGEST_STEP_S:
                self.view_before, self.elapsed_s = before, elapsed_s

    def save(self) -> bytes:
        """What later frames depend on; waits for the GPU."""
        if self._last_view is None:  # no effect has run
            return b""
        return self.eye.save() + self._last_view.tobytes()

    def restore(self, raw: bytes) -> None:
        """Go on as after the frame at whose end ``raw`` was saved. Raises ValueError."""
        if not raw:
            return
        view = layouts().block("View")
        at = len(raw) - view.itemsize
        self.eye.restore(raw[: max(at, 0)])
        self._last_view = np.frombuffer(raw, view, offset=at)[0]

    def problems(self) -> list[str]:
        """Textures that a frame's settings named and that could not be loaded, a line each."""
        return [str(problem) for problem in self.textures.problems.values()]

    def release(self) -> None:
        """Free everything on the device."""
        self.eye.release()
        self.textures.release()
        self.quad.release()
