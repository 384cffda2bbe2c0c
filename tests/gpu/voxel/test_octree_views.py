"""Views of the octree, its pools and its cones show what they say."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from elemental.core import transforms
from elemental.frame import Renderer
from elemental.gpu.device import Device
from elemental.passes.camera_view import pack_view
from elemental.passes.voxel import sizing
from elemental.passes.voxel.grid import Grid
from elemental.passes.voxel.view import voxel_view
from elemental.scene.model import Camera, Region, Scene
from elemental.settings import Settings
from gpu.rig import IDENTITY, at, camera, material, read, scene, vector
from gpu.voxel.scenes import colored, glowing, jumble, part, turned
from gpu.voxel.stage import BUDGET, CAMERA, Lit, MakeStage
from gpu.voxel.walk import Walk, world
from gpu.voxel.walk import show as step
from shapes import box, quad

Array = npt.NDArray[Any]

SIZE = (64, 48)
STOPS = np.array(
    [[0, 0, 0], [0.05, 0.1, 0.5], [0.55, 0.1, 0.6], [0.95, 0.4, 0.2], [1, 0.85, 0.3], [1, 1, 1]]
)
"""Of lib/false_color.glsl, at 0, 0.2, … 1."""
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
REGION_SHADE = 0.75
ABOVE = Camera(
    "above",
    transforms.inverse(transforms.look_at((0, 3, 0), (0, 0, 0), (0, 0, -1))),
    0.5,
    0.1,
)
"""Sees the middle 1.5 m of what lies at the origin; +x is right."""


def false_color(x: float) -> Array:
    return np.array([np.interp(x, np.linspace(0, 1, 6), STOPS[:, k]) for k in range(3)])


def show(device: Device, world: Scene, eye: Camera, view: str, **changes: Any) -> Array:
    """The view (H, W, 3), 0..1."""
    settings = {"gi.resolution": 64, "gi.area_lights": False, **changes}
    renderer = Renderer(device, world, Settings(settings), SIZE)
    try:
        frame = renderer.render(eye, 0.0, 0, view)
        picture = renderer.read(frame)[..., :3]
        device.finish()
    finally:
        renderer.release()
    return picture / 255.0 if picture.dtype == np.uint8 else picture


def test_regions_have_the_colours_of_their_levels(device: Device) -> None:
    """A plate whose right half is one level finer: each half a checkerboard of its colour."""
    plate = scene(part(box((2, 0.2, 2)), 0, IDENTITY))
    plate.regions = [Region(vector(0.05, -1, -1), vector(1, 1, 1), 1)]
    picture = show(device, plate, ABOVE, "regions")
    for half, level in ((picture[:, :30], 6), (picture[:, 34:], 7)):
        plain = false_color((level - 4) / 5)
        near = [np.abs(half - shade * plain).max(axis=-1) < 0.01 for shade in (1.0, REGION_SHADE)]
        assert (near[0] | near[1]).all()
        assert 0.3 < near[0].mean() < 0.7


def test_a_sheet_fills_half_of_each_node(device: Device) -> None:
    """One of a node's two layers of four voxels; a floor of two layers fills it whole."""
    middle = np.s_[8:-8, 8:-8]
    sheet = show(device, scene(part(quad(2.0), 0, IDENTITY)), ABOVE, "occupancy")
    np.testing.assert_allclose(
        sheet[middle], np.broadcast_to(false_color(0.5), (32, 48, 3)), atol=0.01
    )
    pitch = Grid.fit((vector(-1, -1, -1), vector(1, 1, 1)), 64).voxel_m
    layers = [part(quad(2.0), 0, at(0, k * pitch, 0)) for k in range(4)]
    floor = show(device, scene(*layers), ABOVE, "occupancy")[middle]
    full = np.abs(floor - 1.0).max(axis=-1) < 0.01
    half = np.abs(floor - false_color(0.5)).max(axis=-1) < 0.01
    assert (full | half).all()


@pytest.mark.parametrize("level", [0, 1, 2])
def test_each_side_of_the_voxels_can_be_shown(device: Device, level: int) -> None:
    """A wall that glows red towards +x and green towards -x.

    From either side of it, the side that faces the eye shows its own colour alone, the one that
    faces away none of that, the eye's own ray the same as the former.
    """
    right, left = turned(vector(0, 0, 1), -np.pi / 2), turned(vector(0, 0, 1), np.pi / 2)
    wall = scene(
        part(quad(2.0), 0, at(0.01, 0, 0) @ right),
        part(quad(2.0), 1, at(-0.01, 0, 0) @ left),
        materials=[glowing(1, 0, 0), glowing(0, 1, 0)],
    )
    for x, facing, away, own in ((4.0, "+x", "-x", 0), (-4.0, "-x", "+x", 1)):
        eye = camera(vector(x, 0, 0), vector(0, 0, 0), fov_y=0.2)
        shown = {
            side: show(device, wall, eye, "voxels", **{"voxels.side": side, "voxels.level": level})
            for side in ("all", facing, away)
        }
        assert shown[facing][..., own].min() > 0.5, x
        assert shown[facing][..., 1 - own].max() < 0.05, x
        assert shown[away][..., own].max() < 0.05, x
        np.testing.assert_allclose(shown["all"], shown[facing], atol=0.1)
        across = show(device, wall, eye, "voxels", **{"voxels.side": "+y", "voxels.level": level})
        assert np.abs(across - shown[facing]).max() > 0.1


