"""Decals colour the voxels that they cover, as they colour the picture. SH-07, GI-04"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from elemental.core.layout import layouts
from elemental.frame import Renderer
from elemental.gpu.device import Device
from elemental.passes.decal import Decals
from elemental.passes.decal_voxels import SIDE as CELLS
from elemental.passes.decal_voxels import cell_lists
from elemental.passes.voxel import sizing
from elemental.passes.voxel.octree import Counts, Octree
from elemental.passes.voxel.voxelize import voxelize
from elemental.scene.definitions import read_definition
from elemental.scene.deform import posed
from elemental.scene.model import Decal, Environment, Material, Scene
from elemental.settings import Settings
from gpu.moving import SETTINGS, SIZE, picture, stage
from gpu.rig import at, camera, material, mesh, scene, vector
from gpu.test_decals import FACING_UP, floor, placed
from gpu.voxel.stage import BUDGET, Lit
from shapes import box, quad

Array = npt.NDArray[Any]
RESOLUTION = 32
BLACK = material(base_color=vector(0, 0, 0, 1), roughness=1.0)
GREEN = material(base_color=vector(0, 1, 0, 1), roughness=1.0)


@pytest.fixture
def queue_of(device: Device) -> Iterator[Any]:
    """(albedo (F, 4), emissive words (F,), positions (F, 3) m) of a scene's fragments."""
    held: list[Lit] = []

    def made(world: Scene) -> tuple[Array, Array, Array]:
        lit = Lit(device, world)
        held.append(lit)
        decals = Decals(device, world, lit.gpu)
        grid = lit.grid(RESOLUTION)
        capacity = sizing.capacity_for(lit.count(grid), BUDGET)
        octree = Octree(device, grid, capacity, sizing.max_emission(world))
        g = lit.begin()
        queue = voxelize(g, lit.gpu, octree, decals.voxels)
        g.keep(queue)
        g.execute()
        assert queue.physical is not None
        counts = Counts.from_state(octree.state.read().tobytes())
        struct = layouts().struct("VoxelFragment")
        rows = queue.physical.read(struct, counts.fragments)
        codes = rows["albedo"].astype(np.int64)
        albedo = np.stack([codes >> shift & 255 for shift in (0, 8, 16, 24)], axis=-1) / 255.0
        place = rows["position"].astype(np.int64)
        points = np.stack([place >> shift & 1023 for shift in (0, 10, 20)], axis=-1)
        corner = np.array(grid.origin) + 0.5 * grid.resolution * grid.voxel_m
        decals.release()
        octree.release()
        return albedo, rows["emissive"], corner + points * grid.voxel_m

    yield made
    for lit in held:
        lit.release()


@pytest.mark.parametrize(
    ("size", "to"),
    [((1.0, 0.5), (0.0, 0.0)), ((0.37, 1.21), (0.413, -0.27)), ((0.06, 0.05), (0.31, 0.02))],
)
def test_paint_covers_the_decals_area(
    queue_of: Any, size: tuple[float, float], to: tuple[float, float]
) -> None:
    """Of a white floor along the lattice, to the rounding of its colours, be it finer than a
    voxel."""
    whole = queue_of(floor(placed(size=(9.0, 9.0, 0.4)), more=(BLACK,)))[0]
    decal = placed(size=(*size, 0.4), to=(to[0], 0.0, to[1]))
    albedo, _, points = queue_of(floor(decal, more=(BLACK,)))
    voxel_m = float(np.diff(np.unique(np.round(points[:, 0], 5))).min())
    mirrored = whole[:, 0].max()
    assert mirrored < 0.05
    covered = np.sum(1.0 - albedo[:, 0]) / (1.0 - mirrored) * voxel_m**2
    assert covered == pytest.approx(size[0] * size[1], rel=0.03)
    assert albedo[:, 3].min() == 1.0  # the opacity stays


def test_a_higher_order_covers_a_lower_one(queue_of: Any) -> None:
    for orders, green in (((0, 1), True), ((1, 0), False)):
        decals = [placed(1, order=orders[0]), placed(2, order=orders[1])]
        albedo, _, points = queue_of(floor(*decals, more=(BLACK, GREEN)))
        middle = albedo[np.abs(points[:, [0, 2]]).max(axis=1) < 0.3]
        assert (middle[:, 1].min() > 0.9) if green else (middle[:, 1].max() < 0.1)


