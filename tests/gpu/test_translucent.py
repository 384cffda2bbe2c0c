"""Translucent surfaces in frames: sorted, lit as opaque ones are, and glass. SH-06"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from elemental.frame import Renderer
from elemental.gpu.device import Device
from elemental.passes.forward import GRABS_MAX, layers_of
from elemental.scene.definitions import builtin
from elemental.scene.model import (
    Camera,
    Environment,
    Material,
    Scene,
    Texture,
    TextureSlot,
)
from elemental.settings import Settings
from gpu.rig import IDENTITY, MakeRig, Rig, at, camera, material, mesh, scene, sun, vector
from gpu.voxel.scenes import colored, facing, glowing, part
from shapes import box, quad, sphere

Array = npt.NDArray[Any]
FRONT = camera(vector(0, 0, 4), vector(0, 0, 0), fov_y=0.5)
CENTER = (32, 48)


def upright(size: float, index: int, z: float, x: float = 0.0) -> Any:
    """A square that faces +z."""
    matrix = facing(vector(0, 0, 1))
    matrix[:3, 3] = x, 0, z
    return mesh(quad(size), index), matrix


def light_wall(*rgb: float) -> Material:
    """Shows a radiance, whatever the light."""
    return material(definition=builtin("unlit"), base_color=vector(*rgb, 1))


def glass(**fields: Any) -> Material:
    given = {"transmission": 1.0, "roughness": 0.0, "alpha_mode": "blend", **fields}
    return material(**given)


FACE = 0.0426
"""Share that a face of smooth glass of an index of 1.5 mirrors straight on: the frame's fit."""
PASSES = (1 - FACE) / (1 + FACE)
"""Share that passes both faces of a clear pane, straight on."""


def radiance(view: Rig) -> Array:
    return view.scene_color()[..., :3]


def test_a_pane_lets_through_what_it_does_not_mirror(rig: MakeRig) -> None:
    walls = [light_wall(0.5, 0.4, 0.3), glass()]
    bare = radiance(rig(scene(upright(6, 0, -2), materials=walls), FRONT))[CENTER]
    seen = radiance(rig(scene(upright(6, 0, -2), upright(1, 1, 0), materials=walls), FRONT))[CENTER]
    np.testing.assert_allclose(seen, bare * PASSES, rtol=0.01)


def test_the_base_colour_tints_and_the_body_absorbs(rig: MakeRig) -> None:
    """KHR_materials_volume: colour ^ (path / distance), on top of the base colour."""
    wall = light_wall(0.5, 0.5, 0.5)
    clear, tinted = glass(), glass(base_color=vector(0.2, 0.5, 0.9, 1))
    body = glass(thickness=0.2, attenuation_color=vector(0.9, 0.5, 0.1), attenuation_distance=0.1)
    seen = []
    for pane in (clear, tinted, body):
        world = scene(upright(6, 0, -2), upright(1, 1, 0), materials=[wall, pane])
        seen.append(radiance(rig(world, FRONT))[CENTER])
    np.testing.assert_allclose(seen[1] / seen[0], [0.2, 0.5, 0.9], rtol=0.01)
    np.testing.assert_allclose(seen[2] / seen[0], np.array([0.9, 0.5, 0.1]) ** 2, rtol=0.02)
    large, matrix = upright(0.5, 1, 0)  # thickness is in the mesh's own units
    matrix = matrix @ np.diag([2, 2, 2, 1]).astype(np.float32)
    world = scene(upright(6, 0, -2), (large, matrix), materials=[wall, body])
    scaled = radiance(rig(world, FRONT))[CENTER]
    np.testing.assert_allclose(scaled / seen[0], np.array([0.9, 0.5, 0.1]) ** 4, rtol=0.03)


