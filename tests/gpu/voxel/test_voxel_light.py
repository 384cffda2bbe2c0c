# GI-07
"""Radiance of leaf voxels against closed forms, and what a change of light runs again."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from elemental.core.layout import layouts
from elemental.gpu.device import Device
from elemental.passes.area_lights import pack_area_lights
from elemental.passes.voxel.grid import Grid
from elemental.scene.model import Environment, Light, Scene
from formulas import MIRRORED_BY_ROUGH_DIELECTRIC
from gpu.rig import at, scene, sun, vector
from gpu.voxel.pools import Pools, leaf_values, rgb9e5_values
from gpu.voxel.scenes import colored, facing, part
from gpu.voxel.stage import Lit, MakeStage, Stage
from shapes import box, quad

Array = npt.NDArray[Any]

ALBEDO = vector(0.8, 0.4, 0.1)
REFLECTED = ALBEDO + MIRRORED_BY_ROUGH_DIELECTRIC
EMISSION = vector(0.25, 0.0, 1.5)
Ints = tuple[float, float, float]
GRID = Grid.fit((vector(-1.42, -1.42, -1.42), vector(1.42, 1.42, 1.42)), 64)
CORNERS = np.array([[k & 1, k >> 1 & 1, k >> 2] for k in range(8)])
STRAIGHT, SLANTED = vector(0, -1, 0), vector(0.2, -1.0, 0.6)


def floor(*lights: Light, roof: bool = True, **fields: Any) -> Scene:
    """A glowing floor, 4 m wide, whose part at x > 0 a roof shades."""
    shade = [part(box((1.6, 0.1, 4.0)), 1, at(1.2, 1.2, 0))] if roof else []
    return scene(
        part(quad(4.0), 0, at(0, 0, 0)),
        *shade,
        materials=[colored(*ALBEDO, emissive=EMISSION), colored(0.5, 0.5, 0.5)],
        lights=lights,
        **fields,
    )


def floor_voxels(stage: Stage) -> tuple[Array, Array]:
    """(N, 3) world points and (N, 4) radiance and opacity of the floor's voxels off its rim."""
    pools = Pools.read(stage)
    values, _ = leaf_values(stage)
    leaves = pools.cell[pools.level == stage.own_grid.leaf_level]
    corners = np.array([[k & 1, k >> 1 & 1, k >> 2] for k in range(8)])
    p = stage.world(2 * leaves[:, None] + corners)
    voxel = stage.own_grid.voxel_m
    held = (values[..., 3] > 0) & (np.abs(p[..., 1]) < voxel)
    held &= (np.abs(p[..., [0, 2]]) < 2.0 - 2 * voxel).all(axis=-1)
    assert held.sum() > 1000
    return p[held], values[held]


def assert_radiance(got: Array, wanted: Array, tolerance: float = 0.01) -> None:
    assert len(got) > 200
    np.testing.assert_allclose(got[:, 3], 1.0)
    wanted = np.broadcast_to(wanted, got[:, :3].shape)
    np.testing.assert_allclose(got[:, :3], wanted, rtol=tolerance, atol=1e-6)


@pytest.mark.parametrize("direction", [STRAIGHT, SLANTED], ids=["straight", "slanted"])
def test_a_lit_voxel_reflects_its_irradiance_and_emits(stage: MakeStage, direction: Array) -> None:
    lux = 5.0
    made = stage(floor(sun(direction, lux)))
    p, radiance = floor_voxels(made)
    cosine = -sun(direction).direction[1]
    hit = p + direction / direction[1] * 1.2  # where the ray to the sun meets the roof's height
    beside = (hit[:, 0] < 0.2) | (hit[:, 0] > 2.2) | (np.abs(hit[:, 2]) > 2.2)
    below = (hit[:, 0] > 0.6) & (hit[:, 0] < 1.8) & (np.abs(hit[:, 2]) < 1.8)
    assert_radiance(radiance[beside], REFLECTED / np.pi * lux * cosine + EMISSION)
    assert_radiance(radiance[below], EMISSION)


def test_the_suns_share_is_the_lamps_by_distance(stage: MakeStage) -> None:
    """A point light's irradiance: intensity times cosine over the square of the distance."""
    place, candela = vector(-0.5, 1.5, 0.3), 4.0
    lamp = Light("lamp", "point", vector(1, 1, 1), candela, place, vector(0, -1, 0))
    made = stage(floor(lamp, roof=False))
    p, radiance = floor_voxels(made)
    to_light = place - p
    distance = np.linalg.norm(to_light, axis=1, keepdims=True)
    irradiance = candela * to_light[:, 1:2] / distance**3
    near = distance[:, 0] < 2.5
    # A voxel's point is up to half a voxel above or below the floor.
    assert_radiance(radiance[near], (REFLECTED / np.pi * irradiance + EMISSION)[near], 0.05)


