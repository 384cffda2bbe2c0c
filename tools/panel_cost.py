"""What the panel costs beside a frame without it.

    python tools/panel_cost.py [SCENE] [--size 1280x720] [--frames 20] [--set KEY=VALUE]

A frame of the scene and the panel around it are measured in turn, so that what else a machine does
falls on both. For each page, medians in ms: Python for its widgets; all of the panel, drawn and
waited for; passes that the page adds to the frame; the frame itself, of a still scene, the cheapest
that there is; and the panel's share of the sum, with a verdict over all pages at the end.
"""

from __future__ import annotations

import argparse
import statistics
import time
from typing import NamedTuple

from elemental.flag_values import size
from elemental.session import Viewpoint, headless_device, set_stage
from elemental.ui.desk import Desk, Words
from elemental.ui.headless import HeadlessDesk

WARM_UP = 8
"""Frames before the measured ones: pages settle, programs are compiled."""
LIMIT = 20.0
"""Per cent of a frame that the panel may take."""


class Cost(NamedTuple):
    """Medians over frames, ms."""

    widgets: float
    panel: float
    passes: float
    frame: float

    @property
    def share(self) -> float:
        """The panel's part of all, in per cent."""
        own = self.panel + self.passes
        return 100.0 * own / (own + self.frame)


def cost_of(screen: HeadlessDesk, frames: int) -> Cost:
    """Of the pages that are in front: a frame, then the panel, and again."""
    desk = screen.desk
    samples = []
    for _ in range(frames):
        screen.draw()  # with what the pages ask of the frame
        desk.device.finish()
        passes = sum(t.gpu_ms for t in desk.device.timings if t.name.startswith("inspect"))
        frame = _frame_ms(desk)
        began = time.perf_counter()
        desk.tell(screen.size)
        desk.device.finish()
        samples.append((desk.layout_ms, 1e3 * (time.perf_counter() - began), passes, frame))
    return Cost(*(statistics.median(column) for column in zip(*samples, strict=True)))


def _frame_ms(desk: Desk) -> float:
    """A frame of the scene alone, done."""
    looker, desk.renderer.looker = desk.renderer.looker, None
    began = time.perf_counter()
    desk.renderer.render(desk.camera, desk.clock.time_s, desk.drawn, desk.view)
    desk.device.finish()
    desk.renderer.looker = looker
    return 1e3 * (time.perf_counter() - began)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("scene", nargs="?", default="atrium")
    parser.add_argument("--size", type=size, default=(1280, 720), help="of the window, px")
    parser.add_argument("--frames", type=int, default=20, help="measured, a page")
    parser.add_argument("--set", dest="words", action="append", default=[])
    words = parser.parse_args()
    stage = set_stage(words.scene, words.words, Viewpoint(), words.size)
    screen = HeadlessDesk(headless_device(), stage, Words(words.scene, words.words), words.size)
    desk = screen.desk
    desk.clock.paused = True
    print("page         widgets    panel   passes    frame  share %")
    costs = []
    for page in [page.name for page in desk.workspace.pages]:
        desk.workspace.bring_to_front(page)
        for _ in range(WARM_UP):
            screen.draw()
        cost = cost_of(screen, words.frames)
        costs.append(cost)
        row = "  ".join(f"{ms:7.2f}" for ms in cost)
        print(f"{page:10}  {row}  {cost.share:7.1f}")
    shares = [cost.share for cost in costs]
    verdict = "within" if max(shares) <= LIMIT else "OVER"
    print(f"share of a frame: median {statistics.median(shares):.1f} %, most {max(shares):.1f} %, "
          f"{verdict} the limit of {LIMIT:g} %")  # fmt: skip
    screen.release()


if __name__ == "__main__":
    main()
