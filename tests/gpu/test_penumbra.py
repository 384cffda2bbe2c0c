"""Soft shadows of lights that have a size, against closed forms. SH-09"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from elemental.passes.shadow_plan import ShadowSettings
from elemental.scene.model import Light, Scene
from glsl.harness import run_glsl
from gpu.rig import IDENTITY, MakeRig, Rig, at, camera, material, mesh, scene, sun, vector
from shapes import quad, sphere

Array = npt.NDArray[Any]
HIGH = camera(vector(0, 9, 0.01), vector(0, 0, 0), fov_y=0.9)
UP = vector(0, 1, 0)
HEIGHT, EDGE = 3.0, 1.0


def lamp(radius: float, **fields: Any) -> Light:
    made = Light("lamp", "point", vector(1, 1, 1), 1.0, vector(0, HEIGHT, 0), -UP)
    return replace(made, source_radius=radius, **fields)


def half_plane(light: Light, height: float = EDGE) -> Scene:
    """A floor, and a pane over its half at x > 0."""
    return scene(
        (mesh(quad(10.0)), IDENTITY),
        (mesh(quad(4.0)), at(2.0, height, 0)),
        materials=[material(double_sided=True)],
        lights=[light],
    )


def visibility(view: Rig, points: Array, normals: Array = UP) -> Array:
    view.begin()[0].execute()
    inputs = {"p": points, "n": np.broadcast_to(normals, points.shape)}
    reads = {
        name: ref for name, ref in view.shadows.view_reads().items() if name != "u_light_shapes"
    }
    body, defines = "light_visibility_in_view(0u, p, n)", {"SOFT_SHADOWS": int(view.shadows.soft)}
    return run_glsl(view.device, ["lib/shadow.glsl"], body, inputs, reads=reads, defines=defines)


def disc_over_edge(t: Array) -> Array:
    """Share of a disc of radius 1 beyond a line at a distance t from its middle."""
    t = np.clip(t, -1.0, 1.0)
    return 1.0 - (np.arccos(t) - t * np.sqrt(1.0 - t * t)) / np.pi


def across(width: float, count: int = 160) -> tuple[Array, Array]:
    x = np.linspace(-width, width, count)
    return x, np.stack([x, 0 * x, 0 * x + 0.11], axis=1)


@pytest.mark.parametrize("radius", [0.1, 0.2, 0.4])
@pytest.mark.parametrize("kind", ["point", "spot"])
def test_a_penumbra_is_the_disc_behind_the_edge(rig: MakeRig, kind: str, radius: float) -> None:
    """At the height h of the edge under a light of height H the penumbra is R h / (H - h) wide to
    either side, and its profile is the share of the disc that the edge leaves."""
    light = lamp(radius, kind=kind, outer_angle=1.2)
    width = radius * EDGE / (HEIGHT - EDGE)
    x, points = across(2.0 * width)
    got = visibility(rig(half_plane(light), HIGH, shadow_settings=ShadowSettings(1024)), points)
    want = disc_over_edge(-x / width)
    assert np.abs(got - want).mean() < 0.03
    assert np.abs(got - want).max() < 0.13
    # One sample of forty at most from a pixel to the next: no bands.
    assert np.abs(np.diff(got)).max() < 0.08


def test_a_sun_s_penumbra_grows_with_the_height(rig: MakeRig) -> None:
    angle = 0.06
    for height in (0.5, 1.0, 2.0):
        light = sun(vector(0, -1, 0), source_radius=angle)
        x, points = across(3.0 * angle * height)
        settings = ShadowSettings(2048, cascades=1)
        got = visibility(rig(half_plane(light, height), HIGH, shadow_settings=settings), points)
        want = disc_over_edge(-x / (angle * height))
        assert np.abs(got - want).mean() < 0.04


def test_a_point_s_shadow_is_what_it_was(rig: MakeRig) -> None:
    """Without a size, with the setting off, and where the size is less than the filter's."""
    _, points = across(0.5)
    hard = visibility(rig(half_plane(lamp(0.0)), HIGH), points)
    off = ShadowSettings(512, penumbras=False)
    for view in (rig(half_plane(lamp(0.3)), HIGH, (96, 64), off),
                 rig(half_plane(lamp(0.004)), HIGH)):  # fmt: skip
        np.testing.assert_array_equal(visibility(view, points), hard)
    assert not np.array_equal(visibility(rig(half_plane(lamp(0.3)), HIGH), points), hard)


@pytest.mark.parametrize("tilt", [0.0, 0.6, 1.1, 1.4])
def test_a_lit_slope_has_no_acne(rig: MakeRig, tilt: float) -> None:
    """The plane's own depth is what each sample is compared with, however grazing the light."""
    turned = IDENTITY.copy()
    turned[:2, :2] = [[np.cos(tilt), -np.sin(tilt)], [np.sin(tilt), np.cos(tilt)]]
    world = scene((mesh(quad(5.0)), turned), lights=[lamp(0.4)])
    rng = np.random.default_rng(2)
    local = rng.uniform(-1.2, 1.2, (3000, 3)) * (1, 0, 1)
    points, normal = local @ turned[:3, :3].T, turned[:3, 1]
    away = vector(0, HEIGHT, 0) - points
    facing = away @ normal / np.linalg.norm(away, axis=1)
    got = visibility(rig(world, HIGH), points[facing > 0.05], normal)
    assert got.min() > 0.99


