"""Many lights: what the cells say of the lights that reach them, and that no picture shows it."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from elemental.gpu.device import Device
from elemental.gpu.formats import R32UI
from elemental.passes.light_cells import NO_CELLS, cull_to_view
from elemental.passes.light_pack import light_bounds, reach
from elemental.passes.shadow_plan import CULLED_FROM, ShadowSettings
from elemental.passes.views import light_view
from elemental.scene.model import Light, Scene
from glsl.harness import run_glsl
from gpu.rig import IDENTITY, MakeRig, Rig, at, camera, material, mesh, scene, vector
from shapes import box, quad, sphere

Array = npt.NDArray[Any]
LOW = camera(vector(0, 1.2, 5), vector(0, 0.5, -2), fov_y=1.0)
EVERY = ShadowSettings(512, culling=False)


def lamps(count: int, reach_m: float = 2.0) -> list[Light]:
    """Point and spot lights about the floor, without shadows."""
    rng = np.random.default_rng(3)
    made = []
    for number in range(count):
        position = vector(rng.uniform(-5, 5), rng.uniform(0.2, 2), rng.uniform(-8, 3))
        direction = (rng.normal(size=3) - (0, 1, 0)).astype(np.float32)
        made.append(
            Light(
                f"lamp {number}",
                "spot" if number % 3 else "point",
                rng.uniform(0.2, 1.0, 3).astype(np.float32),
                2.0,
                position,
                direction / np.linalg.norm(direction),
                range=reach_m,
                outer_angle=float(rng.uniform(0.2, 1.5)),
                casts_shadow=False,
            )
        )
    return made


def court(lights: list[Light]) -> Scene:
    """A floor with a ball and a pane of glass."""
    return scene(
        (mesh(quad(20.0)), IDENTITY),
        (mesh(sphere(0.5), smooth=True), at(0, 0.5, 0)),
        (mesh(box((1.5, 1, 0.05)), 1), at(-1, 0.5, 1)),
        materials=[material(), material(base_color=vector(1, 1, 1, 0.5), alpha_mode="blend")],
        lights=lights,
    )


def passes(view: Rig) -> list[str]:
    g, block, gb = view.begin()
    cells = cull_to_view(g, block, view.shadows, view.camera, view.size)
    g.keep(light_view(g, block, gb, view.shadows, "direct", cells))
    names = [item.name for item in g.passes]
    g.execute()
    return names


def test_a_picture_is_the_same_to_the_bit(rig: MakeRig) -> None:
    world = court(lamps(70))
    culled = rig(world, LOW, size=(160, 96))
    got = culled.scene_color()
    assert "lights.view_cells" in passes(culled)
    np.testing.assert_array_equal(got, rig(world, LOW, (160, 96), EVERY).scene_color())
    assert (got[..., :3].max(axis=-1) > 0.05).mean() > 0.15


def test_cells_list_what_reaches_them_and_little_else(device: Device, rig: MakeRig) -> None:
    """Each pixel's list holds every light whose irradiance there is not 0, by numpy."""
    lights = lamps(200)
    view = rig(court(lights), LOW, size=(160, 96))
    points = view.positions().reshape(-1, 3)
    points = points[np.isfinite(points[:, 0])]
    g, block, _ = view.begin()
    cells = cull_to_view(g, block, view.shadows, view.camera, view.size)
    assert cells.bits is not None
    g.keep(cells.bits)
    g.execute()
    assert cells.bits.physical is not None
    kept = device.texture("bits", cells.bits.size, R32UI, data=cells.bits.physical.read())
    words = view.shadows.light_words
    listed = np.zeros((len(points), 32 * words), bool)
    for word in range(words):
        bits = run_glsl(
            device,
            ["shared/view.glsl", "lib/light_cells.glsl"],
            f"light_bits(light_cell(p), {word}u)",
            {"p": points},
            "uint",
            reads={"u_light_bits": kept, "Lights": view.shadows.reads()["Lights"]},
            params={"View": block, **cells.params()},
            defines={"LIGHT_CELLS": cells.kind},
        )
        listed[:, 32 * word : 32 * word + 32] = bits[:, None] >> np.arange(32) & 1
    kept.release()
    reaches = np.stack([reached(light, points) for light in lights], axis=1)
    listed = listed[:, : len(lights)]
    assert not np.any(reaches & ~listed)
    assert reaches.sum() > 1000
    assert listed.mean() < 0.15


