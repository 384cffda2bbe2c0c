"""Image files: round trips, formats, and what is refused."""

from __future__ import annotations

import io
import os
import resource
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import PIL.Image
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from elemental.core.errors import InputError
from elemental.core.files import atomic_file
from elemental.core.images import (
    read_environment,
    read_exr,
    read_lens_texture,
    read_png_jpeg_webp,
    write_exr,
    write_png,
)
from elemental.core.rgbe import decode_rgbe, encode_rgbe
from gltf_builder import GltfBuilder

RNG = np.random.default_rng(7)
RGB8 = RNG.integers(0, 256, (5, 9, 3)).astype(np.uint8)


def encoded(pixels: np.ndarray, kind: str, **options: object) -> bytes:
    stream = io.BytesIO()
    PIL.Image.fromarray(pixels).save(stream, kind, **options)
    return stream.getvalue()


def test_png_round_trip_keeps_row_0_on_top(tmp_path: Path) -> None:
    write_png(tmp_path / "a.png", RGB8)
    pixels = read_png_jpeg_webp(tmp_path / "a.png")
    np.testing.assert_array_equal(pixels[..., :3], RGB8)
    assert (pixels[..., 3] == 255).all()


def test_lossless_webp_keeps_alpha() -> None:
    rgba = np.dstack([RGB8, RGB8[..., :1]])
    read = read_png_jpeg_webp(encoded(rgba, "WEBP", lossless=True, exact=True))
    np.testing.assert_array_equal(read, rgba)


def test_jpeg_is_near() -> None:
    smooth = np.broadcast_to(np.linspace(0, 255, 32).astype(np.uint8)[:, None, None], (32, 32, 3))
    read = read_png_jpeg_webp(encoded(np.ascontiguousarray(smooth), "JPEG", quality=95))
    assert np.abs(read[..., :3].astype(int) - smooth).max() <= 4


def test_16_bit_grey_is_scaled() -> None:
    grey = np.array([[0, 32768, 65535]], np.uint16)
    assert read_png_jpeg_webp(encoded(grey, "PNG"))[0, :, 0].tolist() == [0, 128, 255]


def test_palette_with_transparency() -> None:
    image = PIL.Image.fromarray(np.array([[0, 1]], np.uint8), "P")
    image.putpalette([10, 20, 30, 40, 50, 60])
    stream = io.BytesIO()
    image.save(stream, "PNG", transparency=1)
    read = read_png_jpeg_webp(stream.getvalue())
    assert read[0].tolist() == [[10, 20, 30, 255], [40, 50, 60, 0]]


@pytest.mark.parametrize("cut", [0, 1, 20, 60, -40])
def test_broken_png(cut: int) -> None:
    with pytest.raises(InputError, match="PNG, JPEG or WebP image"):
        read_png_jpeg_webp(encoded(RGB8, "PNG")[:cut])


def test_other_formats_are_refused() -> None:
    with pytest.raises(InputError, match="PNG, JPEG or WebP image"):
        read_png_jpeg_webp(encoded(RGB8, "BMP"))


def test_exr_round_trip_is_exact(tmp_path: Path) -> None:
    radiance = RNG.standard_normal((6, 7, 3)).astype(np.float32) * np.float32(1e4)
    write_exr(tmp_path / "a.exr", radiance)
    np.testing.assert_array_equal(read_exr(tmp_path / "a.exr"), radiance)
    clipped = read_environment(tmp_path / "a.exr")
    np.testing.assert_array_equal(clipped, np.maximum(radiance, 0.0))


def test_writing_twice_gives_the_same_bytes(tmp_path: Path) -> None:
    for name, write, pixels in [
        ("a.png", write_png, RGB8),
        ("a.exr", write_exr, RGB8.astype(np.float32)),
    ]:
        write(tmp_path / name, pixels)
        first = (tmp_path / name).read_bytes()
        write(tmp_path / name, pixels)
        assert (tmp_path / name).read_bytes() == first
    assert len(list(tmp_path.iterdir())) == 2


