"""Image files to arrays and back. Row 0 is the top row; every write is atomic."""

from __future__ import annotations

import errno
import io
import os
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stdout
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import PIL.Image

from elemental.core.errors import InputError
from elemental.core.files import atomic_file, check_file, read_file
from elemental.core.rgbe import decode_rgbe

ERROR_DESCRIPTOR = 2
PNG_JPEG_WEBP = ("PNG", "JPEG", "WEBP")
LARGEST_SIDE = 16384
"""Texels along a side of a texture that every driver of GL 4.3 takes."""
PNG_END = b"\0\0\0\0IEND\xaeB`\x82"
"""The last chunk [ISO 15948 11.2.5]."""


def read_png_jpeg_webp(source: bytes | Path, name: str | None = None) -> npt.NDArray[np.uint8]:
    """Decode a PNG, JPEG or WebP image to (H, W, 4) uint8, values as stored (no colour management).

    Grey is repeated over RGB, a missing alpha is 255, 16 bits a channel are rounded to 8.
    `name` is what errors call the image. Raises InputError for a file that can't be decoded.
    """
    label = name or (str(source) if isinstance(source, Path) else "image")
    encoded = read_file(source, label) if isinstance(source, Path) else source
    try:
        with PIL.Image.open(io.BytesIO(encoded), formats=PNG_JPEG_WEBP) as image:
            return _rgba8(image)
    except Exception as error:  # Pillow's decoders raise what their input makes them raise
        raise InputError(label, "", _unreadable(error, "PNG, JPEG or WebP")) from error


def read_lens_texture(path: Path) -> npt.NDArray[np.uint8]:
    """A PNG, JPEG or WebP image (H, W, 4) that becomes a texture as it is. Raises InputError."""
    pixels = read_png_jpeg_webp(path)
    check_side(path, pixels.shape)
    return pixels


def check_png(path: Path) -> tuple[int, int]:
    """(width, height) of a PNG whose every chunk is whole. Raises InputError for another file."""
    encoded = read_file(path)
    if not encoded.endswith(PNG_END):
        raise InputError(path, "", "not a whole PNG image")
    try:
        with PIL.Image.open(io.BytesIO(encoded), formats=("PNG",)) as image:
            size = image.size
            image.verify()
    except Exception as error:  # Pillow's decoders raise what their input makes them raise
        raise InputError(path, "", _unreadable(error, "PNG")) from error
    return size


def read_environment(path: Path) -> npt.NDArray[np.float32]:
    """Read a radiance map, `.hdr` (RGBE) or `.exr`, as (H, W, 3) float32 linear radiance.

    Raises InputError for another kind of file, a broken one, or one with NaN or infinite texels.
    """
    suffix = path.suffix.lower()
    check_file(path)
    if suffix == ".hdr":
        try:
            radiance = decode_rgbe(read_file(path))
        except ValueError as error:
            raise InputError(path, "", str(error)) from error
    elif suffix == ".exr":
        radiance = read_exr(path)
    else:
        raise InputError(path, "", f"expected an .hdr or .exr file, not {path.name!r}")
    check_side(path, radiance.shape)
    if not np.isfinite(radiance).all():
        raise InputError(path, "", "texels that are NaN or infinite")
    return np.maximum(radiance, 0.0)


def check_side(name: str | Path, shape: tuple[int, ...]) -> None:
    """Raises InputError for an image (H, W, ...) that is larger than textures can be."""
    if max(shape[:2]) > LARGEST_SIDE:
        reason = f"is {shape[1]} x {shape[0]} pixels, at most {LARGEST_SIDE} a side"
        raise InputError(name, "", reason)


