"""The textures of the lens are what tools/make_lens.py makes. PP-04, PP-06, PP-09"""

from __future__ import annotations

import numpy as np
import pytest

from elemental.core.cube_lut import read_cube_lut
from elemental.core.images import read_png_jpeg_webp
from elemental.core.paths import content_root
from lens.masks import Grey, aperture, dirt
from lens.tables import cube_text, evening, identity

FOLDER = content_root() / "textures"


def linear(name: str) -> Grey:
    """(H, W) of an sRGB image."""
    codes = read_png_jpeg_webp(FOLDER / name)[..., 0] / 255.0
    return np.where(codes <= 0.04045, codes / 12.92, ((codes + 0.055) / 1.055) ** 2.4)


@pytest.mark.parametrize(
    ("name", "grey"),
    [("dirt.png", dirt()), ("bokeh_disc.png", aperture(0)), ("bokeh_hexagon.png", aperture(6))],
)
def test_the_committed_masks_are_the_tools(name: str, grey: Grey) -> None:
    np.testing.assert_allclose(linear(name), grey, atol=0.005)


@pytest.mark.parametrize(("name", "colors"), [("neutral", identity()), ("evening", evening())])
def test_the_committed_tables_are_the_tools(name: str, colors: Grey) -> None:
    assert (FOLDER / f"{name}.cube").read_text() == cube_text(name, colors)


def test_the_neutral_table_is_the_identity() -> None:
    lut = read_cube_lut(FOLDER / "neutral.cube")
    steps = np.linspace(0, 1, lut.size)
    np.testing.assert_allclose(lut.table[3, 5, 7], steps[[7, 5, 3]], atol=1e-5)
    np.testing.assert_allclose(lut.table, identity(), atol=1e-5)


def test_the_evening_keeps_black_and_white() -> None:
    lut = read_cube_lut(FOLDER / "evening.cube")
    np.testing.assert_allclose(lut.table[0, 0, 0], 0.0, atol=1e-5)
    np.testing.assert_allclose(lut.table[-1, -1, -1], 1.0, atol=1e-5)
    middle = lut.table[8, 8, 8]
    assert middle[0] != middle[2]


def test_an_aperture_is_open_in_its_middle_and_shut_in_its_corners() -> None:
    for blades in (0, 6):
        shape = aperture(blades)
        assert shape[32, 32] > 0.5
        assert shape[0, 0] == shape[-1, -1] == 0.0
    assert aperture(6).sum() < aperture(0).sum()
