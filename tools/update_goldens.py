"""Draws the golden pictures anew: look at them before they are committed.

python tools/update_goldens.py [NAME…]
"""

from __future__ import annotations

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "tests"), str(ROOT / "app")]

from elemental.core.images import write_png  # noqa: E402  (the path comes first)
from elemental.gpu.device import Device  # noqa: E402
from image.golden_scenes import SCENES, draw  # type: ignore[import-not-found]  # noqa: E402


def main() -> None:
    """Write the named pictures, or all."""
    device = Device.headless(debug=True)
    for name in sys.argv[1:] or SCENES:
        path = ROOT / "tests" / "image" / "golden" / f"{name}.png"
        write_png(path, draw(device, name))
        print(path)


if __name__ == "__main__":
    main()
