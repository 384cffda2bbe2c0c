"""Radiance's RGBE pictures (.hdr): shared-exponent pixels, flat or run-length encoded.

Format: Ward, "Real Pixels", Graphics Gems II, 1991, and Radiance's `color.c` and `resolu.h`.
"""

from __future__ import annotations

import re

import numpy as np
import numpy.typing as npt

MAX_SIDE = 1 << 15
MIN_RLE_WIDTH = 8
MAX_RLE_WIDTH = 0x7FFF
MAX_HEADER_BYTES = 1 << 16
MAX_RUN = 128
"""A count above this starts a run of count - 128 equal bytes, others a stretch of plain bytes."""

_RESOLUTION = re.compile(rb"([+-])Y (\d{1,9}) ([+-])X (\d{1,9})\Z")


def decode_rgbe(encoded: bytes) -> npt.NDArray[np.float32]:
    """Decode an .hdr file to (H, W, 3) float32 radiance, row 0 at the top.

    EXPOSURE lines are divided out. Raises ValueError with a reason for a malformed file,
    for XYZE pixels, for transposed scanlines and for Radiance's old run-length encoding.
    """
    height, width, flip_rows, flip_columns, exposure, start = _read_header(encoded)
    body = np.frombuffer(encoded, np.uint8, offset=start)
    is_rle = (
        MIN_RLE_WIDTH <= width <= MAX_RLE_WIDTH
        and len(body) >= 4
        and body[0] == 2
        and body[1] == 2
        and body[2] < 128
    )
    rgbe = _decode_runs(encoded[start:], height, width) if is_rle else _flat(body, height, width)
    if flip_rows:
        rgbe = rgbe[::-1]
    if flip_columns:
        rgbe = rgbe[:, ::-1]
    # Radiance's colr_color takes the middle of the mantissa's step, (m + 0.5) / 256; exponent 0
    # means black.
    scale = np.ldexp(np.float32(1.0), rgbe[..., 3].astype(np.int32) - (128 + 8))
    scale = np.where(rgbe[..., 3] == 0, np.float32(0.0), scale / np.float32(exposure))
    radiance = (rgbe[..., :3].astype(np.float32) + np.float32(0.5)) * scale[..., None]
    return np.ascontiguousarray(radiance, dtype=np.float32)


def encode_rgbe(radiance: npt.NDArray[np.float32], *, run_length: bool = True) -> bytes:
    """Encode (H, W, 3) float32 radiance as an .hdr file: 8 bits of the largest channel."""
    height, width = radiance.shape[:2]
    largest = radiance.max(axis=-1)
    mantissa, exponent = np.frexp(largest)
    scale = np.where(largest > 1e-32, mantissa * 256.0 / np.maximum(largest, 1e-38), 0.0)
    rgbe = np.empty((height, width, 4), np.uint8)
    rgbe[..., :3] = np.clip(radiance * scale[..., None], 0, 255)
    rgbe[..., 3] = np.where(largest > 1e-32, exponent + 128, 0)
    header = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + f"-Y {height} +X {width}\n".encode()
    if not run_length or not MIN_RLE_WIDTH <= width <= MAX_RLE_WIDTH:
        return header + rgbe.tobytes()
    rows = (_encode_row(row) for row in rgbe)
    return header + b"".join(rows)


def _read_header(encoded: bytes) -> tuple[int, int, bool, bool, float, int]:
    if not encoded.startswith((b"#?RADIANCE", b"#?RGBE")):
        raise ValueError("not a Radiance .hdr file (no #?RADIANCE in the first line)")
    end = encoded.find(b"\n\n", 0, MAX_HEADER_BYTES)
    line_end = encoded.find(b"\n", end + 2, end + 2 + 128) if end >= 0 else -1
    if line_end < 0:
        raise ValueError("the .hdr header has no end")
    exposure = 1.0
    for line in encoded[:end].split(b"\n")[1:]:
        key, _, value = line.partition(b"=")
        if key == b"FORMAT" and value.strip() != b"32-bit_rle_rgbe":
            name = value.strip().decode("ascii", "replace")
            raise ValueError(f"pixel format {name!r} is unknown")
        if key == b"EXPOSURE":
            exposure *= _positive(value)
    match = _RESOLUTION.match(encoded[end + 2 : line_end])
    if match is None:
        raise ValueError("expected a resolution line like '-Y 512 +X 1024'")
    height, width = int(match[2]), int(match[4])
    if not (0 < height <= MAX_SIDE and 0 < width <= MAX_SIDE):
        raise ValueError(f"{width} x {height} pixels are out of range")
    return height, width, match[1] == b"+", match[3] == b"-", exposure, line_end + 1


def _positive(text: bytes) -> float:
    try:
        value = float(text)
    except ValueError:
        value = float("nan")
    if not 0.0 < value < float("inf"):
        raise ValueError(f"EXPOSURE {text.decode('ascii', 'replace')!r} is no positive number")
    return value


def _flat(body: npt.NDArray[np.uint8], height: int, width: int) -> npt.NDArray[np.uint8]:
    if len(body) < height * width * 4:
        raise ValueError("the pixels are cut short")
    rgbe = body[: height * width * 4].reshape(height, width, 4)
    if (rgbe[..., :3] == 1).all(axis=-1).any() and len(body) != height * width * 4:
        raise ValueError("Radiance's old run-length encoding is not supported")
    return rgbe


def _decode_runs(body: bytes, height: int, width: int) -> npt.NDArray[np.uint8]:
    """New-style run-length encoding: each scanline 2, 2, width, then its four planes in turn."""
    if len(body) < height * 4:
        raise ValueError("the pixels are cut short")
    planes = np.empty((height, 4 * width), np.uint8)
    marker = bytes((2, 2, width >> 8, width & 255))
    at = 0
    for y in range(height):
        if body[at : at + 4] != marker:
            raise ValueError(f"scanline {y} does not start with its width")
        row, at = _decode_row(body, at + 4, width)
        planes[y] = np.frombuffer(row, np.uint8)
    return planes.reshape(height, 4, width).transpose(0, 2, 1)


def _decode_row(body: bytes, at: int, width: int) -> tuple[bytearray, int]:
    row = bytearray()
    end = 0
    try:
        for _ in range(4):
            end += width
            while len(row) < end:
                count = body[at]
                if count > MAX_RUN:
                    count -= MAX_RUN
                    row += body[at + 1 : at + 2] * count
                    at += 2
                else:
                    row += body[at + 1 : at + 1 + count]
                    at += 1 + count
                if at > len(body):
                    raise IndexError
                if count == 0:
                    raise ValueError("the run-length encoding is broken")
            if len(row) > end:
                raise ValueError("a run crosses the end of its scanline")
    except IndexError:
        raise ValueError("the pixels are cut short") from None
    return row, at


def _encode_row(row: npt.NDArray[np.uint8]) -> bytes:
    width = len(row)
    encoded = bytearray((2, 2, width >> 8, width & 255))
    for plane in row.T:
        edges = np.flatnonzero(np.diff(plane)) + 1
        starts = np.concatenate(([0], edges))
        lengths = np.diff(np.concatenate((starts, [width])))
        for start, length in zip(starts.tolist(), lengths.tolist(), strict=True):
            for offset in range(0, length, 127):
                encoded += bytes((MAX_RUN + min(127, length - offset), int(plane[start])))
    return bytes(encoded)