def read_exr(path: Path) -> npt.NDArray[np.float32]:
    """Read the first part of an OpenEXR file as (H, W, 3) float32; a lone Y is repeated.

    Raises InputError for a file that OpenEXR can't read or that has neither R, G, B nor Y.
    """
    import OpenEXR  # noqa: PLC0415 (100 ms to import; most runs read no EXR)

    encoded = read_file(path)
    try:
        with _muted():
            channels = OpenEXR.File(io.BytesIO(encoded), separate_channels=True).channels()
        planes = {name: np.asarray(channel.pixels) for name, channel in channels.items()}
    except Exception as error:  # the binding raises what OpenEXR's C++ throws
        raise InputError(path, "", "not an OpenEXR file, or a broken one") from error
    names = ("R", "G", "B") if {"R", "G", "B"} <= planes.keys() else ("Y", "Y", "Y")
    if names[0] not in planes:
        found = ", ".join(sorted(planes)) or "none"
        raise InputError(path, "", f"expected channels R, G, B or Y, found {found}")
    if len({planes[name].shape for name in names}) != 1:
        raise InputError(path, "", "channels of different size")
    return np.stack([planes[name].astype(np.float32) for name in names], axis=-1)


def write_png(path: Path, rgb8: npt.NDArray[np.uint8]) -> None:
    """Write (H, W, 3) or (H, W, 4) uint8 as PNG. The same pixels give the same bytes."""
    with atomic_file(path) as temporary:
        PIL.Image.fromarray(np.ascontiguousarray(rgb8)).save(temporary, format="PNG")


def write_exr(path: Path, rgb32f: npt.NDArray[np.float32]) -> None:
    """Write (H, W, 3) or (H, W, 4) float32 as OpenEXR, exactly. The same pixels, the same bytes."""
    import OpenEXR  # noqa: PLC0415 (100 ms to import; most runs write no EXR)

    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    pixels = np.ascontiguousarray(rgb32f, dtype=np.float32)
    channels = {"RGBA"[: pixels.shape[2]]: pixels}
    with atomic_file(path) as temporary:
        try:
            with _muted():
                OpenEXR.File(header, channels).write(str(temporary))
        except RuntimeError as error:  # a full disk, in OpenEXR's C++
            raise OSError(errno.EIO, "the disk is full, or failed") from error


def resized(pixels: npt.NDArray[np.float32], width: int, height: int) -> npt.NDArray[np.float32]:
    """(H, W, 3) resampled to (height, width, 3): means where it gets smaller."""
    kind = PIL.Image.Resampling.BOX if pixels.shape[0] >= height else PIL.Image.Resampling.BILINEAR
    planes = [PIL.Image.fromarray(pixels[..., c]).resize((width, height), kind) for c in range(3)]
    return np.stack([np.asarray(plane) for plane in planes], axis=-1)


def _unreadable(error: Exception, kinds: str) -> str:
    """Why Pillow could not decode an image, without its own words for our buffers."""
    if isinstance(error, PIL.UnidentifiedImageError):
        return f"not a {kinds} image"
    if isinstance(error, PIL.Image.DecompressionBombError):
        return "an image of too many pixels"
    return f"a broken {kinds} image"


@contextmanager
def _muted() -> Iterator[None]:
    """Nothing printed: OpenEXR tells Python's output and C's error stream what it raises, too."""
    with open(os.devnull, "wb") as nowhere:
        kept = os.dup(ERROR_DESCRIPTOR)
        os.dup2(nowhere.fileno(), ERROR_DESCRIPTOR)
    try:
        with redirect_stdout(io.StringIO()):
            yield
    finally:
        os.dup2(kept, ERROR_DESCRIPTOR)
        os.close(kept)


def _rgba8(image: PIL.Image.Image) -> npt.NDArray[np.uint8]:
    if image.mode.startswith("I") or image.mode == "F":
        # 16-bit grey: Pillow's own conversion to 8 bits clips instead of scaling.
        grey = np.asarray(image, dtype=np.float64) / 65535.0
        level = (np.clip(grey, 0.0, 1.0) * 255.0 + 0.5).astype(np.uint8)
        return np.stack([level, level, level, np.full_like(level, 255)], axis=-1)
    direct = image.mode in ("1", "L", "LA", "P", "PA", "RGB", "RGBA", "La", "RGBa", "RGBX")
    rgb = image if direct else image.convert("RGB")  # CMYK and the like
    rgba: npt.NDArray[Any] = np.asarray(rgb.convert("RGBA"), dtype=np.uint8)
    return rgba
