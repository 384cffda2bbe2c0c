"""Lens flares: sprites for bright texels, in order and within their room; copies of them."""

# PP-05, PP-06

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from elemental.gpu.formats import RGBA16F
from elemental.gpu.graph import Graph
from elemental.gpu.refs import AnyTexture, TextureHandle
from elemental.passes.post import lens_flare
from elemental.passes.post.lens_flare import REFLECTED, REFLECTIONS, lens_flares
from elemental.passes.post.scale import downsample
from gpu.post.conftest import MakeDarkroom
from gpu.post.darkroom import Array, Darkroom, flat

BLACK = {tint.replace(".", "__"): (0.0, 0.0, 0.0) for tint, _ in REFLECTIONS}
ON: dict[str, Any] = {"lens_flare__intensity": 16.0, **BLACK}
SHARE = 16.0 * REFLECTED
SHAPE = "lens_flare.bokeh_shape"
SIZE = (128, 256)


def one(position: float, tint: tuple[float, float, float] = (1.0, 1.0, 1.0)) -> dict[str, Any]:
    """One reflection of the eight, SHARE as bright as the light itself."""
    return {**ON, "lens_flare__tint1": tint, "lens_flare__position1": position}


def flares(room: Darkroom, pixels: Array) -> Array:
    """(H / 2, W / 2, 3) float64 light that is added, row 0 on top."""

    def passes(g: Graph, picture: AnyTexture, _: AnyTexture) -> TextureHandle:
        half = downsample(g, picture)
        exposed = room.history.eye.update(g, half, room.settings, None)
        history = room.history
        light = lens_flares(
            g,
            exposed,
            half,
            None,
            room.settings,
            shape=history.textures.mask(SHAPE, "bokeh_disc.png"),
            quad=history.quad,
            counted=history.sprites,
            width=picture.width,
        )
        assert light is not None
        return light

    return room.run(passes, pixels)[..., :3].astype(np.float64)


def lamps(*places: tuple[int, int], radiance: float = 1000.0) -> Array:
    """Black but for whole texels of the picture's quarter, 4x4 px each."""
    pixels = flat(*SIZE, 0.0)
    for row, column in places:
        pixels[row : row + 4, column : column + 4, :3] = radiance
    return pixels


def center(light: Array) -> tuple[float, float]:
    """(row, column) in px of the picture."""
    weight = light.sum(axis=2)
    rows, columns = np.mgrid[0 : weight.shape[0], 0 : weight.shape[1]] + 0.5
    total = weight.sum()
    return float(2 * (rows * weight).sum() / total), float(2 * (columns * weight).sum() / total)


@pytest.mark.parametrize("position", [0.75, 0.6, 0.31, 0.25, 0.15])
def test_a_copy_lies_on_the_line_through_the_centre(
    darkroom: MakeDarkroom, position: float
) -> None:
    row, column = center(flares(darkroom(**one(position)), lamps((48, 100))))
    size = 4 * (position - 0.5)
    assert row - 64 == pytest.approx(size * (50 - 64), abs=1.0)
    assert column - 128 == pytest.approx(size * (102 - 128), abs=1.0)


@pytest.mark.parametrize("bokeh_size", [0.0, 3.0, 10.0])
def test_a_sprite_keeps_the_light_above_the_threshold(
    darkroom: MakeDarkroom, bokeh_size: float
) -> None:
    """16 px of 1000 - 8, whatever the sprite's size."""
    room = darkroom(**one(0.75), lens_flare__bokeh_size=bokeh_size)
    light = flares(room, lamps((60, 124)))
    np.testing.assert_allclose(4 * light.sum(axis=(0, 1)), SHARE * 16 * 992.0, rtol=0.06)


def test_a_sprite_has_its_shape_and_size(darkroom: MakeDarkroom) -> None:
    room = darkroom(**one(0.75), lens_flare__bokeh_size=25.0)
    light = flares(room, lamps((60, 124)))[..., 0]
    lit = 2 * np.sqrt(4 * (light > 0.2 * light.max()).sum() / np.pi)
    assert lit == pytest.approx(0.25 * 256, rel=0.1)
    rim = light[31, 63 + 11 : 63 + 14].mean()
    assert rim > 1.15 * light[31, 63]  # the disc is brighter at its rim


def test_a_larger_copy_has_larger_sprites(darkroom: MakeDarkroom) -> None:
    """[Mittring12]: "Ideally for each lens reflection with different radius"."""
    room = darkroom(**one(0.75), lens_flare__bokeh_size=10.0)
    small = (flares(room, lamps((60, 124))) > 1.0).sum()
    room.set(lens_flare__position1=1.0)
    assert (flares(room, lamps((60, 124))) > 1.0).sum() == pytest.approx(4 * small, rel=0.15)


def test_copies_fade_at_the_pictures_border(darkroom: MakeDarkroom) -> None:
    room = darkroom(**one(0.25))
    inside, rim = (flares(room, lamps(place)).sum() for place in ((64, 100), (64, 12)))
    assert inside > 2.5 * rim > 0.0


def test_the_counters_tell_the_bright_texels(darkroom: MakeDarkroom) -> None:
    room = darkroom(**one(0.25))
    room.develop(lamps((0, 0), (60, 100), (124, 252)))
    room.device.finish()
    assert room.history.sprites.counters() == {"flare_sprites": 3, "flare_sprites_dropped": 0}
    room.develop(lamps((60, 100), radiance=7.9))
    room.device.finish()
    assert room.history.sprites.counters()["flare_sprites"] == 0


