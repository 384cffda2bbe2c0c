"""Decals in the G-buffer: where they are, how they blend, what refuses them. SH-07"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from elemental.passes.decal import Decals
from elemental.scene.definitions import builtin, read_definition
from elemental.scene.materials import Material
from elemental.scene.model import Camera, Decal, Scene, Texture, TextureSlot
from gpu.rig import IDENTITY, MakeRig, Rig, at, camera, material, mesh, read, scene, vector
from shapes import box, quad, sphere

Array = npt.NDArray[Any]
ABOVE = camera(vector(0, 3, 0.001), vector(0, 0, 0), fov_y=0.8)
FACING_UP = np.array([[1, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]], np.float32)
"""world_from_decal of a unit box that projects downwards; the picture's top points to -z."""
RED = material(base_color=vector(1, 0, 0, 1), roughness=0.3)


def placed(material: int = 1, size: tuple[float, float, float] = (1, 1, 1), **fields: Any) -> Decal:
    """A decal on the floor y = 0, around the origin."""
    matrix = FACING_UP @ np.diag([*size, 1]).astype(np.float32)
    matrix[:3, 3] = fields.pop("to", (0, 0, 0))
    return Decal("decal", material, matrix, **fields)


def floor(*decals: Decal, more: tuple[Material, ...] = (RED,), **fields: Any) -> Scene:
    """A white rough floor of 4 m."""
    world = scene((mesh(quad(4.0)), IDENTITY), materials=[material(), *more], **fields)
    world.decals = list(decals)
    return world


def targets(view: Rig, *names: str) -> list[Array]:
    """G-buffer targets after the decals, row 0 on top."""
    made = []
    for name in names:
        decals = Decals(view.device, view.scene, view.gpu)
        g, block, gb = view.begin()
        decals.draw(g, block, gb)
        made.append(read(g, getattr(gb, name)))
        decals.release()
    return made


def albedo(codes: Array) -> Array:
    return (codes[..., :3] / 255.0) ** 2


def normals(codes: Array) -> Array:
    n = (np.stack([codes >> shift & 1023 for shift in (0, 10, 20)], axis=-1) - 512.0) / 511.0
    return n / np.maximum(np.linalg.norm(n, axis=-1, keepdims=True), 1e-9)


def test_a_decal_covers_its_box_and_nothing_else(rig: MakeRig) -> None:
    world = floor(placed(size=(1.0, 0.5, 1.0)))
    plain = rig(floor(), ABOVE)
    painted = rig(world, ABOVE)
    a, b, c, d = targets(painted, "a", "b", "c", "d")
    p = painted.positions()
    inside = (np.abs(p[..., 0]) < 0.48) & (np.abs(p[..., 2]) < 0.23)
    outside = (np.abs(p[..., 0]) > 0.52) | (np.abs(p[..., 2]) > 0.27)
    assert inside.sum() > 100
    np.testing.assert_array_equal(c[inside], np.tile([255, 0, 0, 255], (inside.sum(), 1)))
    power = np.log2(2 / 0.3**4 - 2) + 1
    np.testing.assert_allclose(d[inside][:, 0], power / 19 * 255, atol=1)
    np.testing.assert_allclose(b[inside][:, :3], 51, atol=1)  # a dielectric's 0.04
    for got, name in ((a, "a"), (b, "b"), (c, "c"), (d, "d")):
        before = targets(plain, name)[0]
        np.testing.assert_array_equal(got[outside], before[outside])
    before_a, before_b, before_d = targets(plain, "a", "b", "d")
    np.testing.assert_array_equal(a >> 30, before_a >> 30)  # lighting models
    np.testing.assert_array_equal(b[..., 3], before_b[..., 3])  # ambient occlusion
    np.testing.assert_array_equal(d[..., 1:], before_d[..., 1:])  # subsurface colour


def test_opacity_blends_the_codes(rig: MakeRig) -> None:
    half = material(base_color=vector(0, 0, 0, 0.5), alpha_mode="blend")
    c = targets(rig(floor(placed(opacity=0.5), more=(half,)), ABOVE), "c")[0]
    np.testing.assert_allclose(c[32, 48], [191, 191, 191, 255], atol=1)