@pytest.mark.parametrize("towards", [(1, 0.1, 0.05), (1, 1, 0), (-1, -1, 1)], ids=str)
def test_penumbras_cross_the_faces_of_a_point_light(rig: MakeRig, towards: Any) -> None:
    """A ball's shadow is round, whether it lies within a face or over an edge or a corner: by rays
    from each point to a disc of the light's size that faces it."""
    axis = np.array(towards, np.float64) / np.linalg.norm(towards)
    size, ball = 0.2, 0.1
    world = scene(
        (mesh(sphere(ball, rings=48), smooth=True), at(*axis)),
        (mesh(quad(0.1)), at(3, 3, 3)),
        (mesh(quad(0.1)), at(-3, -3, -3)),
        lights=[lamp(size, position=vector(0, 0, 0))],
    )
    rng = np.random.default_rng(5)
    spread = rng.normal(size=(3000, 3)) * 0.12 + axis
    directions = spread / np.linalg.norm(spread, axis=1, keepdims=True)
    view = rig(world, HIGH, shadow_settings=ShadowSettings(1024))
    points = directions * 1.5
    got = visibility(view, points, -directions)
    want = np.array([1.0 - hidden(point, axis, ball, size) for point in points])
    partly = (want > 0.05) & (want < 0.95)
    assert partly.sum() > 800
    # Blockers count with their mean distance; those of a ball are nearly the same.
    assert np.abs(got - want)[partly].mean() < 0.05
    assert np.abs(got - want).max() < 0.25


def test_penumbras_have_no_seam_between_faces(rig: MakeRig) -> None:
    """Just left and right of where two faces of a point light meet a shadow is the same."""
    world = scene(
        (mesh(sphere(0.15, rings=48), smooth=True), at(0.75, 0.6, 0)),
        (mesh(quad(0.1)), at(3, 3, 3)),
        (mesh(quad(0.1)), at(-3, -3, -3)),
        lights=[lamp(0.3, position=vector(0, 0, 0))],
    )
    view = rig(world, HIGH, shadow_settings=ShadowSettings(1024))
    z = np.linspace(-0.5, 0.5, 400)
    sides = []
    for shift in (-1e-4, 1e-4):
        towards = np.stack([0 * z + 1 + shift, 0 * z + 1 - shift, z], axis=1)
        towards /= np.linalg.norm(towards, axis=1, keepdims=True)
        sides.append(visibility(view, towards * 1.5, -towards))
    assert np.mean((sides[0] > 0.1) & (sides[0] < 0.9)) > 0.3
    assert np.abs(sides[0] - sides[1]).max() < 0.08
    assert np.abs(sides[0] - sides[1]).mean() < 0.01


DISC = np.array([np.sqrt((i + 0.5) / 400) * np.array([np.cos(2.4 * i), np.sin(2.4 * i)])
                 for i in range(400)])  # fmt: skip


def hidden(point: Array, center: Array, ball: float, size: float) -> float:
    """Share of a disc around the origin, facing `point`, that a ball hides from there."""
    normal = point / np.linalg.norm(point)
    side = np.cross(normal, (0.36, 0.48, 0.8))
    side /= np.linalg.norm(side)
    targets = size * (DISC[:, :1] * side + DISC[:, 1:] * np.cross(normal, side))
    ray = targets - point
    ray /= np.linalg.norm(ray, axis=1, keepdims=True)
    to_center = center - point
    nearest = to_center - (ray @ to_center)[:, None] * ray
    return float((np.linalg.norm(nearest, axis=1) < ball).mean())


def test_larger_lights_cast_softer_shadows_of_the_same_area(rig: MakeRig) -> None:
    """The light that a small pane takes from the floor does not depend on the light's size."""
    x, z = np.meshgrid(*[np.linspace(-1.5, 1.5, 90)] * 2)
    points = np.stack([x.ravel(), 0 * x.ravel(), z.ravel()], axis=1)
    taken, grey = [], []
    for radius in (0.0, 0.15, 0.3):
        world = scene(
            (mesh(quad(8.0)), IDENTITY), (mesh(quad(0.8)), at(0, 1, 0)),
            materials=[material(double_sided=True)], lights=[lamp(radius)],
        )  # fmt: skip
        got = visibility(rig(world, HIGH), points)
        taken.append((1.0 - got).sum())
        grey.append(np.mean((got > 0.05) & (got < 0.95)))
    np.testing.assert_allclose(taken, taken[0], rtol=0.06)
    assert grey[0] < grey[1] < grey[2]


def test_translucent_surfaces_receive_penumbras(rig: MakeRig) -> None:
    """A sheet of paper at the floor's place shows the floor's shadow."""
    paper = material(base_color=vector(1, 1, 1, 0.999), alpha_mode="blend", double_sided=True)
    solid = material(double_sided=True)
    pictures = []
    for floor in (solid, paper):
        world = scene(
            (mesh(quad(10.0), 1), IDENTITY),
            (mesh(quad(4.0)), at(2.0, EDGE, 0)),
            materials=[solid, floor],
            lights=[replace(lamp(0.4), intensity=9.0)],
        )
        pictures.append(rig(world, HIGH).scene_color()[..., 0])
    np.testing.assert_allclose(pictures[1], pictures[0], atol=0.02)


def test_nothing_shades_a_floor_where_a_cascade_ends(rig: MakeRig) -> None:
    """A wide sun's disc reaches over the last texels of a cascade, which know nothing of there."""
    light = sun(vector(-0.5, -0.6, -0.4), source_radius=0.09)
    world = scene((mesh(quad(10.0)), IDENTITY), lights=[light])
    low = camera(vector(0.3, 1.5, 3.2), vector(0.1, 0.45, 0))
    view = rig(world, low, shadow_settings=ShadowSettings(512))
    lit, floor = view.visibility(), np.isfinite(view.positions()[..., 0])
    assert floor.mean() > 0.5
    assert lit[floor].min() > 0.99
