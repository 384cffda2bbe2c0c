"""Writes content/textures: `python tools/make_lens.py`. The same bytes every time."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from elemental.core.images import write_png
from lens.masks import Grey, aperture, dirt
from lens.tables import cube_text, evening, identity

FOLDER = Path(__file__).resolve().parents[1] / "content" / "textures"


def main() -> None:
    """All masks and tables."""
    FOLDER.mkdir(exist_ok=True)
    _write("dirt.png", dirt())
    _write("bokeh_disc.png", aperture(0))
    _write("bokeh_hexagon.png", aperture(6))
    (FOLDER / "neutral.cube").write_text(cube_text("neutral", identity()))
    (FOLDER / "evening.cube").write_text(cube_text("evening", evening()))


def _write(name: str, grey: Grey) -> None:
    """Linear grey as an sRGB image, which the program reads back as linear."""
    encoded = np.where(grey <= 0.0031308, 12.92 * grey, 1.055 * grey ** (1 / 2.4) - 0.055)
    levels = np.round(255 * encoded).astype(np.uint8)
    write_png(FOLDER / name, np.repeat(levels[..., None], 3, axis=2))


if __name__ == "__main__":
    main()
