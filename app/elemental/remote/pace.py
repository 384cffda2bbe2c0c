"""A bound on how often something happens."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable


class Pace:
    """A bucket of ``burst`` permits that refills at ``rate`` a second."""

    def __init__(
        self, rate: float, burst: float, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._rate, self._burst, self._clock = rate, burst, clock
        self._permits, self._then = burst, clock()

    def delay(self) -> float:
        """Take a permit; seconds until it is valid. Permits are given in the order of the calls."""
        now = self._clock()
        self._permits = min(self._permits + (now - self._then) * self._rate, self._burst)
        self._then = now
        self._permits -= 1.0
        return max(-self._permits / self._rate, 0.0)

    async def wait(self) -> None:
        """Take a permit and wait until it is valid."""
        delay = self.delay()
        if delay > 0.0:
            await asyncio.sleep(delay)
