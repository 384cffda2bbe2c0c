"""What the panel costs: frames with and without it in turn, the picture of one size.

    python tools/panel_cost.py [SCENE] [--size 1280x720] [--frames 40]

For each page: milliseconds of Python for its widgets, of Python and the driver for all of the
panel, and their share of a frame. Medians; only frames of one run compare.
"""

from __future__ import annotations

import argparse
import statistics
import time

from elemental.flags import _size
from elemental.session import Viewpoint, headless_device, set_stage
from elemental.ui.desk import Words
from elemental.ui.headless import HeadlessDesk

WARM_UP = 8
"""Frames before the measured ones: pages settle, programs are compiled."""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("scene", nargs="?", default="atrium")
    parser.add_argument("--size", type=_size, default=(1280, 720), help="of the window, px")
    parser.add_argument("--frames", type=int, default=40, help="measured, a page")
    parser.add_argument("--set", dest="words", action="append", default=[])
    words = parser.parse_args()
    stage = set_stage(words.scene, words.words, Viewpoint(), words.size)
    screen = HeadlessDesk(headless_device(), stage, Words(words.scene, words.words), words.size)
    desk = screen.desk
    desk.clock.paused = True
    print("page        widgets ms  panel ms  frame ms  without ms  share %")
    for page in [page.name for page in desk.workspace.pages]:
        desk.workspace.bring_to_front(page)
        desk.shows_panel = True
        for _ in range(WARM_UP):
            screen.draw()
        size = desk.renderer.size
        widgets, panel, shown, hidden = [], [], [], []
        for _ in range(words.frames):
            desk.shows_panel = True
            began = time.perf_counter()
            screen.draw()
            desk.device.finish()
            shown.append(1e3 * (time.perf_counter() - began))
            widgets.append(desk.layout_ms)
            panel.append(desk.gui_ms)
            began = time.perf_counter()
            desk.renderer.resize(size)
            desk.renderer.render(desk.camera, 0.0, desk.drawn, desk.view)
            desk.device.finish()
            hidden.append(1e3 * (time.perf_counter() - began))
        medians = [statistics.median(times) for times in (widgets, panel, shown, hidden)]
        share = 100.0 * (medians[2] - medians[3]) / medians[2]
        print(f"{page:10}  {'  '.join(f'{ms:9.2f}' for ms in medians)}  {share:7.1f}")
    screen.release()


if __name__ == "__main__":
    main()
