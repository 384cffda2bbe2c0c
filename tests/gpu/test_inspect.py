"""PP-02: any target of a frame as a picture and as exact values: level, layer, channel, range."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from elemental.gpu import formats
from elemental.gpu.device import Device
from elemental.gpu.formats import R32UI, RGBA8, RGBA16F, RGBA32F, Format
from elemental.gpu.resources import Texture
from elemental.passes.inspect import Inspector, Look, Target

SIZE = (6, 4)


@pytest.fixture
def inspector(device: Device) -> Iterator[Inspector]:
    made = Inspector(device)
    made.size = (12, 8)
    yield made
    made.release()


def look_at(texture: Texture, **how: Any) -> Look:
    """A look at a texture, two pixels a texel."""
    target = Target(texture.name, texture.desc.size, texture.format.name)
    return Look(target, step=0.5, **{"colors": "Plain", **how})


def shown(device: Device, inspector: Inspector, texture: Texture, look: Look) -> npt.NDArray[Any]:
    """(H, W, 3) float codes of the picture, row 0 at the bottom; a frame that has the texture."""
    inspector.look = look
    g = device.begin_frame()
    g.keep(texture)
    inspector.add(g)
    g.execute()
    device.finish()
    inspector.after_frame()
    assert inspector.picture is not None
    return np.asarray(inspector.picture.read()[..., :3] / 255.0)


def ramp(channels: int = 4) -> npt.NDArray[np.float32]:
    """(H, W, C) float32, a value of its own everywhere."""
    count = SIZE[0] * SIZE[1] * channels
    return (np.arange(count, dtype=np.float32) / count).reshape(SIZE[1], SIZE[0], channels)


def test_texels_are_squares_over_a_range(device: Device, inspector: Inspector) -> None:
    values = ramp()
    texture = device.texture("looked", SIZE, RGBA32F, data=values)
    doubled = values.repeat(2, axis=0).repeat(2, axis=1)
    image = shown(device, inspector, texture, look_at(texture))
    assert np.abs(image - doubled[..., :3]).max() <= 0.51 / 255
    for channel, name in enumerate("RGBA"):
        look = look_at(texture, channel=name, low=0.25, high=0.75)
        image = shown(device, inspector, texture, look)
        expected = np.clip((doubled[..., channel] - 0.25) / 0.5, 0, 1)
        assert np.abs(image - expected[..., None]).max() <= 0.51 / 255
    texture.release()


def test_a_texel_tells_its_exact_values(device: Device, inspector: Inspector) -> None:
    values = ramp() * np.pi
    texture = device.texture("looked", SIZE, RGBA32F, data=values)
    for texel in ((0, 0), (5, 3), (2, 1)):
        shown(device, inspector, texture, look_at(texture, probe=texel))
        assert inspector.probed is not None
        assert inspector.probed.texel == texel
        assert np.array_equal(np.float32(inspector.probed.values), values[texel[1], texel[0]])
    words = np.arange(24, dtype=np.uint32).reshape(4, 6) + np.uint32(2**31 + 1)
    counts = device.texture("counts", SIZE, R32UI, data=words)
    shown(device, inspector, counts, look_at(counts, probe=(3, 2)))
    assert inspector.probed.words is not None
    assert inspector.probed.words[0] == words[2, 3]  # beyond what a float holds
    texture.release()
    counts.release()


def test_levels_layers_and_slices(device: Device, inspector: Inspector) -> None:
    mips = device.texture("mips", (8, 8), RGBA8, mips=3)
    for level, code in enumerate((10, 120, 250)):
        side = 8 >> level
        mips.write(np.full((side, side, 4), code, np.uint8), level)
    layers = device.texture("layers", SIZE, RGBA8, layers=3)
    for layer in range(3):
        layers.write(np.full((4, 6, 4), 50 * layer + 20, np.uint8), layer=layer)
    volume = device.texture("volume", (6, 4, 3), RGBA16F)
    volume.write(np.repeat(np.float16([0.25, 0.5, 1.0]), 6 * 4 * 4).reshape(3, 4, 6, 4))
    for level, code in enumerate((10, 120, 250)):
        image = shown(device, inspector, mips, look_at(mips, level=level))
        assert image[0, 0, 0] == code / 255
        assert (image[:, 2 * (8 >> level) :] < 0.1).all()  # beyond its edge
    for layer in range(3):
        image = shown(device, inspector, layers, look_at(layers, layer=layer))
        assert image[0, 0, 0] == (50 * layer + 20) / 255
        image = shown(device, inspector, volume, look_at(volume, layer=layer))
        assert abs(image[0, 0, 0] - (0.25, 0.5, 1.0)[layer]) < 0.5 / 255 + 1e-6
    for texture in (mips, layers, volume):
        texture.release()


def test_what_is_not_a_number_stands_out(device: Device, inspector: Inspector) -> None:
    values = np.full((4, 6, 4), 0.5, np.float32)
    values[0, 0] = np.nan
    values[1, 0, 1] = np.inf
    texture = device.texture("broken", SIZE, RGBA32F, data=values)
    image = shown(device, inspector, texture, look_at(texture))
    assert image[0, 0].tolist() == [1, 0, 1]
    assert image[2, 0].tolist() == [1, 0, 1]
    assert abs(image[5, 5] - 0.5).max() < 1 / 255
    texture.release()


def test_a_frozen_look_keeps_what_was(device: Device, inspector: Inspector) -> None:
    texture = device.texture("live", SIZE, RGBA32F, data=np.full((4, 6, 4), 0.25, np.float32))
    look = look_at(texture)
    inspector.freeze(True)
    shown(device, inspector, texture, look)
    texture.write(np.full((4, 6, 4), 0.75, np.float32))
    image = shown(device, inspector, texture, replace(look, channel="R"))
    assert abs(image[0, 0, 0] - 0.25) < 1 / 255
    held = device.bytes()
    inspector.freeze(False)
    assert sum(device.bytes().values()) < sum(held.values())
    image = shown(device, inspector, texture, look)
    assert abs(image[0, 0, 0] - 0.75) < 1 / 255
    texture.release()


@pytest.mark.parametrize("fmt", [RGBA32F, RGBA16F, RGBA8, formats.RGB10_A2, formats.R32F, R32UI])
def test_captured_values_are_what_shaders_read(
    device: Device, inspector: Inspector, fmt: Format
) -> None:
    raw = np.random.default_rng(7).integers(0, 2**32, (4, 6, fmt.channels), np.uint64)
    if fmt.dtype.kind == "f":
        raw = raw / 2**32
    texture = device.texture("captured", SIZE, fmt, data=raw.astype(fmt.dtype))
    got: list[npt.NDArray[Any]] = []
    inspector.capture(got.append)
    shown(device, inspector, texture, look_at(texture, probe=(4, 1)))
    assert inspector.probed is not None
    count = got[0].shape[2]
    assert got[0].dtype == np.float32
    assert np.allclose(got[0][4 - 1 - 1, 4], inspector.probed.values[:count], rtol=1e-7, atol=0)
    texture.release()


def test_nothing_is_held_or_run_while_nobody_looks(device: Device) -> None:
    before = device.bytes()
    inspector = Inspector(device)
    g = device.begin_frame()
    inspector.add(g)
    assert not g.passes
    g.execute()
    inspector.look = Look(Target("nowhere", (1, 1), "RGBA8"))
    g = device.begin_frame()
    inspector.add(g)
    assert not g.passes
    assert not inspector.found
    g.execute()
    assert device.bytes() == before
    inspector.release()