@pytest.mark.parametrize("normal", [(0, 1, 0), (1, 2, 3), (-3, 1, 0.5)])
def test_a_voxel_knows_how_high_its_surface_lies(stage: MakeStage, normal: Ints) -> None:
    """Over its lattice point, along the normal: two bits, an eighth of a voxel off at most."""
    unit = vector(*normal) / np.linalg.norm(normal)
    middle = vector(0.01, 0.02, 0.03)
    placed = at(*middle) @ facing(unit)
    made = stage(scene(part(quad(2.0), 0, placed), materials=[colored(1, 1, 1)]), grid=GRID)
    pools = Pools.read(made)
    leaves = pools.cell[pools.level == GRID.leaf_level]
    words = made.octree.attributes.read(layouts().struct("VoxelAttributes"), len(leaves) * 8)
    held = words["albedo"] > 0
    stored = ((words["normal"] >> 30) + 0.5) / 4 - 0.5
    p = made.world((2 * leaves[:, None] + CORNERS).reshape(-1, 3))
    height = (middle - p) @ unit / GRID.voxel_m
    assert held.sum() > 1000
    assert np.abs(height[held]).max() <= 0.51
    assert normal == (0, 1, 0) or np.ptp(height[held]) > 0.5
    assert np.abs(stored - height)[held].max() <= 0.13


@pytest.mark.parametrize("phase", [0.1, 0.35, 0.6, 0.85])
def test_a_sheet_closely_over_a_floor_shades_it_wherever_the_lattice_stands(
    stage: MakeStage, phase: float
) -> None:
    """And the open floor beside it does not shade itself."""
    voxel = GRID.voxel_m
    y = phase * voxel
    parts = [part(quad(2.4), 0, at(0, y, 0)), part(quad(1.2), 0, at(0, y + 1.3 * voxel, 0))]
    lit = scene(*parts, materials=[colored(*ALBEDO)], lights=[sun(SLANTED, 5.0)])
    made = stage(lit, grid=GRID)
    pools, (radiance, _) = Pools.read(made), leaf_values(made)
    leaves = pools.cell[pools.level == GRID.leaf_level]
    p = made.world(2 * leaves[:, None] + CORNERS)
    floor_ = (radiance[..., 3] > 0) & (np.abs(p[..., 1] - y) <= 0.5 * voxel)
    across = np.abs(p[..., [0, 2]]).max(axis=-1)
    below, beside = floor_ & (across < 0.6 - 4 * voxel), floor_ & (across > 0.6 + 4 * voxel)
    beside &= across < 1.2 - 2 * voxel
    assert min(below.sum(), beside.sum()) > 200
    assert radiance[below][:, :3].max() == 0.0
    wanted = REFLECTED / np.pi * 5.0 * -sun(SLANTED).direction[1]
    np.testing.assert_allclose(
        radiance[beside][:, :3], np.broadcast_to(wanted, (beside.sum(), 3)), rtol=0.02
    )


def test_an_unlit_scene_is_dark_and_its_voxels_opaque(stage: MakeStage) -> None:
    dark = floor()
    dark.materials[0] = replace(dark.materials[0], emissive=vector(0, 0, 0))
    _, radiance = floor_voxels(stage(dark))
    assert_radiance(radiance, np.zeros(3))


def test_gathered_light_of_an_open_sky(stage: MakeStage) -> None:
    """With a second gather, a floor under a white sky reflects its albedo."""
    sky = Environment(None, vector(1, 1, 1), 1.0)
    made = stage(floor(roof=False, environment=sky), bounces=2)
    p, radiance = floor_voxels(made)
    middle = (np.abs(p[:, [0, 2]]) < 1.0).all(axis=1)
    got = (radiance[middle, :3] - EMISSION) / REFLECTED
    print(f"sky gathered by voxels: {got.mean():.4f}, {got.min():.4f} to {got.max():.4f}")
    np.testing.assert_allclose(got, 1.0, atol=0.05)


STAGES = ("voxelize", "voxel/nodes", "voxel/resolve", "light voxels", "filter", "voxel/compress")


def test_a_change_of_light_lights_anew_without_building(device: Device) -> None:
    """And a frame in which nothing changed does no voxel work."""
    lit = Lit(device, floor(sun(STRAIGHT, 2.0)))
    voxels = lit.lighting(64)

    def ran(bounces: int = 1) -> set[str]:
        g = lit.begin()
        voxels.update(g, lit.shadows, lit.sky, pack_area_lights([]), lit.light_key, bounces)
        names = [node.name for node in g.passes]
        g.execute()
        return {stage for stage in STAGES if any(name.startswith(stage) for name in names)}

    def brightest() -> float:
        device.finish()
        codes = voxels.octree.radiance.read(np.uint32, voxels.counts.leaves * 8)
        return float(rgb9e5_values(codes)[:, 0].max())

    lighting = {"light voxels", "filter", "voxel/compress"}
    assert ran() == set(STAGES)
    before = brightest()
    assert ran() == set()
    lit.scene.lights[0] = sun(STRAIGHT, 4.0)
    assert ran() == lighting
    assert brightest() - EMISSION[0] == pytest.approx(2 * (before - EMISSION[0]), rel=0.01)
    assert ran() == set()
    lit.scene.environment = Environment(None, vector(1, 1, 1), 1.0)
    assert ran(bounces=2) == lighting
    assert ran(bounces=2) == set()
    voxels.release()
    lit.release()
