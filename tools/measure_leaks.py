"""Light that gets from a bright room into a sealed one, by the thickness of their walls.

python tools/measure_leaks.py: a table, mean (and at most) over the places of the walls on the grid.
"""

from __future__ import annotations

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "tests"), str(ROOT / "app")]

from accuracy.sealed import PHASES, TURNS, leak  # type: ignore[import-not-found]  # noqa: E402
from elemental.gpu.device import Device  # noqa: E402

WALLS_VOXELS = (0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 4.0)


def main() -> None:
    """Print a row for each thickness."""
    device = Device.headless()
    print("| walls, voxels | " + " | ".join(TURNS) + " |")
    print("|---|" + "---|" * len(TURNS))
    for wall in WALLS_VOXELS:
        cells = []
        for turn in TURNS:
            means, most = zip(*(leak(device, wall, turn, p) for p in PHASES), strict=True)
            cells.append(f"{sum(means) / len(means):.2%} ({max(most):.1%})")
        print(f"| {wall:g} | " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()
