"""Shadow maps of area lights against rays to their surfaces; who gets them. GI-15, SH-09"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from elemental.gpu.device import Device
from elemental.passes.area_lights import AreaLightBlock
from elemental.passes.emitter_views import EMITTERS_MAX, points
from elemental.passes.shadow import update_shadows
from elemental.passes.shadow_plan import ShadowPlanner, ShadowSettings
from elemental.passes.shadow_views import PackedViews
from elemental.scene.area_lights import AreaLight
from elemental.scene.model import Light, Scene
from glsl.harness import run_glsl
from gpu.moving import EYE, picture, pose_of
from gpu.rig import IDENTITY, MakeRig, at, camera, scene, vector
from gpu.voxel.scenes import colored, glowing, part, turned
from shapes import box, quad, sphere

Array = npt.NDArray[Any]
ANY = camera(vector(0, 0, 5), vector(0, 0, 0))
UP = np.array([0.0, 1.0, 0.0])
DOWN = turned(vector(1, 0, 0), np.pi)
DARK = [colored(0, 0, 0), glowing(10.0), glowing(10.0, double_sided=True)]
LAMP, BOTH_SIDES = 1, 2
TILTS = {"straight": 0.0, "turned": 0.4, "diagonal": np.pi / 4}

SHARES = """
vec2 shares(vec3 p, vec3 n) {
    vec2 sum = vec2(0.0);
    for (int k = 0; k < AREA_STRATA; ++k) {
        AreaSample s = sample_part(0, p, n, k);
        float seen = disc_visibility(u_area_lights.faces[s.face], s.part, p, n, s.radius);
        sum += s.irradiance.x * vec2(seen, 1.0);
    }
    return vec2(sum.x / sum.y, mapped_share(u_area_lights.faces[0], p, n, FOOTPRINT));
}
"""
"""Of a lone light's irradiance: what a pixel's nine strata see, and what a voxel does."""

Seen = Callable[..., Array]


@pytest.fixture
def seen(rig: MakeRig) -> Seen:
    """(N, 2) SHARES of a scene's light at points (N, 3) with a normal (3,) or (N, 3)."""

    def look(world: Scene, p: Array, normal: Array, footprint_m: float = 0.0) -> Array:
        view = rig(world, ANY, shadow_settings=ShadowSettings(1024))
        block = AreaLightBlock(world, True, True)
        assert len(block.mapped) == 1
        g = view.device.begin_frame()
        update_shadows(
            g, view.shadows, view.gpu, [], camera=ANY, size=(8, 8), emitters=block.mapped
        )
        g.execute()
        p, normal = np.broadcast_arrays(np.atleast_2d(p), np.atleast_2d(normal))
        return run_glsl(
            view.device,
            ["lib/area_map.glsl"],
            "shares(p, n)",
            {"p": p.astype(np.float32), "n": normal.astype(np.float32)},
            "vec2",
            functions=SHARES,
            reads=view.shadows.depth_reads(contact=True),
            params={"AreaLights": block.block},
            defines={"SOFT_SHADOWS": 1, "FOOTPRINT": footprint_m},
        )

    return look


def exact(
    lamp: AreaLight, p: Array, normal: Array, blocked: Callable[[Array, Array], Array]
) -> Array:
    """(N,) share of a lamp's irradiance that passes, by rays to 60x60 points, or to a ball's."""
    rng = np.random.default_rng(5)
    if lamp.is_ball:
        out = rng.normal(size=(4000, 3))
        out /= np.linalg.norm(out, axis=1, keepdims=True)
        targets, front = lamp.corner + lamp.ball_radius * out, out
    else:
        s, t = np.meshgrid(*[(np.arange(60) + 0.5) / 60] * 2)
        targets = lamp.corner + s.reshape(-1, 1) * lamp.edge_u + t.reshape(-1, 1) * lamp.edge_v
        front = np.cross(lamp.edge_u, lamp.edge_v)
        front = front / np.linalg.norm(front)
    found = []
    for point in p:
        path = targets - point
        facing = -(path * front).sum(1)
        if lamp.both_sides:
            facing = np.abs(facing)
        weight = np.maximum(facing, 0) * np.maximum(path @ normal, 0) / (path**2).sum(1) ** 2
        found.append((weight * ~blocked(point, path)).sum() / weight.sum())
    return np.array(found)


