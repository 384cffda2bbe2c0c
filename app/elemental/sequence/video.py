"""A sequence of pictures as an .mp4, by the ffmpeg that comes with imageio-ffmpeg (an extra)."""

from __future__ import annotations

import subprocess
from pathlib import Path

from elemental.core.errors import InputError
from elemental.core.files import atomic_file

QUALITY_CRF = 16
"""Constant rate factor of x264: 0 is lossless, 18 is called visually lossless [x264 manual]."""


def find_ffmpeg() -> str:
    """Path of the encoder. Raises InputError where the extra is not installed."""
    try:
        import imageio_ffmpeg  # noqa: PLC0415 (an extra)
    except ImportError:
        reason = "an .mp4 needs imageio-ffmpeg: pip install 'elemental[video]'"
        raise InputError("-o", "", reason) from None
    try:
        return str(imageio_ffmpeg.get_ffmpeg_exe())
    except RuntimeError as error:
        raise InputError(
            "-o", "", f"imageio-ffmpeg has no encoder for this machine ({error})"
        ) from error


def encode(ffmpeg: str, frames: Path, first: int, count: int, fps: float, video: Path) -> None:
    """Write ``video`` from PNGs named by a printf pattern, whole or not at all.

    Display values go to BT.709 with sRGB's transfer curve, 4:2:0. Raises InputError.
    """
    folder = str(frames.parent.resolve()).replace("%", "%%")  # whole: a colon would be a protocol
    with atomic_file(video.resolve()) as temporary:
        command = [
            ffmpeg, "-y", "-v", "error", "-nostdin",
            "-framerate", f"{fps:.6f}", "-start_number", str(first),
            "-i", f"{folder}/{frames.name}",
            "-frames:v", str(count),
            "-vf", "scale=in_range=full:out_range=tv:out_color_matrix=bt709,format=yuv420p",
            "-c:v", "libx264", "-crf", str(QUALITY_CRF),
            "-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "iec61966-2-1",
            "-fflags", "+bitexact", "-flags:v", "+bitexact", "-movflags", "+faststart",
            str(temporary),
        ]  # fmt: skip
        ran = subprocess.run(command, capture_output=True, text=True, errors="replace", check=False)
        if ran.returncode != 0:
            last = (ran.stderr.strip() or "no reason given").splitlines()[-1]
            raise InputError("-o", str(video), f"can't be encoded ({last})")
