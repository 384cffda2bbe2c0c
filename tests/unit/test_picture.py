"""Rendered views as PNG and EXR."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import PIL.Image
import pytest
from numpy.typing import NDArray

from elemental.core.errors import InputError
from elemental.core.images import read_exr
from elemental.core.srgb import decode_srgb, encode_srgb
from elemental.picture import is_picture, save_picture

RADIANCE = np.array([[[0.0, 0.18, 1.0, 0.5], [2.5, 1e-4, 65504.0, 0.0]]], np.float32)


def png(path: Path) -> NDArray[np.uint8]:
    with PIL.Image.open(path) as image:
        return np.asarray(image)


def test_srgb_round_trip_over_all_codes() -> None:
    codes = np.arange(256, dtype=np.float32) / 255
    np.testing.assert_allclose(encode_srgb(decode_srgb(codes)), codes, atol=1e-6)
    assert encode_srgb(np.float32(0.18)[None])[0] == pytest.approx(0.4613, abs=1e-4)


def test_linear_radiance_is_exact_in_exr_and_encoded_in_png(tmp_path: Path) -> None:
    save_picture(tmp_path / "a.exr", RADIANCE, is_linear=True)
    np.testing.assert_array_equal(read_exr(tmp_path / "a.exr"), RADIANCE[:, :, :3])
    save_picture(tmp_path / "a.png", RADIANCE, is_linear=True)
    np.testing.assert_array_equal(png(tmp_path / "a.png")[0], [[0, 118, 255], [255, 0, 255]])


@pytest.mark.parametrize("as_float", [False, True])
def test_display_values_are_exact_in_png_and_decoded_in_exr(tmp_path: Path, as_float: bool) -> None:
    codes = np.random.default_rng(1).integers(0, 256, (4, 5, 4), np.uint8)
    view = (codes / np.float32(255)).astype(np.float32) if as_float else codes
    save_picture(tmp_path / "a.png", view, is_linear=False)
    np.testing.assert_array_equal(png(tmp_path / "a.png"), codes[:, :, :3])
    save_picture(tmp_path / "a.exr", view, is_linear=False)
    shown = np.round(encode_srgb(read_exr(tmp_path / "a.exr")) * 255)
    np.testing.assert_array_equal(shown, codes[:, :, :3])


def test_texels_that_are_no_numbers_do_not_break_a_png(tmp_path: Path) -> None:
    odd = np.array([[[np.nan, np.inf, -np.inf]]], np.float32)
    save_picture(tmp_path / "a.png", odd, is_linear=True)
    np.testing.assert_array_equal(png(tmp_path / "a.png")[0, 0], [0, 255, 0])


def test_a_picture_that_cannot_be_written_leaves_nothing(tmp_path: Path) -> None:
    for name in ("a.png", "a.exr"):
        with pytest.raises(InputError, match="can't be written"):
            save_picture(tmp_path / "nowhere" / name, RADIANCE, is_linear=True)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("name", ["a.png", "a.exr"])
def test_only_whole_pictures_of_the_size_count(tmp_path: Path, name: str) -> None:
    file = tmp_path / name
    assert not is_picture(file, (24, 16))
    noise = np.random.default_rng(1).random((16, 24, 3), np.float32)
    save_picture(file, noise, is_linear=True)
    assert is_picture(file, (24, 16))
    assert not is_picture(file, (16, 24))
    whole = file.read_bytes()
    for length in (0, 8, 100, len(whole) // 2, len(whole) - 20, len(whole) - 4):
        file.write_bytes(whole[:length])
        assert not is_picture(file, (24, 16)), length
    middle = len(whole) // 2
    file.write_bytes(whole[:middle] + bytes([whole[middle] ^ 1]) + whole[middle + 1 :])
    assert name == "a.exr" or not is_picture(file, (24, 16))  # an EXR has no checksums