def through(low: Array, high: Array) -> Callable[[Array, Array], Array]:
    """Whether segments p + t path, t in 0..1, meet any of the boxes low..high (B, 3)."""

    def blocked(p: Array, path: Array) -> Array:
        with np.errstate(divide="ignore", invalid="ignore"):
            ends = (np.stack([low, high])[:, :, None] - p) / path  # (2, B, N, 3)
        first, last = np.sort(ends, axis=0)
        return np.asarray(((first.max(-1) < last.min(-1)) & (last.min(-1) > 0)).any(0))

    return blocked


def room(tilt: float, *blockers: tuple[float, float, Array], lamp: int = LAMP) -> Scene:
    """A floor, a lamp of side 1 two metres above it, and black boxes of (width, depth, place)."""
    turn = turned(vector(0, 0, 1), tilt)
    return scene(
        part(quad(8.0), 0, turn),
        part(quad(), lamp, turn @ at(0, 2, 0) @ DOWN),
        *(part(box((w, 0.1, d)), 0, turn @ at(*place)) for w, d, place in blockers),
        materials=DARK,
    )


def boxes_of(*blockers: tuple[float, float, Array]) -> Callable[[Array, Array], Array]:
    half = np.array([[w, 0.1, d] for w, d, _ in blockers]) / 2
    places = np.array([place for *_, place in blockers])
    return through(places - half, places + half)


def assert_near(found: Array, wanted: Array, most: float = 0.06) -> None:
    """Pixels' penumbrae are smooth; a voxel's nine points make steps, right in the mean."""
    off = found - wanted[:, None]
    assert np.abs(off[:, 0]).mean() < 0.015
    assert np.abs(off[:, 0]).max() < most
    assert np.abs(off[:, 1]).mean() < 0.06
    assert abs(off[:, 1].mean()) < 0.015


PANE = (0.8, 0.8, (0.0, 1.0, 0.0))
BARS = [(0.05, 3.0, (x, 1.2, 0.0)) for x in np.arange(-1.5, 1.51, 0.15)]


@pytest.mark.parametrize("tilt", TILTS.values(), ids=TILTS)
def test_a_pane_throws_its_umbra_and_penumbra(seen: Seen, tilt: float) -> None:
    x = np.linspace(-1.8, 1.8, 73)
    p = np.stack([x, 0 * x, 0.3 * x], axis=-1)
    straight = room(0.0, PANE)
    (lamp,) = AreaLightBlock(straight, True).lights
    wanted = exact(lamp, p, UP, boxes_of(PANE))
    turn = turned(vector(0, 0, 1), tilt)[:3, :3].astype(float)
    found = seen(room(tilt, PANE), p @ turn.T, turn @ UP)
    assert wanted.min() == 0.0
    assert_near(found, wanted)


@pytest.mark.parametrize("turns", [0, 1])
def test_a_tube_throws_one_shadow_of_a_bar(seen: Seen, turns: int) -> None:
    """A wide one of a bar across, a sharp one of a bar along; whichever of its edges is longer."""
    tube = at(0, 2, 0) @ DOWN @ np.diag([2, 1, 0.05, 1]) @ turned(UP, turns * np.pi / 2)
    floor, lit = part(quad(8.0), 0, IDENTITY), part(quad(), LAMP, tube)
    for w, d, to in ((0.2, 3.0, (1.8, 0, 0.2)), (4.0, 0.2, (0.2, 0, 0.4))):
        bar = part(box((w, 0.1, d)), 0, at(0, 1, 0))
        world = scene(floor, lit, bar, materials=DARK)
        (lamp,) = AreaLightBlock(world, True).lights
        p = np.linspace(-np.array(to), to, 73)
        wanted = exact(lamp, p, UP, boxes_of((w, d, (0.0, 1.0, 0.0))))
        assert_near(seen(world, p, UP), wanted)