def test_a_picture_lies_as_it_is_drawn(rig: MakeRig) -> None:
    """The image's upper left is at -x, +y of the decal."""
    pixels = np.full((2, 2, 4), 255, np.uint8)
    pixels[..., :3] = [[[255, 0, 0], [0, 255, 0]], [[0, 0, 255], [255, 255, 255]]]
    image = Texture("four", pixels, nearest=True)
    picture = material(base_color_texture=TextureSlot(0))
    view = rig(floor(placed(), more=(picture,), textures=[image]), ABOVE)
    c, p = targets(view, "c")[0], view.positions()
    for x, z, color in ((-0.25, -0.25, [1, 0, 0]), (0.25, -0.25, [0, 1, 0]),
                        (-0.25, 0.25, [0, 0, 1])):  # fmt: skip
        at_it = np.argmin(np.abs(p[..., 0] - x) + np.abs(p[..., 2] - z))
        np.testing.assert_allclose(albedo(c).reshape(-1, 3)[at_it], color, atol=0.01)


def test_a_decal_is_filtered_like_a_texture_of_the_surface(rig: MakeRig) -> None:
    """A slanted floor under a fine pattern: decal and mesh texture give the same picture."""
    rng = np.random.default_rng(2)
    pixels = np.full((256, 256, 4), 255, np.uint8)
    pixels[..., :3] = rng.integers(0, 256, size=(256, 256, 1))
    image = Texture("noise", pixels)
    picture = material(base_color_texture=TextureSlot(0))
    slanted = camera(vector(0, 0.7, 2.2), vector(0, 0, 0), fov_y=0.6)
    corners = quad(4.0)[0][quad(4.0)[1]]
    uv = (corners[:, [0, 2]] / 4.0 + 0.5).astype(np.float32)
    textured = scene((mesh(quad(4.0), uv=uv), IDENTITY), materials=[picture], textures=[image])
    by_mesh = targets(rig(textured, slanted), "c")[0][..., 0].astype(int)
    decal = placed(size=(4.0, 4.0, 1.0), fade_begin=1.4, fade_end=1.5)
    world = floor(decal, more=(picture,), textures=[image])
    by_decal = targets(rig(world, slanted), "c")[0][..., 0].astype(int)
    assert by_mesh.std() > 5
    assert np.abs(by_mesh - by_decal)[8:].mean() < 1.5


def test_a_normal_map_turns_along_the_box(rig: MakeRig) -> None:
    tilt = Texture("tilt", np.full((1, 1, 4), (128 + 90, 128, 128 + 90, 255), np.uint8))
    bump = material(normal_texture=TextureSlot(0))
    turned = placed()
    turned.world_from_decal = turned.world_from_decal[:, [1, 0, 2, 3]] * [1, -1, 1, 1]
    world = floor(turned, more=(bump,), textures=[tilt])
    got = normals(targets(rig(world, ABOVE), "a")[0])[32, 48]
    along = turned.world_from_decal[:3, 0]
    want = along / np.linalg.norm(along) + [0, 1, 0]
    np.testing.assert_allclose(got, want / np.sqrt(2), atol=0.02)


@pytest.mark.parametrize(
    ("channels", "kept"),
    [
        (("normal",), ("b", "c", "d")),
        (("roughness",), ("b", "c")),
        (("color",), ("d", "scene_color")),
        (("emission",), ("b", "c", "d")),
    ],
)
def test_only_the_named_channels_change(
    rig: MakeRig, channels: tuple[Any, ...], kept: tuple[str, ...]
) -> None:
    glow = material(base_color=vector(1, 0, 0, 1), roughness=0.3, emissive=vector(2, 1, 0))
    painted = rig(floor(placed(channels=channels), more=(glow,)), ABOVE)
    plain = rig(floor(), ABOVE)
    for name in ("scene_color", "b", "c", "d"):
        got, before = targets(painted, name)[0][32, 48], targets(plain, name)[0][32, 48]
        if name in kept:
            np.testing.assert_array_equal(got, before)
    changed = {"roughness": "d", "color": "c", "emission": "scene_color"}.get(channels[0])
    if changed:
        got, before = (targets(view, changed)[0][32, 48] for view in (painted, plain))
        assert not np.array_equal(got, before)


