"""Golden pictures of the whole frame on the software driver, made by `tools/update_goldens.py`."""

# GI-07, GI-12, SH-01, SH-09, AP-02: the frame as a whole

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

from elemental.core.images import read_png_jpeg_webp, write_png
from elemental.gpu.device import Device
from image.golden_scenes import SCENES, draw

GOLDEN = Path(__file__).parent / "golden"
TOLERANCE = 2
"""Display codes a channel; other versions of the driver round otherwise."""
STRAY_SHARE = 1e-3
"""Share of the pixels that may differ by more."""


def stray_share(ours: npt.NDArray[np.uint8], golden: npt.NDArray[np.uint8]) -> float:
    """Share of the pixels with a channel that is off by more than TOLERANCE."""
    difference = np.abs(ours.astype(int) - golden.astype(int)).max(axis=2)
    return float((difference > TOLERANCE).mean())


@pytest.mark.parametrize("name", SCENES)
def test_the_picture_is_the_golden_one(device: Device, name: str, tmp_path: Path) -> None:
    assert device.info.software, "goldens hold for the software driver; GPUs round differently"
    ours = draw(device, name)
    golden = read_png_jpeg_webp(GOLDEN / f"{name}.png")[..., :3]
    share = stray_share(ours, golden)
    if share > STRAY_SHARE:
        write_png(tmp_path / f"{name}.png", ours)
    assert share <= STRAY_SHARE, f"{share:.2%} of the pixels differ: {tmp_path / name}.png"


def test_indirect_light_colours_the_room(device: Device) -> None:
    """Red from the red wall, green from the green one; nothing of it without GI."""
    lit, direct = draw(device, "colored_room").astype(int), draw(device, "colored_room_direct")
    width = lit.shape[1]
    left, right = lit[:, : width // 2], lit[:, width // 2 :]
    assert (left[..., 0] - left[..., 1]).mean() > (right[..., 0] - right[..., 1]).mean() + 5
    assert direct.mean() < 0.25 * lit.mean()


def test_the_comparison_notices_a_shifted_picture() -> None:
    golden = read_png_jpeg_webp(GOLDEN / "colored_room.png")[..., :3]
    assert stray_share(np.roll(golden, 1, axis=1), golden) > 10 * STRAY_SHARE
    assert stray_share(np.clip(golden.astype(int) + 3, 0, 255).astype(np.uint8), golden) > 0.5
