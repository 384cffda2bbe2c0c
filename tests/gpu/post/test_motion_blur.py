"""Motion blur: the length and the energy of streaks, by the camera and by what moves. PP-12"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from elemental.core import transforms
from elemental.core.layout import Block, layouts, pack
from elemental.frame import Renderer
from elemental.gpu.device import Device
from elemental.gpu.graph import Graph
from elemental.gpu.refs import AnyTexture, TextureHandle
from elemental.passes.post.motion_blur import longest_streaks, motion_blur
from elemental.scene.extent import settle
from elemental.scene.model import Camera
from elemental.scene.motion import RigBuilder
from elemental.settings import Settings
from gpu.moving import slide
from gpu.post.conftest import MakeDarkroom
from gpu.post.darkroom import PLAIN, Array, Darkroom, flat
from gpu.post.test_dof import depth_at
from gpu.rig import IDENTITY, at, camera, material, mesh, scene, vector
from shapes import box

OPEN: dict[str, Any] = {"motion_blur__amount": 1.0, "motion_blur__max": 30.0}
SIZE = (96, 160)
DISTANCE = 10.0


def looking_from(x: float, y: float = 0.0) -> Camera:
    matrix = transforms.inverse(transforms.look_at((x, y, 0), (x, y, -1)))
    return Camera("test", matrix, 0.8, 0.1, 100.0)


def px_per_metre() -> float:
    """Of a wall at DISTANCE."""
    return float(SIZE[0] / (2 * DISTANCE * np.tan(0.4)))


def streaks(room: Darkroom, pixels: Array, way_px: tuple[float, float]) -> Array:
    """(H, W, 3) of a wall at DISTANCE that the camera makes move by so many px right and up."""

    def view(camera_: Camera) -> Block:
        room.camera = camera_
        return room.view((SIZE[1], SIZE[0]))

    before = view(looking_from(0.0))
    now = view(looking_from(*(-way / px_per_metre() for way in way_px)))

    def passes(g: Graph, picture: AnyTexture, behind: AnyTexture) -> TextureHandle:
        source: Any = picture
        return motion_blur(g, now, before, source, behind, room.settings)

    return room.run(passes, pixels, np.full(SIZE, depth_at(DISTANCE)))[..., :3].astype(np.float64)


def post() -> Array:
    """A bright line down the middle."""
    pixels = flat(*SIZE, 0.0)
    pixels[:, 80, :3] = 100.0
    return pixels


@pytest.mark.parametrize("shutter", [1.0, 0.5])
@pytest.mark.parametrize("way_px", [12.0, -24.0])
def test_a_line_becomes_a_streak_of_its_way(
    darkroom: MakeDarkroom, shutter: float, way_px: float
) -> None:
    room = darkroom(**OPEN)
    room.set(motion_blur__amount=shutter)
    got = streaks(room, post(), (way_px, 0.0))[20:76, :, 0].mean(axis=0)
    lit = np.flatnonzero(got > 0.5)
    length = abs(way_px) * shutter
    assert lit[-1] - lit[0] + 1 == pytest.approx(length, abs=2.5)
    assert lit.mean() == pytest.approx(80, abs=1.0)  # about where it is [McGuire12]
    assert got.sum() == pytest.approx(100.0, rel=0.4)


def test_a_streak_follows_its_direction(darkroom: MakeDarkroom) -> None:
    got = streaks(darkroom(**OPEN), post(), (0.0, 20.0))
    np.testing.assert_allclose(got, post()[..., :3], atol=0.1)  # along the line nothing changes


def test_streaks_have_a_longest(darkroom: MakeDarkroom) -> None:
    room = darkroom(**OPEN)
    room.set(motion_blur__max=5.0)
    lit = np.flatnonzero(streaks(room, post(), (40.0, 0.0))[20:76, :, 0].mean(axis=0) > 0.5)
    assert lit[-1] - lit[0] + 1 == pytest.approx(0.05 * SIZE[1], abs=2.5)


def test_flat_areas_keep_their_radiance(darkroom: MakeDarkroom) -> None:
    got = streaks(darkroom(**OPEN), flat(*SIZE, 3.0), (15.0, 7.0))
    np.testing.assert_allclose(got, 3.0, rtol=2e-3)


def test_a_first_frame_a_still_one_and_one_after_a_cut_run_nothing(darkroom: MakeDarkroom) -> None:
    room = darkroom(**OPEN)

    def blurs(x: float, time_s: float) -> bool:
        room.camera = looking_from(x)
        room.develop(flat(8, 8, 1.0), time_s)
        return "post/motion_blur" in room.passes()

    assert not blurs(0.0, 0.0)
    assert not blurs(0.0, 0.1)
    assert blurs(1.0, 0.2)
    assert not blurs(2.0, 5.0)  # a cut
    room.set(motion_blur__amount=0.0)
    assert not blurs(3.0, 5.1)


def test_the_longest_streak_of_each_tile_is_found(darkroom: MakeDarkroom) -> None:
    """Down columns, then along rows, tiles at the edges cut short: as one search finds it."""
    tile, (height, width) = 7, (25, 38)
    motion = np.random.default_rng(3).normal(0.0, 4.0, (height, width, 4)).astype(np.float16)

    block = pack(
        layouts().block("Motion"),
        prev_clip_from_world=np.eye(4), shutter=1.0, most_px=float(tile), tile=tile,
    )  # fmt: skip

    def passes(g: Graph, picture: AnyTexture, _: AnyTexture) -> TextureHandle:
        found: Any = longest_streaks(g, picture, block)
        return found

    room = darkroom()
    got = room.run(passes, motion)[::-1, :, :2]
    upright = motion[::-1, :, :2].astype(np.float64)
    assert got.shape[:2] == (4, 6)
    for row, column in np.ndindex(got.shape[:2]):
        part = upright[row * tile : (row + 1) * tile, column * tile : (column + 1) * tile]
        streaks_px = part.reshape(-1, 2)
        longest = streaks_px[np.argmax((streaks_px**2).sum(axis=1))]
        np.testing.assert_array_equal(got[row, column], longest)
    assert room.passes() == ["post/motion_longest.y", "post/motion_longest.x"]


def test_what_moves_streaks_and_the_rest_stays(device: Device) -> None:
    """A white box passes before a grey wall; the camera stands."""
    glow = [
        material(base_color=vector(0, 0, 0, 1), emissive=vector(level, level, level))
        for level in (1.0, 0.1)
    ]
    made = scene(
        (mesh(box((1, 1, 0.2)), 0), IDENTITY),
        (mesh(box((20, 20, 0.2)), 1), at(0, 0, -2)),
        materials=glow,
    )
    builder = RigBuilder()
    node = builder.node()
    builder.tracks = [slide(node, (-3, 0, 0), (3, 0, 0))]
    made.instances[0].dynamic, made.instances[0].node = True, node
    made.instances.reverse()
    made.motion = builder.motion()
    settle(made)
    words = {"gi.enabled": False, "motion_blur.amount": 1.0, "motion_blur.max": 50.0}
    off = {"bloom.intensity": 0.0, "lens_flare.intensity": 0.0}
    eye = camera(vector(0, 0, 8), vector(0, 0, 0))
    pictures = {}
    for amount in (0.0, 1.0):
        settings = Settings({**PLAIN, **off, **words, "motion_blur.amount": amount})
        renderer = Renderer(device, made, settings, (160, 90))
        renderer.render(eye, 0.4, 0)
        pictures[amount] = renderer.read(renderer.render(eye, 0.5, 1)).astype(int)
        device.finish()
        names = [timing.name for timing in device.timings]
        assert ("post/motion_objects" in names) == (amount > 0.0)
        renderer.release()
    sharp, blurred = (pictures[amount][41:50, :, 0].mean(axis=0) for amount in (0.0, 1.0))
    way_px = 0.6 * 90 / (2 * (8 - 0.1) * np.tan(0.4))
    widths = [int((row > row.min() + 8).sum()) for row in (sharp, blurred)]
    assert widths[1] - widths[0] == pytest.approx(way_px, rel=0.35)
    edge = np.flatnonzero(blurred > blurred.min() + 8)[:4]
    assert np.all(np.diff(blurred[edge]) > 0)
    above = pictures[1.0][10] - pictures[0.0][10]
    assert np.abs(above).max() <= 1


def test_it_is_off_by_default() -> None:
    assert Settings()["motion_blur.amount"] == 0.0