def test_bars_let_through_what_is_open_between_them(seen: Seen) -> None:
    """A third of the way is barred; voxels as wide as the gaps see the same share."""
    rng = np.random.default_rng(3)
    p = np.column_stack([rng.uniform(-0.5, 0.5, 300), np.zeros(300), rng.uniform(-0.5, 0.5, 300)])
    world = room(0.0, *BARS)
    (lamp,) = AreaLightBlock(world, True).lights
    wanted = exact(lamp, p[:60], UP, boxes_of(*BARS)).mean()
    found = seen(world, p, UP, 0.1).mean(axis=0)
    np.testing.assert_allclose(found, wanted, atol=0.03)
    assert 0.5 < wanted < 0.7


def test_a_lamp_at_a_ceiling_shadows_nothing_itself(seen: Seen) -> None:
    """Neither by its own surface, nor by the ceiling behind, nor by a frame flush with it."""
    height = 2.98
    frame = [(0.2, 1.4, (x, height + 0.05, 0)) for x in (-0.6, 0.6)]
    world = scene(
        part(quad(8.0), 0, IDENTITY),
        part(quad(8.0), 0, at(0, 3, 0) @ DOWN),
        part(quad(), LAMP, at(0, height, 0) @ DOWN),
        *(part(box((w, 0.1, d)), 0, at(*place)) for w, d, place in frame),
        part(quad(8.0), 0, at(2, 1.5, 0) @ turned(vector(0, 0, 1), np.pi / 2)),  # a wall
        materials=DARK,
    )
    x = np.linspace(-1.9, 1.9, 60)
    floor = np.stack([x, 0 * x, 0.7 * x], axis=-1)
    np.testing.assert_allclose(seen(world, floor, UP), 1.0, atol=1e-3)
    y = np.linspace(0.03, 2.9, 60)
    wall = np.stack([np.full(60, 2.0), y, 0.5 * y - 1.0], axis=-1)
    np.testing.assert_allclose(seen(world, wall, -np.eye(3)[0]), 1.0, atol=1e-3)


GROUND = part(quad(300.0), 0, at(0, -0.5, 0))


def test_a_large_scene_keeps_shadows_of_what_is_near_a_lamp(seen: Seen) -> None:
    lamp, plate = part(quad(0.5), LAMP, at(0, 2, 0) @ DOWN), part(quad(2.0), 0, at(0, 1.9, 0))
    p = np.linspace((-0.6, 0, -0.1), (0.6, 0, 0.1), 25)
    assert seen(scene(lamp, plate, GROUND, materials=DARK), p, UP).max() == 0.0


def test_light_that_grazes_leaves_no_acne(seen: Seen) -> None:
    """Down to 5 degrees, straight and diagonally across the texels."""
    lamp = part(quad(0.2), LAMP, at(0, 0.3, 0) @ DOWN)
    world = scene(part(quad(8.0), 0, IDENTITY), lamp, GROUND, materials=DARK)
    x = np.linspace(0.1, 3.4, 400)
    for across in (0.0, 0.37, 1.0):
        p = np.stack([x, 0 * x, across * x], axis=-1)
        np.testing.assert_allclose(seen(world, p, UP), 1.0, atol=1e-3)


def test_a_double_sided_lamp_lights_both_ways(seen: Seen) -> None:
    world = room(0.0, PANE, lamp=BOTH_SIDES)
    above = np.array([[0.2, 2.05, 0.1], [1.0, 2.5, 0.3], [0.0, 4.0, 0.0]])
    np.testing.assert_allclose(seen(world, above, -UP), 1.0, atol=1e-3)
    under = seen(world, np.zeros(3), UP)
    assert under.max() < 0.05