def test_nan_environment_is_refused(tmp_path: Path) -> None:
    write_exr(tmp_path / "a.exr", np.full((2, 4, 3), np.nan, np.float32))
    with pytest.raises(InputError, match="NaN"):
        read_environment(tmp_path / "a.exr")


@pytest.mark.parametrize("length", [0, 3, 200, 400])
def test_broken_exr(length: int, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    write_exr(tmp_path / "a.exr", RNG.random((8, 8, 3)).astype(np.float32))
    (tmp_path / "b.exr").write_bytes((tmp_path / "a.exr").read_bytes()[:length])
    with pytest.raises(InputError, match="OpenEXR"):
        read_environment(tmp_path / "b.exr")
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("width", [5, 8, 300])
@pytest.mark.parametrize("run_length", [True, False])
def test_rgbe_round_trip(width: int, run_length: bool) -> None:
    radiance = np.exp2(RNG.uniform(-20, 20, (4, width, 3))).astype(np.float32)
    radiance[0] = 0.0
    radiance[1] = 3.0
    decoded = decode_rgbe(encode_rgbe(radiance, run_length=run_length))
    largest = radiance.max(axis=-1, keepdims=True)
    assert (np.abs(decoded - radiance) <= largest / 256).all()
    assert (decoded[0] == 0.0).all()


def test_rgbe_plain_stretches_and_orientation() -> None:
    row = bytes((2, 2, 0, 8)) + b"".join(bytes((8, *range(k, k + 8))) for k in (0, 8, 16))
    row += bytes((128 + 8, 128))
    for resolution, place in ((b"-Y 1 +X 8", 0), (b"+Y 1 -X 8", 7)):
        radiance = decode_rgbe(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + resolution + b"\n" + row)
        np.testing.assert_allclose(radiance[0, place], np.array([0.5, 8.5, 16.5]) / 256)


def test_rgbe_exposure_is_divided_out() -> None:
    plain = encode_rgbe(np.full((2, 8, 3), 5.0, np.float32))
    exposed = plain.replace(b"\n\n", b"\nEXPOSURE=2\nEXPOSURE=4\n\n", 1)
    np.testing.assert_allclose(decode_rgbe(exposed) * 8.0, decode_rgbe(plain))


BROKEN_HDR = {
    "no magic": (b"hello\n\n-Y 1 +X 8\n", "RADIANCE"),
    "no end": (b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n", "no end"),
    "xyze": (b"#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 8\n", "xyze"),
    "transposed": (b"#?RADIANCE\n\n+X 8 -Y 1\n", "resolution"),
    "size": (b"#?RADIANCE\n\n-Y 999999999 +X 8\n", "out of range"),
    "exposure": (b"#?RADIANCE\nEXPOSURE=-1\n\n-Y 1 +X 8\n", "EXPOSURE"),
    "short": (b"#?RADIANCE\n\n-Y 1 +X 4\n123", "cut short"),
    "short runs": (b"#?RADIANCE\n\n-Y 1 +X 8\n\x02\x02\x00\x08\x88", "cut short"),
    "long run": (b"#?RADIANCE\n\n-Y 1 +X 8\n\x02\x02\x00\x08\x89\x01", "crosses"),
    "zero count": (b"#?RADIANCE\n\n-Y 1 +X 8\n\x02\x02\x00\x08\x00\x01", "broken"),
    "wrong width": (b"#?RADIANCE\n\n-Y 1 +X 8\n\x02\x02\x00\x09\x88\x01", "width"),
}


@pytest.mark.parametrize("name", BROKEN_HDR)
def test_broken_hdr(name: str, tmp_path: Path) -> None:
    broken, reason = BROKEN_HDR[name]
    (tmp_path / "a.hdr").write_bytes(broken)
    with pytest.raises(InputError, match=reason) as caught:
        read_environment(tmp_path / "a.hdr")
    assert str(caught.value).startswith(str(tmp_path / "a.hdr"))


def test_failed_write_leaves_nothing(tmp_path: Path) -> None:
    target = tmp_path / "a.png"
    target.write_bytes(b"old")

    def write_half() -> None:
        with atomic_file(target) as temporary:
            temporary.write_bytes(b"half")
            raise RuntimeError

    with pytest.raises(RuntimeError):
        write_half()
    assert target.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [target]


def test_missing_folder(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="can't be written"):
        write_png(tmp_path / "none" / "a.png", RGB8)


HDR = encode_rgbe(np.full((3, 9, 3), 2.0, np.float32))


@settings(max_examples=300, deadline=None, derandomize=True, database=None,
          suppress_health_check=list(HealthCheck))  # fmt: skip
@given(at=st.integers(0, len(HDR) - 1), length=st.integers(0, 9), edit=st.binary(max_size=3))
def test_edited_hdr_files_load_or_are_refused(
    at: int, length: int, edit: bytes, tmp_path: Path
) -> None:
    (tmp_path / "a.hdr").write_bytes(HDR[:at] + edit + HDR[at + length :])
    try:
        radiance = read_environment(tmp_path / "a.hdr")
    except InputError:
        return
    assert np.isfinite(radiance).all()
    assert radiance.min() >= 0.0


def test_cmyk_jpeg() -> None:
    stream = io.BytesIO()
    PIL.Image.new("CMYK", (8, 8), (0, 255, 255, 0)).save(stream, "JPEG", quality=95)
    red, green, blue, alpha = read_png_jpeg_webp(stream.getvalue())[4, 4].tolist()
    assert red > 230
    assert max(green, blue) < 60
    assert alpha == 255


@pytest.mark.parametrize(("name", "write"), [("a.png", write_png), ("a.exr", write_exr)])
def test_a_full_disk_is_told_and_leaves_the_old_file(
    name: str, write: Callable[[Path, Any], None], tmp_path: Path
) -> None:
    (tmp_path / name).write_bytes(b"old")
    noise = RNG.integers(0, 255, (64, 64, 3)).astype(np.uint8)
    kept = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (1024, kept[1]))
    try:
        with pytest.raises(InputError, match=rf"{name}: can't be written \("):
            write(tmp_path / name, noise if name == "a.png" else noise.astype(np.float32))
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, kept)
    assert [(path.name, path.read_bytes()) for path in tmp_path.iterdir()] == [(name, b"old")]