@pytest.mark.parametrize("bright", [1, 255, 256, 257, 2048])
def test_sprites_are_appended_in_order(darkroom: MakeDarkroom, bright: int) -> None:
    """The first texels of the quarter, row by row from below: each run's sprites follow."""
    texels = np.zeros(32 * 64)
    texels[:bright] = 100.0 + np.arange(bright) % 50
    pixels = flat(*SIZE, 0.0)
    upright = np.flipud(texels.reshape(32, 64)).repeat(4, axis=0).repeat(4, axis=1)
    pixels[..., :3] = upright[..., None]
    room = darkroom(**one(0.25))

    def passes(g: Graph, picture: AnyTexture, _: AnyTexture) -> TextureHandle:
        exposed = room.history.eye.update(g, None, room.settings, None)
        quarter = downsample(g, downsample(g, picture), "quarter")
        mask = room.history.textures.mask(SHAPE, "bokeh_disc.png")
        assert mask is not None
        block = lens_flare._block(room.settings, 1.0, mask, 2048)
        counts, sprites = lens_flare.append_sprites(g, exposed, quarter, block)
        g.read_later(counts, room.history.sprites.receive)
        return sprites

    sprites = room.run(passes, pixels)[::-1].reshape(-1, 4)[:bright]
    room.device.finish()
    assert room.history.sprites.drawn == bright
    np.testing.assert_array_equal(sprites[:, 3], np.arange(bright))
    np.testing.assert_allclose(sprites[:, 0], texels[:bright] - 8.0, rtol=2e-3)


def test_sprites_beyond_their_room_are_dropped_and_counted(
    darkroom: MakeDarkroom, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(lens_flare, "MOST_SPRITES", 300)
    room = darkroom(**one(0.25))
    room.develop(flat(*SIZE, 100.0))
    room.device.finish()
    dropped = 32 * 64 - 300
    want = {"flare_sprites": 300, "flare_sprites_dropped": dropped}
    assert room.history.sprites.counters() == want


def test_two_frames_are_the_same_to_the_bit(darkroom: MakeDarkroom) -> None:
    rng = np.random.default_rng(5)
    pixels = flat(*SIZE, 0.0)
    pixels[..., :3] = np.exp2(rng.uniform(0, 9, (*SIZE, 3)))
    room = darkroom(**one(0.3), lens_flare__bokeh_size=8.0)
    np.testing.assert_array_equal(flares(room, pixels), flares(room, pixels))


def test_they_show_in_the_picture_with_and_without_bloom(darkroom: MakeDarkroom) -> None:
    pixels = lamps((48, 100), radiance=8000.0)
    for intensity in (0.0, 1.0):
        plain = darkroom(bloom__intensity=intensity).develop(pixels).astype(int)
        room = darkroom(bloom__intensity=intensity, lens_flare__intensity=2.0)
        lit = room.develop(pixels).astype(int)
        assert (lit - plain)[70:90, 140:160].max() > 25
        assert (lit - plain).min() >= -1


@pytest.mark.parametrize(
    "off",
    [{"lens_flare__intensity": 0.0}, {"lens_flare__tint": (0.0, 0.0, 0.0)}, BLACK,
     {"lens_flare__bokeh_shape": ""}],
)  # fmt: skip
def test_what_is_off_does_not_run(darkroom: MakeDarkroom, off: dict[str, Any]) -> None:
    room = darkroom(**{"lens_flare__intensity": 1.0, **off})
    room.develop(lamps((4, 4)))
    assert room.passes() == ["post/tonemap"]


@pytest.mark.parametrize("size", [(1, 1), (2, 5)])
def test_the_smallest_pictures_work(darkroom: MakeDarkroom, size: tuple[int, int]) -> None:
    darkroom(lens_flare__intensity=1.0).develop(flat(*size, 50.0))


@pytest.mark.parametrize("radius", [1.0, 3.7])
def test_sums_of_the_brightest_sprites_are_numbers(darkroom: MakeDarkroom, radius: float) -> None:
    """A sprite at every texel, each brighter than a half float holds."""
    room = darkroom(**one(0.25), exposure=16.0)

    def passes(g: Graph, picture: AnyTexture, _: AnyTexture) -> TextureHandle:
        exposed = room.history.eye.update(g, None, room.settings, None)
        quarter = downsample(g, downsample(g, picture), "quarter")
        mask = room.history.textures.mask(SHAPE, "bokeh_disc.png")
        assert mask is not None
        block = lens_flare._block(room.settings, radius, mask, 2048)
        counts, sprites = lens_flare.append_sprites(g, exposed, quarter, block)
        quad = room.history.quad
        return lens_flare.draw_sprites(g, quarter, block, counts, sprites, mask, quad)

    light = room.run(passes, flat(*SIZE, 65504.0))[..., :3]
    assert light.max() < np.finfo(RGBA16F.dtype).max  # llvmpipe rounds to it, others to infinity
    assert light[8:-8, 8:-8].min() > 10_000.0


def test_light_has_half_floats(darkroom: MakeDarkroom) -> None:
    room = darkroom(**one(0.75))
    assert flares(room, lamps((60, 124), radiance=60000.0)).max() < np.finfo(RGBA16F.dtype).max
