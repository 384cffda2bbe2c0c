# GI-12
"""The diffuse cones: a furnace, and the 3x3 pattern that must not be seen.

Frames of the whole renderer, looked at as irradiance / pi.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from elemental.core.paths import glsl_root
from elemental.frame import Renderer
from elemental.gpu.device import Device
from elemental.gpu.formats import RGBA16F
from elemental.passes.camera_view import pack_view
from elemental.passes.cone_trace.diffuse import (
    SHARED_SPLIT,
    SPLITS,
    combine_diffuse,
    share_cones,
)
from elemental.passes.gbuffer import draw_gbuffer
from elemental.passes.scene_gpu import GpuScene
from elemental.scene.model import Camera, Environment, Scene
from elemental.settings import Settings
from gpu.rig import IDENTITY, camera, mesh, read, scene, vector
from gpu.voxel.scenes import facing
from shapes import box, quad, sphere

Array = npt.NDArray[Any]
Draw = Callable[..., Array]

SIZE = (96, 72)
WHITE = Environment(None, vector(1, 1, 1), 1.0)
FURNACE_ERROR = 0.02


@pytest.fixture
def diffuse_gi(device: Device) -> Iterator[Draw]:
    """Maker of the view diffuse_gi: (H, W, 4) float32, NaN where there is no surface."""
    made: list[Renderer] = []

    def draw(world: Scene, eye: Camera, size: tuple[int, int] = SIZE, **words: Any) -> Array:
        words = {"gi.resolution": 64, "shadow.resolution": 256, **words}
        renderer = Renderer(device, world, Settings(words), size)
        made.append(renderer)
        image = renderer.read(renderer.render(eye, 0.0, 0, "diffuse_gi")).copy()
        surface = renderer.read(renderer.render(eye, 0.0, 0, "scene_color"))[..., 3] > 0.5
        image[~surface] = np.nan
        return image

    yield draw
    for item in made:
        item.release()


def ball(environment: Environment) -> tuple[Scene, Camera]:
    """A white sphere alone; the sky is all that lights it."""
    world = scene((mesh(sphere(1.0, 32), smooth=True), IDENTITY), environment=environment)
    return world, camera(vector(1.5, 1.2, 3.5), vector(0, 0, 0), fov_y=0.75)


CONES = [(9 * split, 3) for split in SPLITS] + [(9 * SHARED_SPLIT, 6)]
"""gi.diffuse_cones, gi.diffuse_pattern."""


@pytest.mark.parametrize(("cones", "side"), CONES)
def test_a_furnace_lights_a_sphere_to_one(diffuse_gi: Draw, cones: int, side: int) -> None:
    """At every pixel; nine undivided cones may stray by half as much again."""
    lit = diffuse_gi(*ball(WHITE), **{"gi.diffuse_cones": cones, "gi.diffuse_pattern": side})
    lit = lit[np.isfinite(lit[..., 0])]
    print(f"furnace, {cones} cones: {lit[:, 0].mean():.4f}, {lit[:, 0].min():.4f} at least")
    assert len(lit) > 1000
    assert abs(lit.mean() - 1.0) <= FURNACE_ERROR
    assert np.abs(lit - 1.0).max() <= FURNACE_ERROR * (1.5 if cones == 9 else 1.0)


def sky_from_one_side() -> Environment:
    """Radiance from 0.1 to 8 around the horizon: each cone gathers something else."""
    azimuth = (np.arange(128) + 0.5) / 128 * 2 * np.pi
    radiance = np.repeat(np.exp(2.2 * np.cos(azimuth))[None, :, None], 64, axis=0)
    return Environment(np.repeat(radiance, 3, axis=2).astype(np.float32), vector(1, 1, 1), 1.0)


def pattern(image: Array, side: int) -> float:
    """How far pixels stray from the means of squares around them that hold every cone once."""
    near = side // 2
    reach = range(-near, side - near)
    shifted = np.mean([np.roll(image, (y, x), axis=(0, 1)) for y in reach for x in reach], axis=0)
    if side % 2 == 0:  # the middle of an even square lies between pixels
        shifted = np.mean([np.roll(shifted, (y, x), (0, 1)) for y in (0, -1) for x in (0, -1)], 0)
    strays = (image - shifted)[side:-side, side:-side]
    return float(np.std(strays) / np.mean(image))


@pytest.mark.parametrize(("cones", "side"), CONES)
def test_no_pattern_of_the_cones_is_seen(diffuse_gi: Draw, cones: int, side: int) -> None:
    world = scene((mesh(quad(4.0)), IDENTITY), environment=sky_from_one_side())
    eye = camera(vector(0.0, 2.0, 0.7), vector(0, 0, 0), fov_y=0.5)
    words = {"gi.diffuse_cones": cones, "gi.diffuse_pattern": side}
    image = diffuse_gi(world, eye, **words)[..., 0]
    assert np.isfinite(image).all()
    print(f"pattern, {cones} cones: {pattern(image, side):.5f} of the mean")
    assert pattern(image, side) <= 0.005


def by_cone(values: Array) -> Array:
    """(H, W, 4) pixels, row 0 on top, that say (9, 4) values by the cone that each traces."""
    y, x = np.mgrid[SIZE[1] - 1 : -1 : -1, 0 : SIZE[0]]
    return np.asarray(values[x % 3 + 3 * (y % 3)])


@dataclass
class Combiner:
    """The G-buffer of a scene seen from above, and what `combine_diffuse` makes of its cones."""

    device: Device
    world: Scene
    split: int = SPLITS[0]
    shared: bool = False

    def depth(self) -> Array:
        """(H, W) of the G-buffer, row 0 on top."""
        return self._run(None)

    def combine(self, pixels: Array) -> Array:
        """(H, W, 4) float32 from (H, W, 4): what each pixel's own cone gathered; row 0 on top."""
        return self._run(pixels).astype(np.float32)

    def _run(self, pixels: Array | None) -> Array:
        gpu = GpuScene(self.device, self.world)
        eye = camera(vector(0.4, 2.0, 1.2), vector(0, 0, 0), fov_y=0.5)
        g = self.device.begin_frame()
        view = pack_view(eye, SIZE, gpu.bounds)
        gb = draw_gbuffer(g, view, gpu, SIZE)
        if pixels is None:
            image = read(g, gb.depth)
        else:
            rows = pixels[::-1].astype(np.float16)
            # (v, y, u, x) to (y, v, x, u): pixel 3v + y of sub-image y.
            parts = rows.reshape(SIZE[1] // 3, 3, SIZE[0] // 3, 3, 4).transpose(1, 0, 3, 2, 4)
            texture = self.device.texture("cones", SIZE, RGBA16F, data=np.ascontiguousarray(parts))
            radiance = g.texture("cones", SIZE, RGBA16F)
            g.copy_texture(texture, radiance)
            if self.shared:
                radiance = share_cones(g, view, gb, radiance)
            diffuse, _ = combine_diffuse(g, view, gb, radiance, self.split, None)
            image = read(g, diffuse)
            texture.release()
        gpu.release()
        return image


@pytest.mark.parametrize("normal", [(0, 1, 0), (0.2, 1, 0.4)])
@pytest.mark.parametrize("split", SPLITS)
def test_every_pixel_of_a_plane_weighs_the_nine_cones_alike(
    device: Device, split: int, normal: tuple[float, float, float]
) -> None:
    """One value a cone: the combined image is constant to the rounding of half floats, at the rim
    too; and the same for each single cone."""
    world = scene((mesh(quad(8.0)), facing(vector(*normal))))
    combiner = Combiner(device, world, split)
    values = np.ones((9, 4))
    values[:, :3] = np.random.default_rng(1).uniform(0.1, 9.0, (9, 3))
    image = combiner.combine(by_cone(values))
    assert image[..., :3].min() > 0.05
    spread = np.ptp(image, axis=(0, 1)) / image.mean(axis=(0, 1))
    assert spread.max() <= 2.0**-10
    for cone in range(9):
        single = np.zeros((9, 4))
        single[:, 3] = 1.0
        single[cone, :3] = 4.0
        image = combiner.combine(by_cone(single))[..., 0]
        assert np.ptp(image) <= 2.0**-10 * 4.0, cone


def by_part(values: Array) -> Array:
    """(H, W, 4) pixels, row 0 on top, that say (9, 4, 4) values by the cone that each traces."""
    y, x = np.mgrid[SIZE[1] - 1 : -1 : -1, 0 : SIZE[0]]
    return np.asarray(values[x % 3 + 3 * (y % 3), x // 3 % 2 + 2 * (y // 3 % 2)])


def table_of_cones(count: int) -> Array:
    """(count, 3) CONE_DIRECTIONS of glsl/lib/cone_directions.glsl."""
    source = (glsl_root() / "lib/cone_directions.glsl").read_text()
    table = source.split(f"CONE_DIRECTIONS[{count}] = ")[1].split(";")[0]
    rows = re.findall(r"vec3\((-?[\d.]+), (-?[\d.]+), (-?[\d.]+)\)", table)
    return np.array(rows, np.float64)


@pytest.mark.parametrize("normal", [(0, 1, 0), (0.2, 1, 0.4)])
def test_every_pixel_shares_all_36_cones(
    device: Device, normal: tuple[float, float, float]
) -> None:
    """One value a cone: the image is the mean by the cones' weights c (1 + s c), at the rim too."""
    world = scene((mesh(quad(8.0)), facing(vector(*normal))))
    values = np.ones((9, SHARED_SPLIT, 4))
    values[..., :3] = np.random.default_rng(2).uniform(0.1, 9.0, (9, SHARED_SPLIT, 3))
    cosines = table_of_cones(36) @ (np.array(normal) / np.linalg.norm(normal))
    weights = np.where(cosines > 0.1, cosines * (1 + 0.12 * cosines), 0.0)
    rejected = weights.reshape(9, SHARED_SPLIT) == 0.0
    wanted = weights @ values.reshape(36, 4)[:, :3] / weights.sum()
    values[rejected, 3] = -1.0
    image = Combiner(device, world, SHARED_SPLIT, shared=True).combine(by_part(values))[..., :3]
    np.testing.assert_allclose(image, np.broadcast_to(wanted, image.shape), 0.004)


@pytest.mark.parametrize("split", SPLITS)
def test_a_ramp_stays_a_ramp(device: Device, split: int) -> None:
    """Cones that differ, each brighter to the right and to the bottom: no pattern either.

    The tent's samples of a cone have their centre at the pixel; no other filter's have.
    """
    world = scene((mesh(quad(8.0)), facing(vector(0, 1, 0))))
    y, x = np.mgrid[0 : SIZE[1], 0 : SIZE[0]]
    ramp = 1.0 + 4.0 * x / SIZE[0] + 2.0 * y / SIZE[1]
    values = np.random.default_rng(1).uniform(0.1, 4.0, (9, 1)) * np.ones(4)
    image = Combiner(device, world, split).combine(by_cone(values) * ramp[..., None])
    ratio = (image[..., 0] / ramp)[2:-2, 2:-2]
    assert np.ptp(ratio) <= 3.0 * 2.0**-10 * ratio.mean()


def test_edges_and_gaps_keep_the_mean(device: Device) -> None:
    """Where a neighbour lies on another surface, the missing cones are made up for: equal values
    everywhere stay equal, on boxes before nothing."""
    blocks = scene(
        (mesh(box((0.5, 0.5, 0.5))), facing(vector(0.3, 1, 0.2))),
        (mesh(box((0.1, 1.4, 0.1))), facing(vector(0.9, 1, 0.2))),
    )
    combiner = Combiner(device, blocks)
    depth = combiner.depth()
    surface = depth < depth.max()
    assert 500 < surface.sum() < surface.size
    image = combiner.combine(np.full((*depth.shape, 4), 0.75))[surface]
    assert np.abs(image - 0.75).max() <= 0.75 * 2.0**-10


def test_light_does_not_bleed_between_surfaces(device: Device) -> None:
    """A plate that floats over a floor: each keeps its own light up to the plate's rim.

    Only a corner borrows, where none of the 5x5 on its own surface traced one of its cones.
    """
    raised = np.eye(4, dtype=np.float32)
    raised[1, 3] = 0.5
    combiner = Combiner(device, scene((mesh(quad(8.0)), IDENTITY), (mesh(quad(0.4)), raised)))
    plate = mesh(quad(0.4)), raised
    alone = Combiner(device, scene(plate, (mesh(quad(8.0)), IDENTITY)))
    depth = combiner.depth()
    np.testing.assert_array_equal(depth, alone.depth())
    without = Combiner(device, scene((mesh(quad(8.0)), IDENTITY))).depth()
    above = depth < without - 0.002 * without.max()
    assert 300 < above.sum() < above.size - 300
    light = np.where(above[..., None], 1.0, 5.0) * np.ones(4)
    image = combiner.combine(light)[..., 0]
    bled = np.abs(image - light[..., 0]) > 0.01 * light[..., 0]
    assert bled.sum() <= 8
