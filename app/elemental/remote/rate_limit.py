"""Bounds on how often something happens."""

from __future__ import annotations

import asyncio
import time
from collections import OrderedDict
from collections.abc import Callable


class RateLimit:
    """A bucket of ``burst`` permits that refills at ``rate`` a second."""

    def __init__(
        self, rate: float, burst: float, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._rate, self._burst, self._clock = rate, burst, clock
        self._permits, self._then = burst, clock()

    def take(self) -> bool:
        """Take a permit if one is there now."""
        self._refill()
        if self._permits < 1.0:
            return False
        self._permits -= 1.0
        return True

    def delay(self) -> float:
        """Take a permit; seconds until it is valid. Permits are given in the order of the calls."""
        self._refill()
        self._permits -= 1.0
        return max(-self._permits / self._rate, 0.0)

    async def wait(self) -> None:
        """Take a permit and wait until it is valid."""
        delay = self.delay()
        if delay > 0.0:
            await asyncio.sleep(delay)

    def _refill(self) -> None:
        now = self._clock()
        self._permits = min(self._permits + (now - self._then) * self._rate, self._burst)
        self._then = now


class HostLimits:
    """A RateLimit for each of the ``most`` clients that were heard last."""

    def __init__(self, rate: float, burst: float, most: int) -> None:
        self._rate, self._burst, self._most = rate, burst, most
        self._limits: OrderedDict[str, RateLimit] = OrderedDict()

    def of(self, client: str) -> RateLimit:
        """Whose is new begins with all of its permits."""
        limit = self._limits.pop(client, None) or RateLimit(self._rate, self._burst)
        self._limits[client] = limit
        if len(self._limits) > self._most:
            self._limits.popitem(last=False)
        return limit

    def __len__(self) -> int:
        return len(self._limits)
