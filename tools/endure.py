#!/usr/bin/env python3
"""Thousands of frames of changing settings, sizes and volumes: memory, messages, time.

    tools/endure.py [SCENE] [--frames 10000] [--warmup 2000] [--seed 0]

No frame repeats another. Now and then the storm rests: the first settings and size come back, and
what the process holds in RAM and the device in buffers and textures can be compared. Frames of the
warm-up meet programs for the first time, which the driver keeps. Exits 1 where memory grew by more
than 5 MB after it, where the device came to hold other bytes, or the driver complained.
"""

from __future__ import annotations

import argparse
import sys
import time

from elemental.gpu.device import Device
from elemental.session import Viewpoint, set_stage
from endurance.storm import LARGEST, Storm

ALLOWED_MB = 5.0
"""Growth after the warm-up that counts as flat."""
RESTS = 12
"""Of all frames."""


def main() -> int:
    """Run and judge."""
    parser = argparse.ArgumentParser(description="Memory over thousands of frames of changes.")
    parser.add_argument("scene", nargs="?", default="cornell_box")
    parser.add_argument("--frames", type=int, default=10_000)
    parser.add_argument("--warmup", type=int, default=2_000)
    parser.add_argument("--seed", type=int, default=0)
    words = parser.parse_args()
    stage = set_stage(words.scene, ["gi.resolution=64"], Viewpoint(), LARGEST)
    device = Device.headless(debug=True)
    storm = Storm(device, stage, words.seed)
    began, total = time.perf_counter(), words.warmup + words.frames
    resident, held = [], []
    for frame in storm.frames(total):
        done = frame + 1
        if done % max(total // RESTS, 1) and done not in (words.warmup, total):
            continue
        megabytes = storm.rest() / 1e6
        if done >= words.warmup:
            resident.append(megabytes)
            held.append(sum(device.bytes().values()))
        line = f"{done:6d} frames {megabytes:8.1f} MB resident"
        elapsed = time.perf_counter() - began
        print(f"{line} {sum(device.bytes().values()) / 1e6:7.1f} MB on the device {elapsed:7.0f} s",
              flush=True)  # fmt: skip
    grown = max(resident) - resident[0]
    messages = device.messages
    storm.release()
    print(f"grown by {grown:.1f} MB in {words.frames} frames after the warm-up; "
          f"{len(messages)} messages")  # fmt: skip
    for message in messages[:5]:
        print(message)
    return int(grown > ALLOWED_MB or len(set(held)) > 1 or bool(messages))


if __name__ == "__main__":
    sys.exit(main())