def test_sides_and_backs_stay_clean(rig: MakeRig) -> None:
    """On a sphere the paint ends where its normals are 80 degrees off the decal's axis."""
    world = scene((mesh(sphere(0.5, rings=48), smooth=True), IDENTITY), materials=[material(), RED])
    world.decals = [placed(size=(2, 2, 2))]
    view = rig(world, camera(vector(0, 0.3, 3), vector(0, 0, 0), fov_y=0.4))
    c, p = targets(view, "c")[0], view.positions()
    height = p[..., 1] / 0.5
    whole, none = height > np.cos(np.radians(58)), height < np.cos(np.radians(82))
    assert albedo(c)[whole][:, 1].max() == 0.0
    assert albedo(c)[none][:, 1].min() == 1.0


def test_what_refuses_decals_stays_clean_and_hides_none_behind(rig: MakeRig) -> None:
    """A refusing plate over the floor; on it a receiving one: by stencil, whichever is nearest."""
    world = scene(
        (mesh(quad(4.0)), IDENTITY),
        (mesh(box((0.6, 0.1, 0.6))), at(0, 0.1, 0)),
        (mesh(box((0.2, 0.1, 0.2))), at(0, 0.25, 0)),
        materials=[material(), RED],
    )
    world.instances[1].receives_decals = False
    world.decals = [placed(size=(1.5, 1.5, 1.5))]
    view = rig(world, ABOVE)
    c, p = targets(view, "c")[0], view.positions()
    height = p[..., 1]
    reach = np.maximum(np.abs(p[..., 0]), np.abs(p[..., 2]))
    for where, red in (
        ((height < 0.01) & (reach < 0.7), True),
        (np.abs(height - 0.15) < 0.01, False),
        (np.abs(height - 0.3) < 0.01, True),
    ):
        assert where.sum() > 20
        np.testing.assert_array_equal(c[where][:, 1], 0 if red else 255)


MASKING = """/*
help = "takes half of a decal"
*/
void material(inout Surface s, MaterialInput m, Parameters p) {
    s.decal_mask = 0.5;
    s.subsurface_color = vec3(0.25, 0.16, 0.09);
    s.albedo = vec3(0.64);
}
"""


def test_a_material_says_how_much_of_a_decal_it_takes(rig: MakeRig, tmp_path: Path) -> None:
    """The decal mask of GBufferC."""
    file = tmp_path / "masking.glsl"
    file.write_text(MASKING)
    world = floor(placed())
    world.materials[0] = Material("masking", definition=read_definition(file))
    c, d = targets(rig(world, ABOVE), "c", "d")
    np.testing.assert_allclose(c[32, 48], [229, 102, 102, 128], atol=1)
    np.testing.assert_allclose(d[32, 48][1:], [128, 102, 77], atol=1)  # the subsurface colour stays


def test_a_higher_order_covers_a_lower_one_and_later_ones_earlier(rig: MakeRig) -> None:
    green = material(base_color=vector(0, 1, 0, 1))
    blue = material(base_color=vector(0, 0, 1, 1))
    for orders, color in (((0, 0), 1), ((1, 0), 0), ((-3, 2), 1), ((2, -3), 0)):
        both = [placed(1, order=orders[0]), placed(2, order=orders[1])]
        c = targets(rig(floor(*both, more=(green, blue)), ABOVE), "c")[0][32, 48]
        np.testing.assert_array_equal(c[:3], np.roll([0, 255, 0], color))


def test_an_eye_inside_the_box_sees_it(rig: MakeRig) -> None:
    c = targets(rig(floor(placed(size=(20, 20, 20))), ABOVE), "c")[0]
    covered = c[..., 0] == 255
    assert covered.sum() > 3000
    np.testing.assert_array_equal(c[covered][:, 1], 0)


def test_a_box_beyond_the_far_plane_still_paints(rig: MakeRig) -> None:
    near_only: Camera = camera(vector(0, 3, 0.001), vector(0, 0, 0), fov_y=0.8, far=3.1)
    c = targets(rig(floor(placed(size=(1, 1, 4))), near_only), "c")[0]
    np.testing.assert_array_equal(c[32, 48], [255, 0, 0, 255])


