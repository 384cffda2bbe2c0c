"""Artist's materials on the device: one definition in every pass, by its values. SH-10"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from elemental.core.layout import layouts
from elemental.gpu.device import Device
from elemental.passes.decal import Decals
from elemental.scene.model import Decal, Texture
from formulas import MIRRORED_BY_ROUGH_DIELECTRIC
from gpu.artist import ABOVE, HALVES, Artist, albedo, draws, emission, halves
from gpu.rig import IDENTITY, MakeRig, at, camera, material, mesh, read, scene, sun, vector
from gpu.voxel.stage import Stage
from shapes import quad


def test_the_g_buffer_shows_it(rig: MakeRig, artist: Artist) -> None:
    view = draws(rig, artist)
    left, right = halves(view)
    got = albedo(view)
    np.testing.assert_allclose(got[left].mean(axis=0), [0.25, 0, 0], atol=3e-3)
    np.testing.assert_allclose(got[right].mean(axis=0), [0, 0.25, 0], atol=3e-3)


def test_its_shadow_is_cut_out_by_it(rig: MakeRig, artist: Artist) -> None:
    """The right half of the pane over the floor is cut away; so is its half of the shadow."""
    worn = material(definition=artist.definition(HALVES), alpha_mode="mask", double_sided=True)
    world = scene(
        (mesh(quad(1.0), 1), at(0, 1, 0)),
        (mesh(quad(3.0), 0), IDENTITY),
        materials=[material(), worn],
        lights=[sun(vector(0, -1, 0))],
    )
    view = rig(world, camera(vector(2.5, 0.6, 0), vector(0, 0, 0)))
    points, lit = view.positions(), view.visibility()
    floor = (np.abs(points[..., 1]) < 0.01) & (np.abs(points[..., 2]) < 0.4)
    x = points[..., 0]
    assert lit[floor & (x < -0.1) & (x > -0.4)].max() < 0.05
    assert lit[floor & (x > 0.1) & (x < 0.4)].min() > 0.95


def test_voxels_are_made_of_it(device: Device, artist: Artist) -> None:
    worn = material(definition=artist.definition(HALVES))
    stage = Stage(device, scene((mesh(quad(2.0)), IDENTITY), materials=[worn]), 32, bounces=0)
    colors = stage.fragments["albedo"].copy().view(np.uint8).reshape(-1, 4)[:, :3]
    x = (stage.fragments["position"] & 1023) / 32.0 - 0.5
    assert len(x) > 500
    mirrored = 255.0 * MIRRORED_BY_ROUGH_DIELECTRIC
    assert np.abs(colors[x < -0.05] - np.array([64, 0, 0]) - mirrored).max() <= 1
    assert np.abs(colors[x > 0.05] - np.array([0, 64, 0]) - mirrored).max() <= 1
    stage.release()


def test_the_forward_pass_blends_it(rig: MakeRig, artist: Artist) -> None:
    text = HALVES.replace("s.opacity = is_left ? 1.0 : 0.0", "s.opacity = is_left ? 0.5 : 0.25")
    text = text.replace("s.albedo =", "s.emissive = ").replace("/*", '/*\nemits = ["right"]')
    worn = material(definition=artist.definition(text), alpha_mode="blend")
    view = rig(scene((mesh(quad(2.0)), IDENTITY), materials=[worn]), ABOVE)
    points = rig(scene((mesh(quad(2.0)), IDENTITY)), ABOVE).positions()
    got = view.scene_color()[..., :3]
    np.testing.assert_allclose(got[points[..., 0] < -0.05].mean(axis=0)[0], 0.125, atol=2e-2)
    np.testing.assert_allclose(got[points[..., 0] > 0.05].mean(axis=0)[1], 0.0625, atol=2e-2)


def test_a_decal_wears_it(rig: MakeRig, artist: Artist) -> None:
    """A box of 1 m that projects downwards onto a white floor."""
    worn = material(definition=artist.definition(HALVES.replace("? 1.0 : 0.0", "? 1.0 : 0.5")))
    world = scene((mesh(quad(4.0)), IDENTITY), materials=[material(), worn])
    downwards = np.array([[1, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]], np.float32)
    world.decals = [Decal("decal", 1, downwards)]
    view = rig(world, ABOVE)
    points = view.positions()
    inside = np.abs(points[..., 2]) < 0.45
    left = inside & (points[..., 0] > -0.45) & (points[..., 0] < -0.05)
    right = inside & (points[..., 0] < 0.45) & (points[..., 0] > 0.05)
    decals = Decals(view.device, world, view.gpu)
    g, block, gb = view.begin()
    decals.draw(g, block, gb)
    codes = read(g, gb.c)[..., :3]
    decals.release()
    np.testing.assert_allclose(codes[left].mean(axis=0), [128, 0, 0], atol=1)
    assert codes[right].mean(axis=0)[1] > codes[right].mean(axis=0)[0] + 30


def test_values_and_textures_reach_it(rig: MakeRig, artist: Artist) -> None:
    text = """/*
[parameters]
amount = { type = "float", default = 0.5 }
shown = { type = "bool", default = false }
steps = { type = "int", default = 1 }
tint = { type = "rgba", default = [0, 0, 0, 1] }
mask = { type = "texture", default = "black", srgb = false }
*/
void material(inout Surface s, MaterialInput m, Parameters p) {
    vec4 mask = texture(u_mask, m.uv0);
    s.albedo = vec3(p.amount * mask.r, p.shown ? p.tint.g * p.tint.a : 0.0, float(p.steps) / 16.0);
}
"""
    image = Texture("m", np.full((2, 2, 4), (128, 0, 0, 255), np.uint8))
    worn = material(definition=artist.definition(text))
    world = scene((mesh(quad(2.0)), IDENTITY), materials=[worn], textures=[image])
    view = rig(world, ABOVE)
    assert albedo(view)[32, 48] == pytest.approx([0, 0, 1 / 16], abs=3e-3)
    worn = (
        worn.with_value("shown", True).with_value("tint", [1, 0.5, 0, 0.5]).with_value("steps", 4)
    )
    view.gpu.set_material(0, worn.with_image("mask", 0))
    view.gpu.update(None)
    assert albedo(view)[32, 48] == pytest.approx([0.5 * 128 / 255, 0.25, 0.25], abs=4e-3)


def test_the_normal_follows_a_height(rig: MakeRig, artist: Artist) -> None:
    """height = x / 2 over a plane: the normal (-1/2, 1, 0) / |.|."""
    text = HALVES.replace("s.opacity = is_left ? 1.0 : 0.0", "s.height_gradient = vec3(0.5, 9, 0)")
    view = draws(rig, artist, text)
    g, _, gb = view.begin()
    code = int(read(g, gb.a)[32, 48])
    n = np.array([code >> shift & 1023 for shift in (0, 10, 20)]) - 512.0
    np.testing.assert_allclose(n / np.linalg.norm(n), np.array([-0.5, 1, 0]) / 1.25**0.5, atol=4e-3)


def test_emission_stays_below_what_the_heading_promises(rig: MakeRig, artist: Artist) -> None:
    text = HALVES.replace("/*", '/*\nemits = ["left"]', 1)
    text = text.replace("s.opacity = is_left ? 1.0 : 0.0", "s.emissive = vec3(3.0, 0.1, -1.0)")
    view = draws(rig, artist, text)
    np.testing.assert_allclose(emission(view)[32, 48], [0.25, 0.1, 0.0], atol=1e-3)


def test_layouts_agree_about_how_many_parameters_there_are() -> None:
    material_struct = layouts().struct("Material")
    assert material_struct["parameters"].shape == (layouts().constant("MATERIAL_VECTORS"), 4)


def test_the_page_s_example_is_a_material(rig: MakeRig, artist: Artist, device: Device) -> None:
    page = Path(__file__).resolve().parents[2] / "docs" / "materials.md"
    example, displacement = re.findall(r"```glsl\n(.*?)```", page.read_text("utf-8"), re.DOTALL)
    waves = example.replace("/*\n", "/*\ndisplacement_m = 0.1\n", 1) + displacement
    for text in (example, waves):
        view = draws(rig, artist, text)
        view.gpu.update(None)
        assert view.gpu.materials.faults() == []
        g = device.begin_frame()
        view.gpu.deform(g)
        g.execute()
        assert np.isfinite(albedo(view)).all()
        assert device.library.problems() == []
