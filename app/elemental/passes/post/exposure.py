"""Eye adaptation: how bright the picture is developed, found and kept on the GPU.

[Mittring12 "Histogram", "Eye Adaptation (Auto-Exposure)"]
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from elemental.core.layout import Block, layouts, pack
from elemental.gpu.device import Device
from elemental.gpu.formats import RGBA32F
from elemental.gpu.graph import Graph
from elemental.gpu.refs import AnyTexture, Ref, TextureHandle
from elemental.gpu.resources import Buffer
from elemental.gpu.shaders import Compute

HISTOGRAM = Compute("post/histogram.comp.glsl")
ADAPT = Compute("post/adapt.comp.glsl")

DARKEST = 1e-4
"""Least brightness that is adapted to, nit: exposure stays finite [inferred]."""
NARROWEST = 1e-3
"""Least share of the picture between the percentiles: the average stays defined [inferred]."""
SHORTEST_RANGE = 1.0
"""Least range of the histogram, EV [inferred]."""


@dataclass(frozen=True)
class Exposed:
    """What a pass over post/screen.vert.glsl needs to know the picture's exposure."""

    reads: dict[str, Ref]
    params: dict[str, Block]


class EyeAdaptation:
    """The eye's state on the device, a buffer ``Eye`` of glsl/shared/exposure.glsl.

    With equal bounds nothing is measured: the brightness is that bound.
    """

    def __init__(self, device: Device) -> None:
        self._eye = layouts().struct("Eye")
        self.state: Buffer = device.buffer("eye", self._eye.itemsize, category="other")
        self._fixed: float | None = None
        self._adapts = False

    @staticmethod
    def is_on(s: Mapping[str, Any]) -> bool:
        """Whether the picture is measured at all."""
        return bool(s["eye_adaptation.min_brightness"] < s["eye_adaptation.max_brightness"])

    def update(
        self, g: Graph, picture: AnyTexture | None, s: Mapping[str, Any], elapsed_s: float | None
    ) -> Exposed:
        """Measure ``picture`` and adapt to it. elapsed_s: since the frame before; None: a first
        frame, adapted at once. ``picture`` may be None where ``is_on`` is false."""
        picture = picture if self.is_on(s) else None
        starts = elapsed_s is None or not self._adapts
        block = exposure_block(s, elapsed_s or 0.0, starts)
        exposed = Exposed({"EyeState": self.state}, {"Exposure": block})
        self._adapts = picture is not None
        if picture is None:
            self._fix(float(block["min_brightness"]))
            return exposed
        self._fixed = None
        lines = histogram_lines(g, picture, block)
        g.compute(
            ADAPT,
            reads={"u_lines": lines},
            writes={"EyeState": self.state},
            params=exposed.params,
            groups=1,
        )
        return exposed

    def save(self) -> bytes:
        """The state, for ``restore``; waits for the GPU."""
        return bytes([self._adapts]) + self.state.read().tobytes()

    def restore(self, raw: bytes) -> None:
        """Go on from a saved state. Raises ValueError for bytes that are none."""
        if len(raw) != 1 + self._eye.itemsize:
            raise ValueError("not a state of the eye")
        self._adapts, self._fixed = bool(raw[0]), None
        self.state.write(raw[1:])

    def release(self) -> None:
        """Free the state."""
        self.state.release()

    def _fix(self, brightness: float) -> None:
        if brightness != self._fixed:
            self._fixed = brightness
            histogram = np.zeros((16, 4), np.float32)
            fixed = pack(self._eye, histogram=histogram, brightness=brightness, measured=brightness)
            self.state.write(fixed)


def histogram_lines(g: Graph, picture: AnyTexture, block: Block) -> TextureHandle:
    """A histogram of each tile of ``picture`` (H, W): one a line, 16 texels of four buckets."""
    tile = int(layouts().constant("HISTOGRAM_TILE"))
    columns, rows = (-(-extent // tile) for extent in picture.size[:2])
    texels = int(layouts().constant("HISTOGRAM_TEXELS"))
    lines = g.texture("histogram.lines", size=(texels, columns * rows), format=RGBA32F)
    g.compute(
        HISTOGRAM,
        reads={"u_picture": picture},
        writes={"o_lines": lines},
        params={"Exposure": block},
        groups=(columns, rows, 1),
    )
    return lines


def exposure_block(s: Mapping[str, Any], elapsed_s: float, starts: bool) -> Block:
    """The block Exposure, ``elapsed_s`` after the frame before; ``starts``: there is none."""
    low = min(s["eye_adaptation.low_percent"] / 100.0, 1.0 - NARROWEST)
    lowest = max(s["eye_adaptation.min_brightness"], DARKEST)
    log_range = s["eye_adaptation.log_max"] - s["eye_adaptation.log_min"]
    return pack(
        layouts().block("Exposure"),
        bias=2.0 ** s["exposure"],
        log_min=s["eye_adaptation.log_min"],
        log_range=max(log_range, SHORTEST_RANGE),
        low_share=low,
        high_share=max(s["eye_adaptation.high_percent"] / 100.0, low + NARROWEST),
        min_brightness=lowest,
        max_brightness=max(s["eye_adaptation.max_brightness"], lowest),
        keep_up=2.0 ** (-elapsed_s * s["eye_adaptation.speed_up"]),
        keep_down=2.0 ** (-elapsed_s * s["eye_adaptation.speed_down"]),
        starts=int(starts),
    )
