#!/usr/bin/env python3
"""Thousands of frames of changing settings, sizes and volumes: memory, messages, time.

    tools/endure.py [SCENE] [--frames 2000] [--rounds 5] [--seed 0]

Each round draws the same storm of frames. The first warms up: it meets each combination of shaders
and sizes for the first time, which the driver keeps. Prints resident memory and the device's own
bytes as it goes. Exits 1 where memory grew by more than 5 MB after the first round, or the driver
complained.
"""

from __future__ import annotations

import argparse
import sys
import time

from elemental.gpu.device import Device
from elemental.session import Viewpoint, set_stage
from endurance.storm import LARGEST, Storm, resident_bytes

ALLOWED_MB = 5.0
"""Growth after the first round that counts as flat."""
REPORTS = 4
"""Lines a round."""


def main() -> int:
    """Run and judge."""
    parser = argparse.ArgumentParser(description="Memory over thousands of frames of changes.")
    parser.add_argument("scene", nargs="?", default="cornell_box")
    parser.add_argument("--frames", type=int, default=2_000)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--seed", type=int, default=0)
    words = parser.parse_args()
    stage = set_stage(words.scene, ["gi.resolution=64"], Viewpoint(), LARGEST)
    device = Device.headless(debug=True)
    storm = Storm(device, stage, words.seed)
    began, resident = time.perf_counter(), []
    for number in range(words.rounds):
        for frame in storm.frames(words.frames):
            if (frame + 1) % max(words.frames // REPORTS, 1) == 0:
                held = sum(device.bytes().values()) / 1e6
                done = number * words.frames + frame + 1
                line = f"{done:6d} frames {resident_bytes() / 1e6:8.1f} MB resident"
                elapsed = time.perf_counter() - began
                print(f"{line} {held:7.1f} MB on the device {elapsed:7.0f} s", flush=True)
        resident.append(resident_bytes() / 1e6)
    grown = resident[-1] - resident[0]
    messages = device.messages
    storm.release()
    print(f"grown by {grown:.1f} MB after the first round; {len(messages)} messages")
    for message in messages[:5]:
        print(message)
    return int(grown > ALLOWED_MB or bool(messages))


if __name__ == "__main__":
    sys.exit(main())