def test_a_flat_box_that_reaches_past_the_far_plane_paints_up_to_it(rig: MakeRig) -> None:
    """A strip of road: its lower side is 5 cm below the floor, its end far behind the far plane."""
    along: Camera = camera(vector(0, 1, 2), vector(0, 0.9, 0), far=6.0)
    view = rig(floor(placed(size=(2, 100, 0.1), to=(0, 0, -49))), along)
    c, p = targets(view, "c")[0], view.positions()
    inside = (np.abs(p[..., 0]) < 0.95) & (np.abs(p[..., 2]) < 0.9) & (p[..., 1] < 0.01)
    assert inside.sum() > 200
    np.testing.assert_array_equal(c[inside], np.tile([255, 0, 0, 255], (inside.sum(), 1)))


def test_a_thousand_decals_are_a_few_draws_and_culled(rig: MakeRig) -> None:
    """A thousand in two materials and two orders are four draws; out of sight they are none."""
    rng = np.random.default_rng(8)
    spots = [
        placed(1 + n % 2, (0.05, 0.05, 0.05), order=n % 4 // 2,
               to=(*rng.uniform(-1, 1, 2), 0.0))
        for n in range(1000)
    ]  # fmt: skip
    for spot in spots:
        spot.world_from_decal[[1, 2], 3] = spot.world_from_decal[[2, 1], 3]
    world = floor(*spots, more=(RED, material(base_color=vector(0, 0, 1, 1))))
    view = rig(world, ABOVE)
    decals = Decals(view.device, world, view.gpu)
    g, block, gb = view.begin()
    before = len(g.passes)
    decals.draw(g, block, gb)
    assert len(g.passes) - before == 2  # the receivers, and one program for all
    c = read(g, gb.c)
    painted = (c[..., 1] == 0) & (c[..., 3] == 255)
    spots_px = 1000 * 0.05**2 / 16 * np.isfinite(view.positions()[..., 0]).sum()
    assert 0.3 * spots_px < painted.sum() < 3 * spots_px
    decals.release()

    away = rig(world, camera(vector(0, 3, 0.001), vector(0, 6, 0), fov_y=0.3))
    decals = Decals(away.device, world, away.gpu)
    g, block, gb = away.begin()
    before = len(g.passes)
    decals.draw(g, block, gb)
    assert len(g.passes) == before
    read(g, gb.c)
    decals.release()


def test_what_is_unlit_takes_none(rig: MakeRig) -> None:
    world = floor(placed())
    world.materials[0] = material(definition=builtin("unlit"))
    plain = floor()
    plain.materials[0] = material(definition=builtin("unlit"))
    for name in ("scene_color", "c"):
        got, before = (targets(rig(made, ABOVE), name)[0] for made in (world, plain))
        np.testing.assert_array_equal(got, before)


def test_an_artists_material_is_projected_and_may_be_replaced(rig: MakeRig) -> None:
    """The definition "lava" glows on the floor; the next frame shows what took its place."""
    lava = material(definition=builtin("lava"))
    view = rig(floor(placed(size=(2, 2, 1)), more=(lava,)), ABOVE)
    decals = Decals(view.device, view.scene, view.gpu)
    seen = {}
    for name, worn in (("lava", lava), ("red", RED)):
        if name == "red":
            view.gpu.set_material(1, worn)
        g, block, gb = view.begin()
        decals.draw(g, block, gb)
        g.keep(gb.c)
        emission = read(g, gb.scene_color)[..., :3].astype(float)
        assert gb.c.physical is not None
        seen[name] = emission, gb.c.physical.read()[::-1]
    decals.release()
    inside = np.s_[24:40, 40:56]
    emission, _ = seen["lava"]
    assert emission[inside].max() > 0.5
    assert emission[:, :8].max() == 0.0
    emission, codes = seen["red"]
    assert emission[inside].max() == 0.0
    np.testing.assert_array_equal(codes[32, 48], [255, 0, 0, 255])