def test_a_ball_is_hidden_by_others_alone(seen: Seen) -> None:
    """Its own surface and a rod that holds it inside do not count."""
    rod = part(box((0.02, 0.5, 0.02)), 0, at(0, 2.0, 0))
    ball = part(sphere(0.3, 24), LAMP, at(0, 2, 0))
    floor = part(quad(8.0), 0, IDENTITY)
    pane = part(box((0.6, 0.1, 0.6)), 0, at(0, 1, 0))
    x = np.linspace(-1.6, 1.6, 65)
    p = np.stack([x, 0 * x, 0.2 * x], axis=-1)
    alone = scene(floor, ball, rod, materials=DARK)
    np.testing.assert_allclose(seen(alone, p, UP), 1.0, atol=1e-3)
    coarse = part(sphere(0.3, 6), LAMP, at(0, 2, 0) @ np.diag([1, 1.018, 1.018, 1]))
    np.testing.assert_allclose(seen(scene(floor, coarse, materials=DARK), p, UP), 1.0, atol=1e-3)
    behind = scene(floor, ball, rod, pane, materials=DARK)
    (lamp,) = AreaLightBlock(behind, True).lights
    wanted = exact(lamp, p, UP, boxes_of((0.6, 0.6, (0, 1, 0))))
    assert wanted.min() == 0.0
    assert_near(seen(behind, p, UP), wanted, most=0.1)


def test_points_spread_as_the_light_does() -> None:
    """Their mean is the middle, their variance the nine parts' or the disc's from anywhere."""
    (lamp,) = AreaLightBlock(room(0.0), True).lights
    spread = points(lamp)
    np.testing.assert_allclose(spread.mean(axis=0), [0, 2, 0], atol=1e-6)
    np.testing.assert_allclose(np.ptp(spread, axis=0), [2 / 3, 0, 2 / 3], atol=1e-6)
    ball = replace(lamp, is_ball=True, edge_u=vector(0.5, 0, 0))
    around = points(ball) - ball.corner
    wanted = np.eye(3) * 0.5**2 / 4
    np.testing.assert_allclose(np.cov(around.T, bias=True), wanted, rtol=0.01, atol=1e-6)


def lit_stage(count: int) -> Scene:
    """A floor, a ball that can move and so many lamps in a row, each weaker than the last."""
    lamps = [part(quad(0.5), 2 + n, at(n - count / 2, 2, 0) @ DOWN) for n in range(count)]
    world = scene(
        part(quad(6.0), 0, IDENTITY),
        part(sphere(0.3), 1, at(0, 0.6, 0)),
        *lamps,
        materials=[
            colored(0.7, 0.7, 0.7),
            colored(0.5, 0.1, 0.1),
            *(glowing(9.0 - n) for n in range(count)),
        ],
    )
    world.instances[1].dynamic = True
    return world


def test_the_strongest_that_stand_get_maps(renderers: Any) -> None:
    world = lit_stage(EMITTERS_MAX + 2)
    world.instances[3].dynamic = True  # the second
    renderer = renderers(world, **{"gi.area_shadows": "maps"})
    frame = renderer.render(EYE, 0.0, 0)
    views = renderer._area_lights.block["faces"]["shadow_view"]
    assert views.tolist()[:6] == [0, -1, 45, 90, 135, -1]
    assert frame.counters["area_lights_without_maps"] == 1
    assert frame.counters["shadow_maps"] == 45 * EMITTERS_MAX
    assert renderer._shadows.reads()["u_shadow_maps"].texture.layers > 1
    renderer.set_settings(renderer.settings.replace({"gi.area_shadows": "cones"}))
    frame = renderer.render(EYE, 0.0, 1)
    assert frame.counters["shadow_maps"] == frame.counters["area_lights_without_maps"] == 0
    assert renderer._shadows.reads()["u_shadow_maps"].texture.layers == 1  # and their memory goes


def test_other_lights_leave_the_maps_alone() -> None:
    """Nor do colours change them: neither views nor tiles."""
    (lamp,) = AreaLightBlock(room(0.0), True).lights
    bulb = Light(name="", kind="point", color=vector(1, 1, 1), intensity=1.0,
                 position=vector(0, 1, 1), direction=vector(0, -1, 0))  # fmt: skip
    planner = ShadowPlanner(ShadowSettings(256))

    def views(lamps: list[AreaLight], *heights: float) -> PackedViews:
        lights = [replace(bulb, position=vector(0, y, 1)) for y in heights]
        return planner.plan(lights, (vector(-4, 0, -4), vector(4, 2, 4)), ANY, (8, 8), lamps).views

    first = views([lamp], 1.0)
    assert np.isfinite(first.blocks[0]["cut_heights_m"]).all()
    for again in (views([lamp], 1.1), views([replace(lamp, radiance=vector(1, 2, 3))], *range(40))):
        assert all(a is b for a, b in zip(again.blocks[:45], first.blocks, strict=False))
        assert again.tiles[:45] == first.tiles[:45]
        assert again.tiles[45:] != first.tiles[45:] or len(again.tiles) == len(first.tiles)
    assert views([replace(lamp, corner=vector(0, 2, 1))]).shown[0] != first.shown[0]