def test_a_picture_says_where_light_passes(rig: MakeRig) -> None:
    """The definition "glass": what does not pass is scattered, as a white surface does."""
    pixels = np.full((1, 2, 4), 255, np.uint8)
    pixels[0, 1, 0] = 0
    halves = Texture("halves", pixels, nearest=True)
    window = glass(definition=builtin("glass"), textures={"transmission_texture": TextureSlot(0)})
    square, matrix = upright(1.2, 1, 0)
    square.uv0 = (square.positions[:, [0, 2]] / 1.2 + 0.5).astype(np.float32)
    walls, lamp = [light_wall(0.5, 0.5, 0.5), window], sun(vector(0, 0, -1), casts_shadow=False)
    parts = upright(6, 0, -2), (square, matrix)
    world = scene(*parts, materials=walls, textures=[halves], lights=[lamp])
    row = radiance(rig(world, FRONT))[32, 36:60, 0]
    passes, scatters = row[:9], row[-9:]
    assert abs(passes.mean() - scatters.mean()) > 0.2
    assert passes.std() < 0.02
    np.testing.assert_allclose(sorted([passes.mean(), scatters.mean()]), [0.5, 1.0], atol=0.06)


def test_a_ball_shows_the_world_upside_down(rig: MakeRig) -> None:
    """Red on the left, blue on the right: through a ball of glass the sides change places."""
    walls = [light_wall(1, 0, 0), light_wall(0, 0, 1), glass(thickness=1.0)]
    ball = mesh(sphere(0.5, rings=48), 2, smooth=True)
    world = scene(
        upright(6, 0, -3, x=-3), upright(6, 1, -3, x=3), (ball, IDENTITY), materials=walls
    )
    got = radiance(rig(world, FRONT))
    assert got[32, 20, 0] > got[32, 20, 2] + 0.9  # beside the ball
    assert got[32, 42, 2] > got[32, 42, 0] + 0.8
    assert got[32, 53, 0] > got[32, 53, 2] + 0.8
    thin = scene(upright(6, 0, -3, x=-3), upright(6, 1, -3, x=3), (ball, IDENTITY),
                 materials=[*walls[:2], glass()])  # fmt: skip
    got = radiance(rig(thin, FRONT))
    assert got[32, 42, 0] > got[32, 42, 2] + 0.8


def edge_width(got: Array) -> float:
    """Standard deviation, in px, of the step from dark to light along the middle row."""
    step = np.clip(np.diff(got[32, 24:72, 0]), 0, None)
    at_px = np.arange(len(step))
    mean = (step * at_px).sum() / step.sum()
    return float(np.sqrt((step * (at_px - mean) ** 2).sum() / step.sum()))


def test_frosted_glass_blurs_the_more_the_farther_things_are_behind(rig: MakeRig) -> None:
    widths = {}
    for roughness in (0.0, 0.3, 0.5):
        for z in (-0.05, -2.0):
            walls = [light_wall(0, 0, 0), light_wall(1, 1, 1), glass(roughness=roughness)]
            world = scene(upright(6, 0, z, x=-3), upright(6, 1, z, x=3), upright(3, 2, 0),
                          materials=walls)  # fmt: skip
            widths[roughness, z] = edge_width(radiance(rig(world, FRONT)))
    assert widths[0.0, -2.0] < 0.7
    assert widths[0.3, -2.0] > 2.0
    assert widths[0.5, -2.0] > 1.5 * widths[0.3, -2.0]
    assert widths[0.3, -0.05] < 0.5 * widths[0.3, -2.0]


def test_glass_is_seen_through_glass(rig: MakeRig) -> None:
    """A red pane behind a clear one, however they are listed."""
    walls = [light_wall(0.5, 0.5, 0.5), glass(base_color=vector(0.8, 0.1, 0.1, 1)), glass()]
    red, clear = upright(1, 1, -0.5), upright(1, 2, 0.5)
    both = []
    for panes in ((red, clear), (clear, red)):
        world = scene(upright(6, 0, -2), *panes, materials=walls)
        both.append(radiance(rig(world, FRONT))[CENTER])
    np.testing.assert_allclose(both[0], both[1], rtol=2e-3)
    want = 0.5 * np.array([0.8, 0.1, 0.1]) * PASSES**2
    np.testing.assert_allclose(both[0], want, rtol=0.03)


def look(world: Scene, view: Rig, eye: Camera) -> list[Any]:
    _, block, _ = view.begin()
    clip = np.asarray(block["clip_from_world"]).T
    return list(layers_of(view.gpu, clip, eye.world_from_view[:3, 3]))


