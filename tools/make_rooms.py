"""Writes the rooms that accuracy is measured on, and their sky: `python tools/make_rooms.py`."""

from __future__ import annotations

from pathlib import Path

from made_files import write_all
from rooms.plans import PLANS
from rooms.sky import windows_hdr

FOLDER = Path(__file__).resolve().parent.parent / "content" / "scenes" / "rooms"


def files() -> dict[str, bytes]:
    """File name -> content."""
    made = {f"{name}.glb": plan().glb(name) for name, plan in PLANS.items()}
    return {**made, "windows.hdr": windows_hdr()}


def main() -> None:
    """Write all of them and say how large they are."""
    write_all(files(), FOLDER)


if __name__ == "__main__":
    main()
