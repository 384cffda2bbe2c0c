"""Colour look-up tables as `.cube` texts."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

SIDE = 16
"""Entries along an axis: what artists expect of a table to start from."""

Colors = npt.NDArray[np.float64]


def identity() -> Colors:
    """(N, N, N, 3) by blue, green, red: each colour is itself."""
    steps = np.linspace(0, 1, SIDE)
    blue, green, red = np.meshgrid(steps, steps, steps, indexing="ij")
    return np.stack([red, green, blue], axis=-1)


def evening() -> Colors:
    """Teal shadows, amber lights, a little more contrast."""
    colors = identity()
    luma = colors @ np.array([0.299, 0.587, 0.114])
    contrast = colors + 0.08 * np.sin(2 * np.pi * (colors - 0.5))
    share = luma[..., None] * luma[..., None] * (3 - 2 * luma[..., None])
    shadows, lights = np.array([-0.035, 0.015, 0.045]), np.array([0.045, 0.01, -0.05])
    edge = 4 * luma[..., None] * (1 - luma[..., None])  # black and white stay
    return np.asarray(np.clip(contrast + edge * (shadows * (1 - share) + lights * share), 0, 1))


def cube_text(title: str, colors: Colors) -> str:
    """The `.cube` file of a table [Adobe13]."""
    rows = (f"{r:.5g} {g:.5g} {b:.5g}" for r, g, b in colors.reshape(-1, 3))
    return "\n".join([f'TITLE "{title}"', f"LUT_3D_SIZE {len(colors)}", *rows]) + "\n"
