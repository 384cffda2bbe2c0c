"""How often Python looks for cycles of objects that nobody uses."""

from __future__ import annotations

import gc

YOUNG_OBJECTS = 50_000
"""More objects than a frame makes between two looks: by default a look comes every 700, some ten of
them a frame, for up to a millisecond [measured: tools/python_cost.py]. Frames leave no cycles."""


def collect_rarely() -> None:
    """Have the collector look once for many frames. For programs, not for those who import this."""
    gc.set_threshold(YOUNG_OBJECTS, *gc.get_threshold()[1:])