def test_what_the_picture_leaves_clean_stays_clean(queue_of: Any, tmp_path: Path) -> None:
    """Walls that face away, models that refuse, unlit surfaces; half of it on a mask of a half."""
    file = tmp_path / "masking.glsl"
    file.write_text("/* */\nvoid material(inout Surface s, MaterialInput m, Parameters p) {\n"
                    "    s.decal_mask = 1.0 / 3.0;\n}\n")  # fmt: skip
    half = Material("half", definition=read_definition(file))
    world = scene(
        (mesh(box((0.8, 0.5, 0.8))), at(-1, 0, 0)),
        (mesh(box((0.8, 0.5, 0.8))), at(0, 0, 0)),
        (mesh(box((0.8, 0.5, 0.8)), 2), at(1, 0, 0)),
        materials=[material(), BLACK, half],
    )
    world.instances[1].receives_decals = False
    world.decals = [placed(size=(6.0, 6.0, 2.0))]
    albedo, _, points = queue_of(world)
    top = points[:, 1] > 0.2
    below = points[:, 1] < -0.2
    assert albedo[below].min() == 1.0
    inner = top & (np.abs(points[:, 2]) < 0.25)
    for x, want in ((-1.0, 0.03), (0.0, 1.0), (1.0, 0.68)):
        here = inner & (np.abs(points[:, 0] - x) < 0.25)
        assert here.sum() > 8
        np.testing.assert_allclose(albedo[here][:, 0], want, atol=0.03)


def test_a_decal_of_normals_alone_leaves_voxels_alone(queue_of: Any) -> None:
    albedo, emissive, _ = queue_of(floor(placed(channels=("normal", "roughness")), more=(BLACK,)))
    assert albedo.min() == 1.0
    assert len(np.unique(emissive)) == 1


def test_only_emission_that_decals_bring_takes_a_share_of_its_range() -> None:
    """Else lamps are stored in steps of what is never there."""
    neon = material(emissive=vector(0.0, 900.0, 0.0))
    for channels, most in ((("color",), 0.0), (("color", "emission"), 900.0)):
        assert sizing.max_emission(floor(placed(channels=channels), more=(neon,))) == most


def test_a_glowing_decal_lights_what_is_near(device: Device) -> None:
    """A rune on a black floor, as wide as its cousin in geometry, lights a wall alike."""
    glow = material(base_color=vector(0, 0, 0, 1), emissive=vector(0.0, 4.0, 0.0))
    wall = (mesh(box((3.0, 2.0, 0.1)), 2), at(0, 1.0, -1.5))
    ground = (mesh(quad(3.0), 1), at(0, 0, 0))
    by_geometry = scene(ground, wall, (mesh(quad(1.0), 0), at(0, 0.001, 0)),
                        materials=[glow, BLACK, material()])  # fmt: skip
    by_decal = scene(ground, wall, materials=[glow, BLACK, material()])
    by_decal.decals = [Decal("rune", 0, FACING_UP)]
    dark = replace(by_decal, decals=[])
    eye = camera(vector(0, 1.0, 1.5), vector(0, 1.0, -1.5), fov_y=0.5)
    settings = Settings({"gi.resolution": 64, "gi.area_lights": False, "gi.bounces": 1})
    seen = []
    for world in (by_geometry, by_decal, dark):
        world.environment = Environment(None, vector(0, 0, 0), 0.0)
        renderer = Renderer(device, world, settings, (32, 32))
        seen.append(renderer.read(renderer.render(eye, 0.0, 0, "diffuse_gi"))[..., 1].mean())
        device.finish()
        renderer.release()
    assert seen[2] == 0.0
    assert seen[1] == pytest.approx(seen[0], rel=0.1)


def test_what_moves_below_a_decal_wears_it_there_alone(device: Device) -> None:
    """After a step the voxels are those of a scene built anew; so they are in other paint."""
    held = []

    def drawn(world: Scene) -> Renderer:
        held.append(Renderer(device, world, SETTINGS, SIZE))
        return held[-1]

    world = stage()
    world.materials.append(GREEN)
    world.decals = [placed(len(world.materials) - 1, size=(2.0, 2.0, 6.0))]
    moving = drawn(world)
    seen = [picture(moving, t, "voxels") for t in (0.0, 1.2)]
    assert not np.array_equal(*seen)
    np.testing.assert_array_equal(seen[1], picture(drawn(posed(world, 1.2)), 0.0, "voxels"))
    moving.set_material(world.decals[0].material, BLACK)
    repainted = picture(moving, 1.2, "voxels")
    green = seen[1][..., 1] > 2.0 * seen[1][..., 0] + 0.01
    assert green.sum() > 20
    assert repainted[green][:, 1].mean() < 0.3 * seen[1][green][:, 1].mean()
    for renderer in held:
        renderer.release()


def test_the_cells_hold_each_decal_where_it_is_in_its_order() -> None:
    rng = np.random.default_rng(4)
    first = rng.integers(0, CELLS - 3, size=(40, 3))
    last = first + rng.integers(0, 4, size=(40, 3))
    numbers = rng.permutation(40)[:25].tolist()
    words = cell_lists(numbers, first, last, 100)
    for cell in rng.integers(0, CELLS**3, size=200).tolist():
        point = np.array([cell % CELLS, cell // CELLS % CELLS, cell // CELLS**2])
        want = [n for n in numbers if (first[n] <= point).all() and (point <= last[n]).all()]
        begin, end = words[cell] - 100, words[cell + 1] - 100
        assert words[begin:end].tolist() == want