@pytest.mark.parametrize("room", [1.6, 0.7])
def test_bars_are_as_long_as_the_pools_are_full(
    device: Device, stage: MakeStage, room: float
) -> None:
    """Pools of 1.6 and of 0.7 times what is asked for, each a bit larger than the one before."""
    lit = Lit(device, jumble())
    wanted = sizing.capacity_for(lit.count(lit.grid(64)), BUDGET)
    lit.release()
    names = ("fragments", "tiles", "bricks", "leaves", "interior")
    roomy = {n: int(getattr(wanted, n) * (room + 0.1 * k)) for k, n in enumerate(names)}
    made = stage(jumble(), capacity=replace(wanted, **roomy))
    width = 400
    g = made.device.begin_frame()
    view = pack_view(CAMERA, (width, 50), made.gpu.bounds)
    image = voxel_view(g, view, made.octree, (width, 50), "pools", 0, "all")
    bars = read(g, image)[5::10, :, :3].astype(int)
    counts = made.counts
    asked = (
        counts.fragments + counts.fragments_dropped,
        counts.tiles + counts.tiles_dropped,
        counts.bricks + counts.bricks_dropped,
        counts.leaves_asked,
        counts.interior_asked,
    )
    for bar, used, name in zip(bars, asked, names, strict=True):
        fill = used / roomy[name]
        in_use = (np.abs(bar - bar[0]).max(axis=1) < 3).sum()
        assert abs(in_use - min(fill, 1.0) * width) <= 1, name
        assert (bar[0].tolist() == [255, 0, 0]) == (fill > 1.0), name


def test_bars_stay_as_long_where_light_alone_changes(device: Device) -> None:
    """In a scene with moving parts: their fragments are still there."""
    lit = Lit(device, world(6))
    walk = Walk(lit.scene, np.random.default_rng(3))
    voxels = lit.lighting(64)
    step(device, lit, voxels, walk.pose())

    def bars() -> Array:
        g = device.begin_frame()
        view = pack_view(CAMERA, (400, 50), lit.gpu.bounds)
        return read(g, voxel_view(g, view, voxels.octree, (400, 50), "pools", 0, "all"))

    before = bars()
    lit.scene.lights[0] = replace(lit.scene.lights[0], intensity=2.0)
    names = step(device, lit, voxels, walk.pose())
    assert "light voxels" in names
    assert not any(name.startswith("voxelize") for name in names)
    np.testing.assert_array_equal(bars(), before)
    for item in (voxels, lit):
        item.release()


def mirror_before_a_wall() -> Scene:
    """A mirror on the floor, 4 m deep, and a dull wall at its far end."""
    return scene(
        part(box((4, 0.1, 4)), 0, at(0, -0.05, 0)),
        part(box((4, 4, 0.1)), 1, at(0, 2, -2)),
        materials=[material(metallic=1.0, roughness=0.05), colored(0.5, 0.5, 0.5)],
    )


def test_mirrored_cones_take_more_steps_the_farther_they_go(device: Device) -> None:
    eye = camera(vector(0, 2.5, 2.5), vector(0, 0, -1.0), fov_y=0.6)
    steps = show(device, mirror_before_a_wall(), eye, "specular_steps") @ LUMINANCE
    rows = steps[:, 16:48].mean(axis=1)
    floor = np.flatnonzero(rows > 0.0)
    assert rows[0] == 0.0, "the wall is dull"
    near_wall, middle, far = np.array_split(rows[floor], 3)
    print(near_wall.mean(), middle.mean(), far.mean())
    assert near_wall.mean() < middle.mean() < far.mean()


def test_diffuse_cones_in_a_crease_are_short(device: Device) -> None:
    """Half of them meet the wall at once; elsewhere all leave the scene, or reach it later.

    Narrow ones go on along the crease.
    """
    eye = camera(vector(0, 2.5, 2.5), vector(0, 0, -1.0), fov_y=0.6)
    column = show(device, mirror_before_a_wall(), eye, "diffuse_steps")[:, 32] @ LUMINANCE
    crease = int(np.argmin(column))
    assert 12 <= crease <= 18, "where the wall meets the floor"
    assert 0.0 < column[crease] < 0.9 * np.median(column)
