"""Screen-space ambient occlusion in rendered frames against closed forms. PP-03"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from elemental.frame import Renderer
from elemental.gpu.device import Device
from elemental.passes.ssao import occlude, ssao_view
from elemental.scene.model import Camera, Environment, Instance, Scene, Texture, TextureSlot
from elemental.settings import Settings
from gpu.rig import IDENTITY, MakeRig, camera, material, mesh, read, scene, sun, vector
from shapes import quad

Array = npt.NDArray[Any]
WHOLE = {"ao.intensity": 1.0, "ao.power": 1.0, "ao.bias": 0.0, "ao.fade_distance": 200.0}
"""The mean of (angle_left + angle_right) / 180 as it is."""
BISECTING = camera(vector(0, 3, 3), vector(0, 0, 0), fov_y=0.5)
"""Looks along the bisector of `corner`."""


def factor(
    rig: MakeRig,
    world: Scene,
    eye: Camera,
    size: tuple[int, int] = (320, 192),
    **settings: float,
) -> tuple[Array, Array]:
    """((H, W) factor, (H, W, 3) world points)."""
    view = rig(world, eye, size=size)
    g, block, gb = view.begin()
    chosen = Settings({**WHOLE, **{f"ao.{key}": value for key, value in settings.items()}})
    shown = read(g, ssao_view(g, block, gb, chosen))[..., 0] / 255.0
    return shown, view.positions()


def corner() -> Scene:
    """A floor y = 0 and a wall z = 0 that meet at the x axis."""
    wall = np.array([[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1]], np.float32)
    return scene((mesh(quad(40.0)), IDENTITY), (mesh(quad(40.0)), wall))


@pytest.mark.parametrize("elevation", [0.15, 0.5, 1.2])
def test_a_plane_gives_no_occlusion(rig: MakeRig, elevation: float) -> None:
    eye = vector(0, 5 * np.sin(elevation), 5 * np.cos(elevation))
    world = scene((mesh(quad(8.0)), IDENTITY))
    shown, points = factor(rig, world, camera(eye, vector(0, 0, 0)), radius=1.0)
    hit = np.isfinite(points[..., 0])
    assert hit.sum() > 3000
    assert shown[hit].min() > 0.99


def slides_corner(distance: float, radius: float) -> float:
    """The slides' formula at a point of the floor so far from the wall, as seen along the bisector
    by parallel rays: integrated over the pattern's disc of samples. All lengths in m.

    A sample at (s, y) of the disc sees the floor up to the edge, then the wall.
    """
    share = np.exp(np.linspace(np.log(0.7**6), 0.0, 400))
    turn = np.linspace(0.0, 2 * np.pi, 720, endpoint=False)
    length, angle = np.meshgrid(radius * share, turn)
    s, y = length * np.cos(angle), length * np.sin(angle)
    height = np.maximum(np.sqrt(2.0) * s - distance, 0.0)
    off = np.sqrt(distance**2 + y**2 + height**2)
    hidden = 1.0 - np.arccos(height / off) / (np.pi / 2)
    near = np.clip(2.5 - off / radius, 0.0, 1.0)
    return float(1.0 - (near * hidden).mean())


def test_a_corner_gives_the_slides_formula(rig: MakeRig) -> None:
    radius = 0.5
    shown, points = factor(rig, corner(), BISECTING, radius=radius)
    x, y, z = np.moveaxis(points, -1, 0)
    floor = (np.abs(x) < 0.5) & (y < 1e-3)
    for distance in (0.02, 0.08, 0.16, 0.28, 0.45):
        near = floor & (np.abs(z - distance) < 0.015)
        assert near.sum() > 100
        assert shown[near].mean() == pytest.approx(slides_corner(distance, radius), rel=0.05)


def test_a_right_angled_corner_hides_half(rig: MakeRig) -> None:
    """Half of the cosine-weighted hemisphere over a point at the foot of a wall is the wall: with
    the default power, the factor comes to that within 10 %."""
    shown, points = factor(rig, corner(), BISECTING, (640, 384), radius=0.5, power=2.0)
    foot = (np.abs(points[..., 0]) < 0.5) & (np.abs(points[..., 2] - points[..., 1]) < 0.01)
    assert foot.sum() > 100
    assert shown[foot].mean() == pytest.approx(0.5, rel=0.1)
    far = np.abs(points[..., 2] - points[..., 1]) > 1.0
    assert shown[far].min() > 0.98


def test_the_4x4_pattern_is_smoothed_away(rig: MakeRig) -> None:
    """Along the corner nothing changes: what is left of the pattern is below a hundredth."""
    shown, points = factor(rig, corner(), BISECTING, radius=0.4)
    rows, middle = slice(80, 112), slice(80, 240)
    assert shown[rows].min() < 0.8
    assert shown[rows, middle].std(axis=1).max() < 0.01
    assert np.isfinite(points[rows, middle, 0]).all()


def test_edges_stay_sharp(rig: MakeRig) -> None:
    """A plate far in front of the dark corner takes nothing of it on, up to its silhouette."""
    to_eye = np.array([[1, 0, 0, 0], [0, 0.7071, -0.7071, 1], [0, 0.7071, 0.7071, 1], [0, 0, 0, 1]])
    world = corner()
    world.meshes.append(mesh(quad(0.4)))
    world.instances.append(Instance("plate", 2, to_eye.astype(np.float32)))
    shown, points = factor(rig, world, BISECTING, radius=0.5)
    plate = points[..., 1] + points[..., 2] > 1.9
    assert plate.sum() > 1000
    assert shown[plate].min() > 0.99
    assert shown[~plate].min() < 0.8


def test_it_fades_with_distance(rig: MakeRig) -> None:
    near = factor(rig, corner(), BISECTING, radius=0.4)[0]
    gone = factor(rig, corner(), BISECTING, radius=0.4, fade_distance=3.0, fade_radius=1.0)[0]
    half_way = factor(rig, corner(), BISECTING, radius=0.4, fade_distance=5.24, fade_radius=2.0)[0]
    assert near[96, 160] < 0.85
    assert gone.min() == 1.0
    assert 1 - half_way[96, 160] == pytest.approx(0.5 * (1 - near[96, 160]), abs=0.02)


def test_it_multiplies_the_materials_own(rig: MakeRig) -> None:
    world = corner()
    world.textures = [Texture("ao", np.full((1, 1, 4), 128, np.uint8))]
    world.materials = [material(occlusion_texture=TextureSlot(0))]
    view = rig(world, BISECTING, size=(320, 192))
    g, block, gb = view.begin()
    plain = read(g, gb.b)
    g, block, gb = view.begin()
    occlude(g, block, gb, Settings({**WHOLE, "ao.radius": 0.5}))
    joined = read(g, gb.b)
    shown = factor(rig, corner(), BISECTING, radius=0.5)[0]
    np.testing.assert_array_equal(joined[..., :3], plain[..., :3])
    np.testing.assert_array_equal(np.unique(plain[..., 3]), [128])
    np.testing.assert_allclose(joined[..., 3], 128 * shown, atol=1.0)


def picture(device: Device, world: Scene, settings: dict[str, Any]) -> Array:
    small = {"gi.resolution": 64, "ao.radius": 0.5, **settings}
    renderer = Renderer(device, world, Settings(small), (160, 96))
    try:
        return renderer.read(renderer.render(BISECTING, 0.0, 0, "scene_color"))[..., :3]
    finally:
        renderer.release()


def test_direct_light_is_left_alone_and_indirect_light_is_not(device: Device) -> None:
    wall = np.array([[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1]], np.float32)
    parts = (mesh(quad(8.0)), IDENTITY), (mesh(quad(8.0)), wall)
    on, off = {"ao.intensity": 1.0}, {"ao.intensity": 0.0}
    lit = scene(*parts, lights=[sun(vector(0.2, -1, -0.5))])
    direct = {"indirect.intensity": 0.0}
    np.testing.assert_array_equal(
        picture(device, lit, {**on, **direct}), picture(device, lit, {**off, **direct})
    )
    sky = scene(*parts, environment=Environment(None, vector(1, 1, 1), 1.0))
    with_it, without = picture(device, sky, on), picture(device, sky, off)
    assert with_it[48, 80, 0] < 0.9 * without[48, 80, 0]


def test_cones_leave_it_what_is_smaller_than_two_voxels(rig: MakeRig) -> None:
    view = rig(corner(), BISECTING, size=(320, 192))
    settings = Settings({**WHOLE, "ao.radius": 0.5})
    shown = {}
    for voxel_m in (None, 1.0, 0.1):
        g, block, gb = view.begin()
        shown[voxel_m] = read(g, ssao_view(g, block, gb, settings, voxel_m))[..., 0]
    np.testing.assert_array_equal(shown[None], shown[1.0])
    np.testing.assert_allclose(
        shown[0.1] / 255.0, factor(rig, corner(), BISECTING, radius=0.2)[0], atol=1e-6
    )
    assert shown[0.1].mean() > shown[1.0].mean() + 2