def test_images_larger_than_textures_can_be_are_refused(tmp_path: Path) -> None:
    wide = np.zeros((1, 16385, 3), np.uint8)
    write_png(tmp_path / "a.png", wide)
    write_exr(tmp_path / "a.exr", wide.astype(np.float32))
    reason = r"is 16385 x 1 pixels, at most 16384 a side"
    with pytest.raises(InputError, match=rf"a\.png: {reason}"):
        read_lens_texture(tmp_path / "a.png")
    with pytest.raises(InputError, match=rf"a\.exr: {reason}"):
        read_environment(tmp_path / "a.exr")
    builder = GltfBuilder()
    texture = builder.texture(wide)
    builder.material(pbr={"baseColorTexture": {"index": texture}})
    builder.add(np.eye(3, dtype=np.float32), material=0)
    with pytest.raises(InputError, match=rf"scene\.glb: images\[0\]: image0: {reason}"):
        builder.load(tmp_path)


def test_a_read_only_file_is_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "a.png").write_bytes(b"mine")
    monkeypatch.setattr(os, "access", lambda path, mode: False)  # root may write anywhere
    with pytest.raises(InputError, match=r"a\.png: can't be written \(it is read-only\)"):
        write_png(tmp_path / "a.png", RGB8)
    assert (tmp_path / "a.png").read_bytes() == b"mine"
