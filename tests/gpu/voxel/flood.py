"""6-connected flood fill of a voxel grid from outside."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[Any]


def reached_from_outside(occupied: Array) -> Array:
    """(X, Y, Z) bool: empty voxels that a path through the faces of empty ones joins to the sides.

    ``occupied`` (X, Y, Z) bool. Sweeps plane by plane along each axis until nothing changes.
    """
    free = np.pad(~occupied, 1, constant_values=True)
    reached = np.zeros_like(free)
    reached[0] = True
    count = -1
    while count != (count := int(np.count_nonzero(reached))):
        for axis in range(3):
            planes, open_ = np.moveaxis(reached, axis, 0), np.moveaxis(free, axis, 0)
            for order in (range(1, len(planes)), range(len(planes) - 2, -1, -1)):
                before = planes[order[0] - 1] if order[0] == 1 else planes[-1]
                for k in order:
                    planes[k] |= before & open_[k]
                    before = planes[k]
    return reached[1:-1, 1:-1, 1:-1]
