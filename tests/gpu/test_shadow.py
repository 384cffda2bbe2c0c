"""Shadow maps against ray casts and closed forms; when they are drawn anew. SH-09"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from elemental.gpu.device import Device
from elemental.passes.shadow_plan import ShadowSettings
from elemental.scene.model import Light, Scene, Texture, TextureSlot
from glsl.harness import run_glsl
from gpu.rig import IDENTITY, MakeRig, Rig, at, camera, material, mesh, scene, sun, vector
from shapes import box, quad, sphere

Array = npt.NDArray[Any]
HIGH = camera(vector(0, 9, 0.01), vector(0, 0, 0), fov_y=0.5)
SLANTED = vector(0.5, -1.0, 0.25)
FULLY_LIT = 1.0 - 1e-3
"""What rounding to half floats leaves of 1."""


def lamp(kind: str, position: Array, target: Array, **fields: Any) -> Light:
    direction = (target - position) / np.linalg.norm(target - position)
    given = {"outer_angle": 0.7, "inner_angle": 0.6, **fields}
    return Light("lamp", kind, vector(1, 1, 1), 10.0, position, direction, **given)  # type: ignore[arg-type]


LIGHTS: dict[str, tuple[Light, Callable[[Array], Array]]] = {
    "sun": (sun(SLANTED), lambda p: np.broadcast_to(-SLANTED, p.shape)),
    "spot": (
        lamp("spot", vector(-1, 3, 0.5), vector(0, 0, 0)),
        lambda p: vector(-1, 3, 0.5) - p,
    ),
    "point": (
        lamp("point", vector(-0.5, 2.5, 0.2), vector(0, 0, 0)),
        lambda p: vector(-0.5, 2.5, 0.2) - p,
    ),
}


def floor_points(half: float = 1.5, count: int = 150) -> Array:
    x, z = np.meshgrid(*[np.linspace(-half, half, count)] * 2)
    return np.stack([x.ravel(), np.zeros(x.size), z.ravel()], axis=-1)


def world_visibility(view: Rig, points: Array, normal: Array, offset: float = 0.0) -> Array:
    """light_visibility of light 0, as voxel lighting asks for it."""
    view.begin()[0].execute()
    body = f"light_visibility(0u, p, n, {offset})"
    normals = np.broadcast_to(normal, points.shape)
    inputs = {"p": points, "n": normals}
    return run_glsl(view.device, ["lib/shadow.glsl"], body, inputs, reads=view.shadows.reads())


def shaded_by_pane(points: Array, towards: Array, height: float, half: float) -> Array:
    """Whether the segment from a floor point meets a square pane at that height."""
    step = height / towards[:, 1:2]
    crossing = points + towards * step
    return np.all(np.abs(crossing[:, [0, 2]]) < half, axis=1)


def pane_over_floor(light: Light) -> Scene:
    return scene(
        (mesh(quad(4.0)), IDENTITY),
        (mesh(quad(0.8)), at(0, 1, 0)),
        materials=[material(double_sided=True)],
        lights=[light],
    )


@pytest.mark.parametrize("kind", LIGHTS)
def test_a_pane_s_shadow_is_where_rays_say(rig: MakeRig, kind: str) -> None:
    light, towards = LIGHTS[kind]
    points = floor_points()
    got = world_visibility(rig(pane_over_floor(light), HIGH), points, vector(0, 1, 0))
    dark = shaded_by_pane(points, towards(points), 1.0, 0.4)
    # The edge may be grey for the filter's width, and the receiver's offset shrinks what diverges.
    assert abs((1.0 - got).sum() / dark.sum() - 1.0) < 0.03
    assert np.mean((got < 0.5) != dark) < 0.01
    assert np.mean((got > 0.0) & (got < 1.0)) < 0.06


def test_a_pane_s_shadow_has_its_area_in_the_picture(rig: MakeRig) -> None:
    """The sun's shadow of a level pane is as large as the pane; seen from above, a pixel covers the
    same area everywhere on the floor."""
    low_sun = sun(vector(1.0, -1.0, 0.0))
    view = rig(pane_over_floor(low_sun), HIGH, size=(160, 120))
    visibility, points = view.visibility(), view.positions()
    floor = np.abs(points[..., 1]) < 0.01
    pixel_m = 2.0 * 9.0 * np.tan(HIGH.fov_y / 2.0) / 120
    area = (1.0 - visibility[floor]).sum() * pixel_m**2
    assert abs(area / 0.64 - 1.0) < 0.03


@pytest.mark.parametrize("elevation_deg", [3, 10, 30, 60, 90])
def test_a_lit_plane_has_no_acne(rig: MakeRig, elevation_deg: float) -> None:
    angle = np.radians(elevation_deg)
    direction = vector(np.cos(angle) * 0.8, -np.sin(angle), np.cos(angle) * 0.6)
    world = scene((mesh(quad(40.0)), IDENTITY), lights=[sun(direction)])
    low = camera(vector(0, 1, 6), vector(0, 0, -4), fov_y=1.0)
    view = rig(world, low, size=(160, 120))
    visibility, points = view.visibility(), view.positions()
    assert visibility[np.isfinite(points[..., 0])].min() > FULLY_LIT
    assert world_visibility(view, floor_points(15.0), vector(0, 1, 0)).min() > FULLY_LIT


@pytest.mark.parametrize("height", [0.05, 0.5, 4.0])
@pytest.mark.parametrize("kind", ["spot", "point"])
def test_local_lights_leave_no_acne_and_no_seams(rig: MakeRig, kind: str, height: float) -> None:
    source = lamp(kind, vector(0.3, height, 0.1), vector(0.3, 0, 0.1), outer_angle=1.2)
    world = scene((mesh(quad(12.0)), IDENTITY), lights=[source])
    got = world_visibility(rig(world, HIGH), floor_points(5.0), vector(0, 1, 0))
    assert got.min() > FULLY_LIT


def test_a_smooth_ball_has_no_acne(rig: MakeRig) -> None:
    """Away from the terminator, where facets turn away before the smooth normal does."""
    world = scene((mesh(sphere(rings=64), smooth=True), IDENTITY), lights=[sun(SLANTED)])
    view = rig(world, camera(vector(-1.5, 3, 1), vector(0, 0, 0), fov_y=0.8), size=(160, 120))
    visibility, points = view.visibility(), view.positions()
    n_o_l = points @ (-SLANTED / np.linalg.norm(SLANTED))
    assert visibility[n_o_l > 0.1].min() > FULLY_LIT


@pytest.mark.parametrize("in_view", [False, True])
def test_a_box_s_shadow_starts_at_its_foot(rig: MakeRig, in_view: bool) -> None:
    """No peter-panning: the floor is dark right behind a standing box."""
    standing = (mesh(box((0.5, 1, 0.5))), at(0, 0.5, 0))
    world = scene((mesh(quad(4.0)), IDENTITY), standing, lights=[sun(SLANTED)])
    view = rig(world, HIGH, shadow_settings=ShadowSettings(1024))
    texel = 4.5 / 1024
    away = np.linspace(2.0, 40.0, 60) * texel
    points = np.stack([0.25 + away, 0 * away, 0 * away], axis=-1)
    view.begin()[0].execute()
    body = f"light_visibility{'_in_view(0u, p, n)' if in_view else '(0u, p, n, 0.0)'}"
    inputs = {"p": points, "n": np.broadcast_to(vector(0, 1, 0), points.shape)}
    reads = view.shadows.reads()
    got = run_glsl(view.device, ["lib/shadow.glsl"], body, inputs, reads=reads)
    assert got.max() == 0.0


@pytest.mark.parametrize("kind", LIGHTS)
@pytest.mark.parametrize(
    ("contact", "size"),
    [(False, 0.0), (True, 0.0), (True, 0.006)],
    ids=["plain", "contact", "soft"],
)
def test_no_light_falls_through_the_joint_of_two_sheets(
    rig: MakeRig, contact: bool, size: float, kind: str
) -> None:
    """Behind a sheet that stands on a floor all is dark, before it all is lit, up to the joint.

    Filtering alone leaves a line of either within its radius. Where a light has a size the
    penumbra is narrower than the filter so near to the blocker, as the real sun's.
    """
    upright = np.array([[0, -1, 0, 0], [1, 0, 0, 0.5], [0, 0, 1, 0], [0, 0, 0, 1]], np.float32)
    world = scene(
        (mesh(quad(4.0)), IDENTITY),
        (mesh(quad(1.0)), upright),
        materials=[material(double_sided=True)],
        lights=[replace(LIGHTS[kind][0], source_radius=size)],
    )
    view = rig(world, HIGH, shadow_settings=ShadowSettings(1024))
    texel = 4.5 / 1024
    away, along = np.meshgrid(np.linspace(0.05, 3.0, 60) * texel, np.linspace(-0.3, 0.3, 41))
    behind = np.stack([away.ravel(), 0 * away.ravel(), along.ravel()], axis=-1)
    before = behind * vector(-1, 1, 1) - vector(0.3 * texel, 0, 0)
    view.begin()[0].execute()

    def seen(points: Array) -> Array:
        return run_glsl(
            view.device,
            ["lib/shadow.glsl"],
            "light_visibility_in_view(0u, p, n)",
            {"p": points, "n": np.broadcast_to(vector(0, 1, 0), points.shape)},
            reads=view.shadows.depth_reads(contact),
            defines={"CONTACT_SHADOWS": int(contact), "SOFT_SHADOWS": int(view.shadows.soft)},
        )

    assert view.shadows.soft == (size > 0.0)
    if contact:
        assert seen(behind).max() == 0.0
        assert seen(before).min() >= 0.8
    else:
        assert seen(behind).max() > 0.2
        assert seen(before).min() < 0.7


def test_masked_holes_let_light_through(rig: MakeRig) -> None:
    pixels = np.full((2, 2, 4), 255, np.uint8)
    pixels[0, 0, 3] = 0
    materials = [
        material(),
        material(alpha_mode="mask", base_color_texture=TextureSlot(0), double_sided=True),
    ]
    pane = mesh(quad(0.8), 1)
    pane.uv0[:] = pane.uv0 / 0.8 + 0.5
    light, towards = LIGHTS["sun"]
    world = scene(
        (mesh(quad(4.0)), IDENTITY), (pane, at(0, 1, 0)),
        materials=materials, textures=[Texture("t", pixels, nearest=True)], lights=[light],
    )  # fmt: skip
    points = floor_points()
    got = world_visibility(rig(world, HIGH), points, vector(0, 1, 0))
    whole = shaded_by_pane(points, towards(points), 1.0, 0.4)
    assert abs((1.0 - got).sum() / (0.75 * whole.sum()) - 1.0) < 0.03


def drawn(view: Rig) -> set[str]:
    """Shadow passes of the next frame."""
    g, _, gb = view.begin()
    g.keep(gb.depth)
    names = {item.name for item in g.passes if item.name.startswith("shadow.")}
    g.execute()
    return names


def test_maps_are_drawn_only_when_their_view_changes(rig: MakeRig) -> None:
    lights = [sun(SLANTED), LIGHTS["spot"][0]]
    world = scene((mesh(quad(40.0)), IDENTITY), lights=lights)
    near = camera(vector(0, 1, 4), vector(0, 0, 0), far=10.0)
    view = rig(world, near)
    cascades = {"shadow.0.cascade.0", "shadow.0.cascade.1", "shadow.0.cascade.2"}
    assert drawn(view) == cascades | {"shadow.0.directional.0", "shadow.1.spot.0"}
    assert drawn(view) == set()
    key = view.shadows.light_key
    view.camera = camera(vector(5, 1, 4), vector(5, 0, 0), far=10.0)
    assert drawn(view) == cascades
    assert view.shadows.light_key == key
    world.lights[1] = replace(lights[1], position=vector(-1, 3.5, 0.5))
    assert drawn(view) == {"shadow.1.spot.0"}
    assert view.shadows.light_key != key
    view.gpu.version += 2  # of which the maps have not seen the changes
    assert len(drawn(view)) == 5


def test_a_light_can_come_and_go(rig: MakeRig) -> None:
    world = pane_over_floor(LIGHTS["point"][0])
    view = rig(world, HIGH)
    assert len(drawn(view)) == 6
    world.lights = []
    assert drawn(view) == set()
    assert view.visibility().max() == 0.0
    world.lights = [
        LIGHTS["point"][0],
        LIGHTS["spot"][0],
        replace(sun(SLANTED), casts_shadow=False),
    ]
    assert len(drawn(view)) == 7


def test_turning_the_camera_moves_a_cascade_by_whole_texels(device: Device, rig: MakeRig) -> None:
    """A point of the floor keeps its place inside a texel, so edges do not crawl."""
    world = scene((mesh(quad(40.0)), IDENTITY), lights=[sun(SLANTED)])
    view = rig(world, camera(vector(0, 1, 4), vector(0, 0, 0), far=10.0))
    poses = (((0, 1, 4), (0, 0, 0)), ((0.3, 1.1, 3.7), (1, 0, 0)), ((1, 1, 3), (4, 0, 1)))
    body = """
        vec4 p_cs = shadow_views[1].clip_from_world * vec4(p, 1.0);
        result = (p_cs.xy * 0.5 + 0.5) * 512.0;
    """
    point = {"p": vector(0.2, 0, 0.3)[None]}
    places = []
    for eye, target in poses:
        view.camera = camera(vector(*eye), vector(*target), far=10.0)
        view.begin()[0].execute()
        reads = {"ShadowViews": view.shadows.reads()["ShadowViews"]}
        texel = run_glsl(device, ["shared/shadow.glsl"], body, point, "vec2", reads=reads)
        places.append(texel[0])
    difference = np.array(places) - places[0]
    assert np.abs(difference).max() > 5.0
    np.testing.assert_allclose(difference, np.rint(difference), atol=0.02)
