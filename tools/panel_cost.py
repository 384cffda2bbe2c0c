"""What the panel costs beside a frame without it.

    python tools/panel_cost.py [SCENE] [--size 1280x720] [--frames 40] [--set KEY=VALUE]

For each page, medians in ms: Python for its widgets; all of the panel, drawn and waited for; passes
that the page adds to the frame; the frame itself; and the panel's share of the sum.
"""

from __future__ import annotations

import argparse
import statistics
import time

from elemental.flag_values import size
from elemental.session import Viewpoint, headless_device, set_stage
from elemental.ui.desk import Desk, Words
from elemental.ui.headless import HeadlessDesk

WARM_UP = 8
"""Frames before the measured ones: pages settle, programs are compiled."""


def frame_ms(desk: Desk) -> float:
    """A frame of the scene alone, done."""
    desk.renderer.looker = None
    began = time.perf_counter()
    desk.renderer.render(desk.camera, 0.0, desk.drawn, desk.view)
    desk.device.finish()
    return 1e3 * (time.perf_counter() - began)


def panel_ms(screen: HeadlessDesk, frames: int) -> tuple[float, float]:
    """(its widgets, all of it), with the picture of before."""
    desk = screen.desk
    drawn, render = desk.frame, desk.renderer.render
    desk.renderer.render = lambda *_: drawn  # type: ignore[assignment,method-assign]
    widgets, panel = [], []
    for _ in range(frames):
        began = time.perf_counter()
        screen.draw()
        desk.device.finish()
        panel.append(1e3 * (time.perf_counter() - began))
        widgets.append(desk.layout_ms)
    desk.renderer.render = render  # type: ignore[method-assign]
    return statistics.median(widgets), statistics.median(panel)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("scene", nargs="?", default="atrium")
    parser.add_argument("--size", type=size, default=(1280, 720), help="of the window, px")
    parser.add_argument("--frames", type=int, default=40, help="measured, a page")
    parser.add_argument("--set", dest="words", action="append", default=[])
    words = parser.parse_args()
    stage = set_stage(words.scene, words.words, Viewpoint(), words.size)
    screen = HeadlessDesk(headless_device(), stage, Words(words.scene, words.words), words.size)
    desk = screen.desk
    desk.clock.paused = True
    print("page         widgets    panel   passes    frame  share %")
    for page in [page.name for page in desk.workspace.pages]:
        desk.workspace.bring_to_front(page)
        for _ in range(WARM_UP):
            screen.draw()
        desk.device.finish()
        passes = sum(t.gpu_ms for t in desk.device.timings if t.name.startswith("inspect"))
        frame = statistics.median(frame_ms(desk) for _ in range(words.frames))
        widgets, panel = panel_ms(screen, words.frames)
        share = 100.0 * (panel + passes) / (panel + passes + frame)
        row = "  ".join(f"{ms:7.2f}" for ms in (widgets, panel, passes, frame))
        print(f"{page:10}  {row}  {share:7.1f}")
    screen.release()


if __name__ == "__main__":
    main()
