"""Between sRGB display values and linear light [IEC 61966-2-1]. Any shape, values of at least 0."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt


def encode_srgb(linear: npt.NDArray[np.float32]) -> npt.NDArray[np.float32]:
    """Display values of linear light."""
    toe = linear * np.float32(12.92)
    curve = np.float32(1.055) * linear ** np.float32(1 / 2.4) - np.float32(0.055)
    return np.where(linear <= np.float32(0.0031308), toe, curve)


def decode_srgb(display: npt.NDArray[np.float32]) -> npt.NDArray[np.float32]:
    """Linear light of display values."""
    toe = display / np.float32(12.92)
    curve = ((display + np.float32(0.055)) / np.float32(1.055)) ** np.float32(2.4)
    return np.where(display <= np.float32(0.04045), toe, curve)
