"""Bloom: its energy, its kernels, the dirt that it lights up. PP-04"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from elemental.gpu.graph import Graph
from elemental.gpu.refs import AnyTexture, TextureHandle
from elemental.passes.post.bloom import KERNELS, bloom, blur_block
from elemental.passes.post.scale import downsample
from gpu.post.conftest import MakeDarkroom
from gpu.post.darkroom import Array, Darkroom, flat

TINTS = {tint.replace(".", "__"): (1.0, 1.0, 1.0) for _, tint in KERNELS}
BLACK = dict.fromkeys(TINTS, (0.0, 0.0, 0.0))


def spread(room: Darkroom, pixels: Array) -> Array:
    """(H / 2, W / 2, 3) float64 light that bloom adds to a picture."""

    def passes(g: Graph, picture: AnyTexture, _: AnyTexture) -> TextureHandle:
        half = downsample(g, picture)
        exposed = room.history.eye.update(g, half, room.settings, None)
        light = bloom(g, exposed, half, room.settings, picture.width)
        assert light is not None
        return light

    return room.run(passes, pixels)[..., :3].astype(np.float64)


def lamp(height: int, width: int, row: int, column: int, radiance: float = 4000.0) -> Array:
    """(H, W, 4): black but for one texel."""
    pixels = flat(height, width, 0.0)
    pixels[row, column, :3] = radiance
    return pixels


@pytest.mark.parametrize("size", [(256, 512), (180, 320), (181, 323)])
@pytest.mark.parametrize("place", [(0.5, 0.5), (0.45, 0.55)])
def test_a_point_light_keeps_its_energy(
    darkroom: MakeDarkroom, size: tuple[int, int], place: tuple[float, float]
) -> None:
    """Within 1 %, whatever the sizes of the kernels and of the picture, odd levels too."""
    row, column = (int(share * extent) for share, extent in zip(place, size, strict=True))
    room = darkroom(bloom__intensity=8.0, bloom__threshold=-1.0, **TINTS)
    room.set(bloom__size5=32.0, bloom__size6=32.0)  # the widest would reach over the edge
    light = spread(room, lamp(*size, row, column))
    np.testing.assert_allclose(4 * light.sum(axis=(0, 1)), 4000.0, rtol=0.01)


@pytest.mark.parametrize("number", range(1, 7))
def test_each_kernel_keeps_its_sixth(darkroom: MakeDarkroom, number: int) -> None:
    room = darkroom(bloom__intensity=8.0, bloom__threshold=-1.0, **BLACK)
    room.set(**{f"bloom__tint{number}": (1.0, 0.5, 0.0)})
    light = spread(room, lamp(512, 512, 251, 262))
    np.testing.assert_allclose(4 * light.sum(axis=(0, 1)), [4000 / 6, 2000 / 6, 0], rtol=0.01)


def deviation(light: Array) -> float:
    """Standard deviation along x of where light is, texels."""
    across = light.sum(axis=(0, 2))
    places = np.arange(len(across))
    center = (across @ places) / across.sum()
    return float(np.sqrt(across @ (places - center) ** 2 / across.sum()))


def test_a_kernel_has_its_size(darkroom: MakeDarkroom) -> None:
    """Its diameter, six deviations, is its size in per cent of the width."""
    room = darkroom(bloom__intensity=8.0, bloom__threshold=-1.0, **BLACK)
    room.set(bloom__tint2=(1.0, 1.0, 1.0), bloom__size2=16.0)
    got = deviation(spread(room, lamp(256, 512, 128, 256)))
    assert got == pytest.approx(0.16 * 256 / 6, rel=0.05)


def test_wider_kernels_reach_farther(darkroom: MakeDarkroom) -> None:
    widths = []
    for number in range(1, 7):
        room = darkroom(bloom__intensity=8.0, bloom__threshold=-1.0, **BLACK)
        room.set(**{f"bloom__tint{number}": (1.0, 1.0, 1.0)})
        widths.append(deviation(spread(room, lamp(256, 512, 128, 256))))
    assert np.all(np.diff(widths[:5]) > 0)


def test_only_what_exceeds_the_threshold_blooms(darkroom: MakeDarkroom) -> None:
    room = darkroom(bloom__intensity=8.0, bloom__threshold=1.0, **TINTS)
    assert spread(room, flat(32, 64, 0.9)).max() == 0.0
    np.testing.assert_allclose(spread(room, flat(32, 64, 3.0)), 2.0, rtol=5e-3)
    room.set(exposure=1.0)  # exposed radiance counts
    np.testing.assert_allclose(spread(room, flat(32, 64, 0.9)), 0.8, rtol=1e-2)


def test_the_gaussian_is_one_however_wide() -> None:
    for radius in (0.3, 0.6, 1.0, 5.5, 20.0, 64.0, 500.0):
        block = blur_block(radius, (1.0, 0.0), (1.0, 1.0, 1.0))
        weights = block["pairs"][:, 1]
        assert block["center"] + 2 * weights.sum() == pytest.approx(1.0, abs=1e-6)
        assert block["count"] == (0 if radius < 0.5 else min(-(-int(np.ceil(radius)) // 2), 32))
        places = block["pairs"][: int(block["count"]), 0]
        assert np.all(np.diff(places) > 1.5)


def test_dirt_shows_where_bloom_falls(darkroom: MakeDarkroom) -> None:
    pixels = lamp(64, 96, 32, 48, 2000.0)
    words: dict[str, Any] = {"bloom__intensity": 8.0, "bloom__dirt_mask": "dirt.png"}
    clean = darkroom(bloom__intensity=8.0).develop(pixels).astype(int)
    dirty = darkroom(**words, bloom__dirt_intensity=8.0).develop(pixels).astype(int)
    none = darkroom(**words, bloom__dirt_intensity=0.0).develop(pixels).astype(int)
    assert (dirty - clean).min() >= -1
    assert (dirty - clean).max() > 20
    np.testing.assert_array_equal(none, clean)


def test_without_intensity_or_tints_nothing_runs(darkroom: MakeDarkroom) -> None:
    room = darkroom()
    room.develop(flat(8, 8, 9.0))
    assert room.passes() == ["post/tonemap"]
    room.set(bloom__intensity=8.0, **BLACK)
    room.develop(flat(8, 8, 9.0))
    assert room.passes() == ["post/tonemap"]


def test_levels_that_no_tint_asks_for_do_not_run(darkroom: MakeDarkroom) -> None:
    room = darkroom(bloom__intensity=8.0, **BLACK)
    room.set(bloom__tint2=(1.0, 1.0, 1.0))
    room.develop(flat(64, 64, 9.0))
    assert "bloom.down1" in room.passes()
    assert "bloom.down2" not in room.passes()


@pytest.mark.parametrize("size", [(1, 1), (1, 7), (3, 2)])
def test_the_smallest_pictures_bloom(darkroom: MakeDarkroom, size: tuple[int, int]) -> None:
    room = darkroom(bloom__intensity=8.0, **TINTS)
    np.testing.assert_allclose(spread(room, flat(*size, 3.0)), 2.0, rtol=1e-2)
