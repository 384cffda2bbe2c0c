"""Where a camera on a path is at a time."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from elemental.core import transforms
from elemental.scene.model import Camera, CameraPath

F64 = npt.NDArray[np.float64]


def camera_at(path: CameraPath, time_s: float) -> Camera:
    """The camera at `time_s` seconds: eye and target glide through the keys.

    Cubic Hermite curves with finite-difference slopes (a Catmull-Rom spline over the keys' own
    times). Before the first key and after the last the camera rests, unless the path loops; then
    the last key, which should equal the first, leads over to it.
    """
    times, t = path.times, float(time_s)
    if path.loop:
        t = times[0] + (t - times[0]) % (times[-1] - times[0])
    eye = _hermite(times, path.eyes.astype(np.float64), t, path.loop)
    target = _hermite(times, path.targets.astype(np.float64), t, path.loop)
    if np.allclose(eye, target, rtol=0.0, atol=1e-9):
        target = eye - np.array([0.0, 0.0, 1.0])
    view_from_world = transforms.look_at(eye, target)
    return Camera("path", transforms.inverse(view_from_world), path.fov_y, path.near)


def _hermite(times: F64, values: F64, t: float, loop: bool) -> F64:
    """The curve through `values` (K, 3) at `times` (K,), where it is at `t`."""
    t = min(max(t, times[0]), times[-1])
    k = min(int(np.searchsorted(times, t, side="right")), len(times) - 1) - 1
    width = times[k + 1] - times[k]
    s = (t - times[k]) / width
    slope0, slope1 = (slope_at(times, values, i, loop) * width for i in (k, k + 1))
    p0, p1 = values[k], values[k + 1]
    lead = (1.0 + 2.0 * s) * (1.0 - s) ** 2 * p0 + s * (1.0 - s) ** 2 * slope0
    follow = s**2 * (3.0 - 2.0 * s) * p1 + s**2 * (s - 1.0) * slope1
    point: F64 = lead + follow
    return point


def slope_at(times: F64, values: F64, k: int, loop: bool) -> F64:
    """Velocity at key `k`: over its two neighbours, across the seam of a loop."""
    last = len(times) - 1
    if loop and k in (0, last):
        before, after = values[1] - values[0], values[last] - values[last - 1]
        slope: F64 = (before + after) / (times[1] - times[0] + times[last] - times[last - 1])
        return slope
    low, high = max(k - 1, 0), min(k + 1, last)
    slope = (values[high] - values[low]) / (times[high] - times[low])
    return slope
