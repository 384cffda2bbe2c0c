"""What pages want to know of the frame itself: its graph, a target, the eye. Asked for each frame.

What no page asked for is neither run nor read.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from elemental.core.layout import layouts
from elemental.frame import Renderer
from elemental.gpu.device import Device
from elemental.gpu.graph import Graph
from elemental.gpu.graph_report import GraphReport
from elemental.gpu.resources import Buffer
from elemental.passes.inspect import Inspector, PixelProbe

REPORT_FRAMES = 15
"""The graph is described once in so many frames."""
FIRST_FRAMES = 4
"""Before, in each: the first graphs build the octree, and times are known two frames later."""
PIXEL_TARGETS = ("scene_color", "diffuse_gi", "specular_gi")
"""Asked by the pixel inspector, besides the picture itself."""
EYE = "eye"
"""Name of the buffer that holds the eye's state (passes/post/exposure.py)."""


@dataclass(frozen=True)
class EyeReading:
    """The eye, a few frames ago: shares of the picture by bucket, and what it is adapted to."""

    histogram: npt.NDArray[np.float32]
    """(64,), sums to 1; all 0 where adaptation is off."""
    brightness: float
    measured: float


class Observers:
    """Asked by pages while they are drawn, active in the frame that follows."""

    def __init__(self, device: Device) -> None:
        self.device = device
        self.inspector = Inspector(device)
        self.pixel = PixelProbe(device, PIXEL_TARGETS)
        self.eye: EyeReading | None = None
        self.report: GraphReport | None = None
        self._looks = False
        """Whether a page looked at a target of the last frame."""
        self._wants: set[str] = set()
        self._asked_frames = 0
        """For how many frames in a row the report has been wanted."""

    def want(self, what: str) -> None:
        """Have the "report", "buffer", "eye", "pixel", "volumes" or "regions" with this frame."""
        self._wants.add(what)

    def wants(self, what: str) -> bool:
        """Whether a page asked for it in this frame."""
        return what in self._wants

    def before_frame(self, renderer: Renderer) -> None:
        """Arrange for what is wanted."""
        active = self._wants & {"buffer", "eye", "pixel"}
        renderer.looker = self._add if active else None
        if "report" not in self._wants:
            self.report, self._asked_frames = None, 0
            return
        if self._asked_frames < FIRST_FRAMES or self._asked_frames % REPORT_FRAMES == 0:
            self.device.report_next_frame()
        self._asked_frames += 1

    def after_frame(self) -> None:
        """Take what arrived."""
        if "buffer" in self._wants:
            self.inspector.after_frame()
        newest = self.device.graph_report
        if "report" in self._wants and newest is not None:
            known = self.report is not None and self.report.frame == newest.frame
            if not known or self._asked_frames % REPORT_FRAMES == FIRST_FRAMES:
                self.report = newest.with_timings(self.device.timings)
        self._looks = "buffer" in self._wants
        self._wants.clear()

    @property
    def lacks_picture(self) -> bool:
        """Whether a page looks at a target whose picture is not there in the size of its place."""
        inspector, picture = self.inspector, self.inspector.picture
        return self._looks and (
            inspector.look is None or picture is None or picture.size != inspector.size
        )

    def catch_up(self) -> None:
        """Take what arrived since, once the GPU is done."""
        if self.report is not None:
            self.report = self.report.with_timings(self.device.timings)

    def release(self) -> None:
        """Free everything on the device."""
        self.inspector.release()
        self.pixel.release()

    def _add(self, g: Graph) -> None:
        if "buffer" in self._wants:
            self.inspector.add(g)
        if "pixel" in self._wants:
            self.pixel.add(g)
        if "eye" in self._wants:
            buffers = (item for item in g.resources() if isinstance(item, Buffer))
            state = next((buffer for buffer in buffers if buffer.name == EYE), None)
            if state is None:
                self.eye = None
            else:
                g.read_later(state, self._take_eye)

    def _take_eye(self, raw: bytes) -> None:
        eye = np.frombuffer(raw, layouts().struct("Eye"))[0]
        histogram = np.array(eye["histogram"], np.float32).reshape(-1)
        self.eye = EyeReading(histogram, float(eye["brightness"]), float(eye["measured"]))
