# GI-12
"""The diffuse cones: a furnace, and the 3x3 pattern that must not be seen.

Frames of the whole renderer, looked at as irradiance / pi.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from elemental.frame import Renderer
from elemental.gpu.device import Device
from elemental.gpu.formats import RGBA16F
from elemental.passes.camera_view import pack_view
from elemental.passes.cone_trace.diffuse import SPLITS, combine_diffuse
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


@pytest.mark.parametrize("cones", [9 * split for split in SPLITS])
def test_a_furnace_lights_a_sphere_to_one(diffuse_gi: Draw, cones: int) -> None:
    """At every pixel; nine undivided cones may stray by half as much again."""
    lit = diffuse_gi(*ball(WHITE), **{"gi.diffuse_cones": cones})
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


def pattern(image: Array) -> float:
    """How far pixels stray from the mean of their 3x3, which holds every cone once."""
    height, width = (3 * (side // 3) for side in image.shape[:2])
    shifted = [np.roll(image, (y, x), axis=(0, 1)) for y in (-1, 0, 1) for x in (-1, 0, 1)]
    strays = (image - np.mean(shifted, axis=0))[1 : height - 1, 1 : width - 1]
    return float(np.std(strays) / np.mean(image))


@pytest.mark.parametrize("cones", [9 * split for split in SPLITS])
def test_no_pattern_of_the_nine_cones_is_seen(diffuse_gi: Draw, cones: int) -> None:
    world = scene((mesh(quad(4.0)), IDENTITY), environment=sky_from_one_side())
    eye = camera(vector(0.0, 2.0, 0.7), vector(0, 0, 0), fov_y=0.5)
    image = diffuse_gi(world, eye, **{"gi.diffuse_cones": cones})[..., 0]
    assert np.isfinite(image).all()
    print(f"pattern, {cones} cones: {pattern(image):.5f} of the mean")
    assert pattern(image) <= 0.005


def combined(device: Device, world: Scene, split: int, sub_images: Array) -> Array:
    """`combine_diffuse` of sub-images that hold one value each, (9, 4)."""
    gpu = GpuScene(device, world)
    width, height = SIZE
    eye = camera(vector(0.4, 2.0, 1.2), vector(0, 0, 0), fov_y=0.5)
    values = sub_images.astype(np.float16).reshape(3, 3, 1, 1, 4)
    texels = np.broadcast_to(values, (3, 3, height // 3, width // 3, 4))
    texture = device.texture(
        "cones", SIZE, RGBA16F, data=np.ascontiguousarray(texels.swapaxes(1, 2))
    )
    g = device.begin_frame()
    view = pack_view(eye, SIZE, gpu.bounds)
    gb = draw_gbuffer(g, view, gpu, SIZE)
    radiance = g.texture("cones", SIZE, RGBA16F)
    g.copy_texture(texture, radiance)
    image = read(g, combine_diffuse(g, view, gb, radiance, split)).astype(np.float32)
    for item in (texture, gpu):
        item.release()
    return image


@pytest.mark.parametrize("normal", [(0, 1, 0), (0.2, 1, 0.4)])
@pytest.mark.parametrize("split", SPLITS)
def test_every_pixel_of_a_plane_weighs_the_nine_cones_alike(
    device: Device, split: int, normal: tuple[float, float, float]
) -> None:
    """One value a sub-image: the combined image is constant to the rounding of half floats, at the
    rim too; and the same for each single cone."""
    world = scene((mesh(quad(8.0)), facing(vector(*normal))))
    values = np.ones((9, 4))
    values[:, :3] = np.random.default_rng(1).uniform(0.1, 9.0, (9, 3))
    image = combined(device, world, split, values)
    assert image[..., :3].min() > 0.05
    spread = np.ptp(image, axis=(0, 1)) / image.mean(axis=(0, 1))
    assert spread.max() <= 2.0**-10
    for cone in range(9):
        single = np.zeros((9, 4))
        single[:, 3] = 1.0
        single[cone, :3] = 4.0
        image = combined(device, world, split, single)[..., 0]
        assert np.ptp(image) <= 2.0**-10 * 4.0, cone


def test_edges_and_gaps_keep_the_mean(device: Device) -> None:
    """Where a neighbour lies on another surface, the missing cones are made up for: equal values
    everywhere stay equal, on boxes before nothing."""
    blocks = scene(
        (mesh(box((0.5, 0.5, 0.5))), facing(vector(0.3, 1, 0.2))),
        (mesh(box((0.1, 1.4, 0.1))), facing(vector(0.9, 1, 0.2))),
    )
    image = combined(device, blocks, SPLITS[0], np.full((9, 4), 0.75))
    surface = np.abs(image[..., 3] - 1.0) > 1e-3
    assert surface.sum() > 500
    image = image[surface]
    assert np.abs(image - 0.75).max() <= 0.75 * 2.0**-10
