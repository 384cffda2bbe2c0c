"""How tools that make content write it."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from pathlib import Path


def write_all(files: Mapping[str, bytes], folder: Path) -> None:
    """Write each into ``folder``, or into the one that the command line names, and say its size."""
    into = Path(sys.argv[1]) if len(sys.argv) > 1 else folder
    for name, content in files.items():
        (into / name).parent.mkdir(parents=True, exist_ok=True)
        (into / name).write_bytes(content)
        print(f"{into / name}: {len(content)} bytes")