def test_another_cut_draws_the_maps_anew(rig: MakeRig) -> None:
    """A ball of the same area and place, but with corners farther out."""
    world = scene(part(sphere(0.3, 24), LAMP, at(0, 2, 0)), materials=DARK)
    view = rig(world, ANY)
    (lamp,) = AreaLightBlock(world, True).lights

    def stale(light: AreaLight) -> int:
        plan = view.shadows.planner.plan([], view.gpu.bounds, ANY, (8, 8), [light])
        return len(view.shadows.place(plan, view.gpu))

    assert [stale(lamp), stale(lamp), stale(replace(lamp, edge_v=1.05 * lamp.edge_v))] == [
        54,
        0,
        54,
    ]


def test_of_a_body_s_faces_the_largest_get_maps() -> None:
    lamp = part(box((0.1, 1.0, 0.7)), LAMP, IDENTITY)
    block = AreaLightBlock(
        scene(lamp, part(quad(9.0), 0, at(0, -3, 0)), materials=DARK), True, True
    )
    by_flux = sorted(light.flux for light in block.lights)
    assert [light.flux for light in block.mapped] == by_flux[:1:-1]
    assert by_flux[1] < by_flux[2]
    mapped = block.block["faces"]["shadow_view"][:6] >= 0
    assert [any(light is m for m in block.mapped) for light in block.lights] == mapped.tolist()


def test_lamps_add_up(renderers: Any) -> None:
    """Each is shadowed as if it were alone."""

    def shown(*lamps: float) -> Array:
        lit = (part(quad(0.5), LAMP, at(x, 2, 0) @ DOWN) for x in lamps)
        pane = part(box((0.8, 0.1, 0.8)), 0, at(0, 0.8, 0))
        white = [colored(0.7, 0.7, 0.7), glowing(9.0)]
        world = scene(part(quad(6.0), 0, IDENTITY), pane, *lit, materials=white)
        renderer = renderers(world, **{"gi.area_shadows": "maps", "gi.specular": False})
        return renderer.read(renderer.render(EYE, 0.0, 0, "diffuse_gi"))[..., 0]

    three, sum_of_three = shown(-1, 0.2, 1), sum(shown(x) for x in (-1, 0.2, 1))
    np.testing.assert_allclose(three, sum_of_three, rtol=0.03, atol=0.01 * three.max())


def test_what_moves_redraws_the_maps_that_see_it(device: Device, renderers: Any) -> None:
    """And the picture is that of a scene that begins there."""
    world = lit_stage(1)
    settings = {"gi.area_shadows": "maps", "gi.bounces": 2}
    renderer = renderers(world, **settings)

    def moved(x: float) -> tuple[Array, set[str]]:
        pose = pose_of(instances=np.array([1]), world_from_local=at(x, 0.6, 0)[None],
                       visible=np.array([True]), lights=[])  # fmt: skip
        shown = renderer.read(renderer.render(EYE, 0.0, 0, "scene_color", pose))
        device.finish()
        return shown, {t.name for t in device.timings if t.name.startswith("shadow.emitter")}

    before, drawn = moved(0.0)
    assert len(drawn) == 90  # what stands, and with what moves
    assert moved(0.0)[1] == set()
    after, drawn = moved(0.8)
    assert 9 <= len(drawn) < 45
    assert np.abs(after - before).max() > 0.1
    world.instances[1].world_from_local = at(0.8, 0.6, 0)
    fresh = picture(renderers(world, **settings), 0.0)
    np.testing.assert_allclose(after, fresh, rtol=2.0**-8, atol=2.0**-10)