def reached(light: Light, points: Array) -> Array:
    """Whether a light reaches points (N, 3), but for a hair at its rim."""
    offset = points - light.position
    distance = np.linalg.norm(offset, axis=1)
    within = distance < 0.9999 * light.range
    if light.kind == "point":
        return np.asarray(within)
    cosine = offset @ light.direction / distance
    return np.asarray(within & (cosine > np.cos(light.outer_angle) + 1e-4))


@pytest.mark.parametrize("angle", [0.1, 0.7, 0.9, 1.5])
def test_a_spot_light_s_sphere_holds_its_cone(angle: float) -> None:
    lamp = replace(lamps(2)[1], outer_angle=angle)
    sphere_ = light_bounds([lamp], [lamp.range])[0]
    rng = np.random.default_rng(1)
    points = lamp.position + rng.uniform(-1, 1, (100_000, 3)) * lamp.range
    inside = points[reached(lamp, points)]
    away = np.linalg.norm(inside - sphere_[:3], axis=1)
    assert away.max() < sphere_[3] + 1e-5
    assert sphere_[3] <= lamp.range + 1e-6
    assert away.max() > 0.9 * sphere_[3]


def test_lights_without_a_range_end_where_they_are_dim(rig: MakeRig) -> None:
    """What a light of intensity I loses at a distance d is at most the cutoff, everywhere."""
    cutoff, lights = 0.02, lamps(40, reach_m=np.inf)
    assert reach(replace(lights[0], color=vector(0.5, 0.25, 0)), cutoff) == pytest.approx(
        np.sqrt(50.0)
    )
    world = court(lights)
    whole = rig(world, LOW, (160, 96), EVERY).scene_color()[..., :3]
    ended = rig(world, LOW, (160, 96), ShadowSettings(512, cutoff=cutoff)).scene_color()[..., :3]
    assert (whole - ended).min() > -1e-3 * whole.max()
    assert (whole - ended).max() < len(lights) * cutoff / np.pi
    assert (whole - ended).max() > cutoff / np.pi  # the bound is not met by doing nothing


def test_few_lights_cost_no_pass(rig: MakeRig) -> None:
    view = rig(court(lamps(CULLED_FROM - 1)), LOW)
    assert not any(name.startswith("lights.") for name in passes(view))
    g, block, _ = view.begin()
    assert cull_to_view(g, block, view.shadows, view.camera, view.size) is NO_CELLS
    g.execute()


def test_voxels_are_lit_the_same_to_the_bit(renderers: Any) -> None:
    """Lights reach voxels through cells of the world, which no camera moves."""
    pictures = []
    for culling in (True, False):
        made = renderers(court(lamps(70)), **{"lights.culling": culling, "gi.bounces": 2})
        frame = made.render(LOW, 0.0, 0, "diffuse_gi")
        pictures.append(made.read(frame))
        made.device.finish()
        ran = [timing.name for timing in made.device.timings]
        assert ("lights.world_cells" in ran) == culling
    np.testing.assert_array_equal(*pictures)
    assert pictures[0][..., :3].max() > 0.02  # there is light


def test_a_target_of_another_camera_is_another_grid(rig: MakeRig) -> None:
    """Cells follow the camera: from the side the picture is the same to the bit, too."""
    world = court(lamps(70))
    aside = camera(vector(6, 2, -3), vector(0, 0, -1), fov_y=0.6)
    culled, every = rig(world, LOW, (120, 96)), rig(world, aside, (120, 96), EVERY)
    culled.scene_color()
    culled.camera = aside
    np.testing.assert_array_equal(culled.scene_color(), every.scene_color())
