"""Times that can be read: exponential averages of figures that change every frame. No GL."""

from __future__ import annotations

import math
from collections.abc import Iterable

SETTLE_S = 0.5
"""After this time an average has gone 63 % of the way to a new value."""


class Averages:
    """One average a name, in the order in which the names came up last."""

    def __init__(self) -> None:
        self.values: dict[str, float] = {}

    def update(self, figures: Iterable[tuple[str, float]], seconds: float) -> None:
        """Move each average towards its new figure; a name that is missing is forgotten.

        ``seconds`` have passed since the last update. Figures of one name are added up.
        """
        sums: dict[str, float] = {}
        for name, figure in figures:
            sums[name] = sums.get(name, 0.0) + figure
        keep = math.exp(-max(seconds, 0.0) / SETTLE_S)
        self.values = {
            name: total + keep * (self.values.get(name, total) - total)
            for name, total in sums.items()
        }
