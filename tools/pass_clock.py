"""The CPU time of a device's passes, for tools that measure on software drivers."""

from __future__ import annotations

import time
from collections import defaultdict
from collections.abc import Mapping
from typing import Any

from elemental.gpu.device import Device


class PassClock:
    """Adds up the process's time over each pass, by the groups' rows, in `ms`.

    ``groups``: row -> what the names of its passes begin with; the first row that fits takes a
    pass. All threads of the driver count, the machine's other users do not; each pass is waited
    for.
    """

    def __init__(self, device: Device, groups: Mapping[str, tuple[str, ...]]) -> None:
        self.ms: dict[str, float] = defaultdict(float)
        for kind, run in device.executor._run.items():

            def timed(node: Any, run: Any = run) -> None:
                began = time.process_time()
                run(node)
                device.gl.glFinish()
                row = next(name for name, starts in groups.items() if node.name.startswith(starts))
                self.ms[row] += 1e3 * (time.process_time() - began)

            device.executor._run[kind] = timed