def test_layers_go_from_far_to_near_and_back_faces_first(rig: MakeRig) -> None:
    two_sided = glass(double_sided=True)
    plain = material(alpha_mode="blend", base_color=vector(1, 1, 1, 0.5))
    world = scene(
        upright(1, 1, 0.5), upright(1, 0, -0.5), upright(1, 2, 1.0), upright(0.2, 0, 0, x=50),
        materials=[two_sided, plain, glass()],
    )  # fmt: skip
    layers = look(world, rig(world, FRONT), FRONT)
    told = [(layer.batch.instance, layer.side, layer.grab) for layer in layers]
    # The two-sided one, then the plain one before it, which the nearest sees; one is out of sight.
    assert told == [(1, "back", 0), (1, "front", 1), (0, "front", -1), (2, "front", 2)]


def test_pictures_of_what_is_behind_are_few(rig: MakeRig) -> None:
    panes = [upright(1, 0, 0.1 * n) for n in range(9)]
    beside = [upright(0.1, 0, 0, x=0.2 * n - 0.8) for n in range(9)]
    stacked, apart = scene(*panes, materials=[glass()]), scene(*beside, materials=[glass()])
    assert max(layer.grab for layer in look(stacked, rig(stacked, FRONT), FRONT)) == GRABS_MAX - 1
    assert max(layer.grab for layer in look(apart, rig(apart, FRONT), FRONT)) == 0


def test_nothing_translucent_costs_no_pass(rig: MakeRig) -> None:
    view = rig(scene(upright(1, 0, 0), materials=[material()]), FRONT)
    assert look(view.scene, view, FRONT) == []


def test_a_two_sided_sheet_covers_twice(rig: MakeRig) -> None:
    """A ball of one sheet of opacity 1/2: three quarters of what is behind are hidden."""
    sheet = material(definition=builtin("unlit"), base_color=vector(0, 0, 0, 0.5),
                     alpha_mode="blend", double_sided=True)  # fmt: skip
    ball = mesh(sphere(0.5, rings=24), 1, smooth=True)
    walls = [light_wall(0.8, 0.8, 0.8), sheet]
    got = radiance(rig(scene(upright(6, 0, -2), (ball, IDENTITY), materials=walls), FRONT))
    np.testing.assert_allclose(got[CENTER], 0.2, rtol=0.01)


def test_triangles_of_one_mesh_are_sorted(rig: MakeRig) -> None:
    """Two sheets of one mesh, from both sides: the nearer one is over the farther one, whatever the
    order of their triangles; and again when the instance is turned around."""
    sheet = material(definition=builtin("unlit"), base_color=vector(1, 1, 1, 0.5),
                     alpha_mode="blend", double_sided=True)  # fmt: skip
    near, far = mesh(quad(1.0)), mesh(quad(1.0))
    near.positions[:, 1], far.positions[:, 1] = 0.2, -0.2
    near.colors[:, :3], far.colors[:, :3] = (255, 0, 0), (0, 255, 0)
    turned, back = facing(vector(0, 0, 1)), facing(vector(0, 0, -1))
    for first, second in ((near, far), (far, near)):
        both = replace(
            first,
            **{name: np.concatenate([getattr(first, name), getattr(second, name)])
               for name in ("positions", "normals", "tangents", "uv0", "uv1", "colors")},
            indices=np.concatenate([first.indices, second.indices + len(first.positions)]),
        )  # fmt: skip
        for matrix, over in ((turned, 0), (back, 1)):
            got = radiance(rig(scene((both, matrix), materials=[sheet]), FRONT))[CENTER]
            want = [0.25, 0.25, 0.0]
            want[over] = 0.5
            np.testing.assert_allclose(got, want, atol=0.01)


def test_shadows_fall_on_translucent_surfaces(rig: MakeRig) -> None:
    sheet = material(alpha_mode="blend", base_color=vector(0.8, 0.8, 0.8, 0.9))
    down = camera(vector(0, 4, 0.01), vector(0, 0, 0), fov_y=0.5)
    parts = (mesh(quad(2.0), 0), IDENTITY), (mesh(box((0.4, 0.1, 0.4)), 1), at(0.8, 1.0, 0))
    world = scene(*parts, materials=[sheet, material()], lights=[sun(vector(-0.8, -1, 0), 3.0)])
    got = radiance(rig(world, down))
    assert got[32, 48, 0] < 0.05 * got[32, 24, 0]


