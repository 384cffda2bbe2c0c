#!/usr/bin/env python3
"""Thousands of frames of changing settings, sizes and volumes: memory, messages, time.

    tools/endure.py [SCENE] [--frames 10000] [--warmup 2000] [--seed 0]

Prints resident memory and the device's own bytes as it goes. Exits 1 where memory grew by more than
5 MB after the warm-up, or the driver complained.
"""

from __future__ import annotations

import argparse
import sys
import time

from elemental.gpu.device import Device
from elemental.session import Viewpoint, set_stage
from endurance.storm import LARGEST, Storm, resident_bytes

ALLOWED_MB = 5.0
"""Growth after the warm-up that counts as flat."""
REPORTS = 20


def main() -> int:
    """Run and judge."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scene", nargs="?", default="cornell_box")
    parser.add_argument("--frames", type=int, default=10_000)
    parser.add_argument("--warmup", type=int, default=2_000)
    parser.add_argument("--seed", type=int, default=0)
    words = parser.parse_args()
    stage = set_stage(words.scene, ["gi.resolution=64"], Viewpoint(), LARGEST)
    device = Device.headless(debug=True)
    storm = Storm(device, stage, words.seed)
    began, settled = time.perf_counter(), 0.0
    step = max(words.frames // REPORTS, 1)
    for frame in storm.frames(words.frames):
        if frame + 1 == words.warmup:
            settled = resident_bytes() / 1e6
        if (frame + 1) % step == 0 or frame + 1 == words.warmup:
            held = sum(device.bytes().values()) / 1e6
            elapsed = time.perf_counter() - began
            line = f"{frame + 1:6d} frames {resident_bytes() / 1e6:8.1f} MB resident"
            print(f"{line} {held:7.1f} MB on the device {elapsed:7.0f} s", flush=True)
    grown = resident_bytes() / 1e6 - settled
    messages = device.messages
    storm.release()
    print(f"grown by {grown:.1f} MB after {words.warmup} frames; {len(messages)} messages")
    for message in messages[:5]:
        print(message)
    return int(grown > ALLOWED_MB or bool(messages))


if __name__ == "__main__":
    sys.exit(main())
