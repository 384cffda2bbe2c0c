"""Mean brightness of three scenes at 64, 128, 256 and 512 lattice points, as rows of a table.

python tools/measure_resolution.py [NAME…] [--upto N]
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "tests"), str(ROOT / "app")]

from accuracy.resolution import SCENES, mean_luminance  # type: ignore[import-not-found]  # noqa: E402
from elemental.gpu.device import Device  # noqa: E402

RESOLUTIONS = (64, 128, 256, 512)
BASE = 1
"""Index of the resolution that the others are compared with."""


def main() -> None:
    """Print a row for each scene: its luminance at 128, the ratios to it at all of them."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(SCENES))
    parser.add_argument("--upto", type=int, default=RESOLUTIONS[-1], choices=RESOLUTIONS[1:])
    words = parser.parse_args()
    device = Device.headless()
    chosen = [n for n in RESOLUTIONS if n <= words.upto]
    print("| scene | luminance at 128 | " + " | ".join(map(str, chosen)) + " |")
    print("|---|---|" + "---|" * len(chosen))
    for name in words.names or SCENES:
        light = [mean_luminance(device, name, resolution) for resolution in chosen]
        ratios = " | ".join(f"{value / light[BASE]:.3f}" for value in light)
        print(f"| {name} | {light[BASE]:.4f} | {ratios} |", flush=True)


if __name__ == "__main__":
    main()