def rendered(device: Device, world: Scene, eye: Camera, **settings: Any) -> Array:
    small = {"gi.resolution": 64, "ao.intensity": 0.0, "gbuffer.blur": False,
             "shadow.resolution": 512, **settings}  # fmt: skip
    renderer = Renderer(device, world, Settings(small), (96, 64))
    try:
        return renderer.read(renderer.render(eye, 0.0, 0, "scene_color"))[..., :3]
    finally:
        renderer.release()


def room(panel: Material, *lamp: Any) -> Scene:
    """A room with a red wall on the left, and a panel in its middle that faces it."""
    matrix = facing(vector(-0.8, 0, 0.6))
    return scene(
        part(box((2, 0.1, 2)), 0, at(0, -1, 0)),
        part(box((2, 0.1, 2)), 0, at(0, 1, 0)),
        part(box((2, 2, 0.1)), 0, at(0, 0, -1)),
        part(box((0.1, 2, 2)), 1, at(-1, 0, 0)),
        (mesh(quad(0.7), 2), matrix),
        *lamp,
        materials=[colored(0.8, 0.8, 0.8), colored(0.8, 0.05, 0.05), panel, glowing(6, 6, 6)],
        lights=[] if lamp else [sun(vector(-0.9, -0.5, -0.6), 4.0)],
    )


IN_ROOM = camera(vector(0, 0, 3), vector(0, 0, 0), fov_y=0.5)
LAMP = part(box((0.6, 0.02, 0.6)), 3, at(0, 0.93, 0))


@pytest.mark.parametrize("lamp", [(), (LAMP,)], ids=["sun", "lamp"])
@pytest.mark.parametrize("roughness", [1.0, 0.2])
def test_indirect_light_is_as_on_an_opaque_panel(
    device: Device, roughness: float, lamp: tuple[Any, ...]
) -> None:
    """Gathered at its own place: opacity 1 in the forward pass is the deferred picture.

    By the nine cones that it has.
    """
    fields = {"base_color": vector(0.7, 0.7, 0.7, 1), "roughness": roughness}
    solid, blended = material(**fields), material(alpha_mode="blend", **fields)
    nine = {"gi.diffuse_cones": 9}
    pictures = [rendered(device, room(panel, *lamp), IN_ROOM, **nine) for panel in (solid, blended)]
    panel = np.s_[26:38, 40:56]
    want, got = (picture[panel].mean(axis=(0, 1)) for picture in pictures)
    assert want[0] > 0.02
    np.testing.assert_allclose(got, want, rtol=0.12, atol=2e-3)
    np.testing.assert_allclose(pictures[0][:8], pictures[1][:8], rtol=0.02, atol=2e-3)


def test_clear_glass_leaves_the_voxels_alone(device: Device) -> None:
    """No voxel is made of it, so the room behind it is as bright as without it."""
    pictures = []
    for panel in (glass(), None):
        world = room(panel or material())
        if panel is None:
            del world.instances[4]
        pictures.append(rendered(device, world, IN_ROOM))
    beside = np.s_[:, :16]
    np.testing.assert_allclose(pictures[0][beside], pictures[1][beside], rtol=0.02, atol=2e-3)


def test_glass_mirrors_the_sky_and_what_stands_before_it(device: Device) -> None:
    """A pane in the dark mirrors a red wall behind the eye, which a cone finds."""
    red = glowing(1, 0, 0)
    world = scene(
        part(box((4, 4, 0.1)), 0, at(0, 0, 3.0)), upright(1, 1, 0),
        part(box((4, 4, 0.1)), 2, at(0, 0, -2.0)),
        materials=[red, glass(), colored(0, 0, 0)],
        environment=Environment(None, vector(0, 0, 0), 0.0),
    )  # fmt: skip
    eye = camera(vector(0, 0, 2.5), vector(0, 0, 0), fov_y=0.4)
    got = rendered(device, world, eye, **{"gi.area_lights": False})
    np.testing.assert_allclose(got[CENTER][0], 1 - PASSES, rtol=0.15)
    assert got[CENTER][1:].max() < 1e-3
