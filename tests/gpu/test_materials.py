"""Artist's materials on the device: one definition in every pass, edits, faults, time. SH-10"""

from __future__ import annotations

import os
import re
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from elemental.core.layout import layouts
from elemental.gpu.device import Device
from elemental.passes.decal import Decals
from elemental.scene.definitions import MaterialDefinition, builtin, read_definition
from elemental.scene.model import Decal, Texture, TextureSlot
from gpu.rig import IDENTITY, MakeRig, Rig, at, camera, material, mesh, read, scene, sun, vector
from gpu.voxel.stage import Stage
from shapes import quad, sphere

ABOVE = camera(vector(0, 3, 0), vector(0, 0, 0))
MAGENTA = np.array([1.0, 0.0, 1.0])

HALVES = """/*
[parameters]
left = { type = "color", default = [0.25, 0.0, 0.0] }
right = { type = "color", default = [0.0, 0.25, 0.0] }
*/
void material(inout Surface s, MaterialInput m, Parameters p) {
    bool is_left = m.position_ws.x < 0.0;
    s.albedo = is_left ? p.left : p.right;
    s.opacity = is_left ? 1.0 : 0.0;
}
"""

FAULT = """/*
[parameters]
a = { type = "float", default = 1 }
*/
void material(inout Surface s, MaterialInput m, Parameters p) {
    s.albedo = vec3(0.25);
    if (m.position_ws.x > 0.0) s.KEY;
}
"""


class Artist:
    """Writes a material's file, again and again."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self._saves = 0

    def save(self, text: str) -> None:
        """As an editor does: the file's time moves on."""
        self._saves += 1
        self.path.write_text(text)
        stamp = self.path.stat().st_mtime_ns + self._saves * 10_000_000
        os.utime(self.path, ns=(stamp, stamp))

    def definition(self, text: str) -> MaterialDefinition:
        self.save(text)
        return read_definition(self.path)


@pytest.fixture
def artist(tmp_path: Path, device: Device) -> Iterator[Artist]:
    """Whose last word compiles, since all tests share a device."""
    made = Artist(tmp_path / "draft.glsl")
    yield made
    made.save(HALVES + "vec3 displace(MaterialInput m, Parameters p) { return vec3(0.0); }\n")
    device.reload_changed_shaders()
    assert device.library.problems() == []


def albedo(rig: Rig) -> Any:
    """(H, W, 3) of the G-buffer."""
    g, _, gb = rig.begin()
    return (read(g, gb.c)[..., :3] / 255.0) ** 2


def emission(rig: Rig) -> Any:
    g, _, gb = rig.begin()
    return read(g, gb.scene_color)[..., :3].astype(np.float32)


def halves(rig: Rig) -> tuple[Any, Any]:
    """The pixels of the plane's left and of its right half."""
    points = rig.positions()
    return points[..., 0] < -0.05, points[..., 0] > 0.05


def draws(rig: MakeRig, artist: Artist, text: str = HALVES, **fields: Any) -> Rig:
    """A plane of a material, from above."""
    worn = material(definition=artist.definition(text), **fields)
    return rig(scene((mesh(quad(2.0)), IDENTITY), materials=[worn]), ABOVE)


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
    assert np.abs(colors[x < -0.05] - np.array([64, 0, 0])).max() <= 1
    assert np.abs(colors[x > 0.05] - np.array([0, 64, 0])).max() <= 1
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
    view.gpu.set_material(0, worn.with_texture("mask", TextureSlot(0)))
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


def test_a_saved_edit_is_drawn_and_a_broken_one_keeps_the_last(
    rig: MakeRig, artist: Artist, device: Device
) -> None:
    view = draws(rig, artist)
    left, _ = halves(view)
    artist.save(HALVES.replace("p.left :", "p.left * 2.0 :"))
    assert device.reload_changed_shaders() == []
    assert albedo(view)[left].mean(axis=0)[0] == pytest.approx(0.5, abs=4e-3)

    artist.save(HALVES.replace("p.left :", "p.lost :"))
    (error,) = device.reload_changed_shaders()
    line = HALVES.splitlines().index("    s.albedo = is_left ? p.left : p.right;") + 1
    assert f"{artist.path}:{line}: error: " in error
    assert "lost" in error
    assert albedo(view)[left].mean(axis=0)[0] == pytest.approx(0.5, abs=4e-3)
    assert device.library.problems() == [error]

    artist.save(HALVES.replace("p.left :", "p.left * 3.0 :"))
    assert device.reload_changed_shaders() == []
    assert device.library.problems() == []
    assert albedo(view)[left].mean(axis=0)[0] == pytest.approx(0.75, abs=6e-3)


def test_an_edited_heading_brings_its_parameters(
    rig: MakeRig, artist: Artist, device: Device
) -> None:
    view = draws(rig, artist)
    left, _ = halves(view)
    wider = HALVES.replace("[parameters]", '[parameters]\ngain = { type = "float", default = 3 }')
    artist.save(wider.replace("p.left :", "p.left * p.gain :"))
    assert device.reload_changed_shaders() == []
    view.gpu.update(None)
    assert len(view.gpu.changes) == 1
    assert albedo(view)[left].mean(axis=0)[0] == pytest.approx(0.75, abs=6e-3)
    worn = view.scene.materials[0]
    view.gpu.set_material(0, worn.with_value("gain", 2))
    assert albedo(view)[left].mean(axis=0)[0] == pytest.approx(0.5, abs=6e-3)

    view.gpu.update(None)
    artist.save(wider.replace("default = 3", "default = three"))
    (error,) = device.reload_changed_shaders()
    assert str(artist.path) in error
    assert "heading: is broken TOML" in error
    view.gpu.update(None)
    assert view.gpu.changes == []
    assert albedo(view)[left].mean(axis=0)[0] == pytest.approx(0.5, abs=6e-3)


def test_one_that_never_compiled_is_loud(rig: MakeRig, artist: Artist, device: Device) -> None:
    view = draws(rig, artist, HALVES.replace("p.left", "p.lost"))
    shown = emission(view)[np.isfinite(view.positions()[..., 0])]
    squares = np.unique(shown[:, 0].round(2))
    np.testing.assert_allclose(squares, [0.05, 1.0])
    np.testing.assert_allclose(shown[:, 1], 0.0)
    np.testing.assert_allclose(shown[:, 2], shown[:, 0])
    assert any("lost" in problem for problem in device.library.problems())
    artist.save(HALVES)
    assert device.reload_changed_shaders() == []
    left, _ = halves(view)
    np.testing.assert_allclose(albedo(view)[left].mean(axis=0), [0.25, 0, 0], atol=3e-3)
    assert device.library.problems() == []


@pytest.mark.parametrize(
    "fault",
    [
        "albedo = vec3(sqrt(-p.a))",
        "emissive = vec3(p.a / (p.a - 1.0))",
        "roughness = log(-p.a)",
        "normal_ts = normalize(vec3(p.a - 1.0))",
    ],
)
def test_what_is_no_number_is_shown_and_named(
    rig: MakeRig, artist: Artist, device: Device, fault: str
) -> None:
    view = draws(rig, artist, FAULT.replace("KEY", fault), emissive=vector(1, 1, 1))
    left, right = halves(view)
    shown = emission(view)
    assert shown[left].max() == 0.0
    assert set(shown[right][:, 0].round(2).tolist()) == {np.float32(0.05), np.float32(1.0)}
    assert shown[right][:, 1].max() == 0.0
    g = device.begin_frame()
    view.gpu.materials.watch_faults(g)
    g.execute()
    device.finish()
    (line,) = view.gpu.materials.faults()
    assert "draft.glsl: material 'test': writes what is no finite number" in line
    view.gpu.set_material(0, material(definition=builtin("standard")))
    g = device.begin_frame()
    view.gpu.materials.watch_faults(g)
    g.execute()
    device.finish()
    assert view.gpu.materials.faults() == []


def test_emission_stays_below_what_the_heading_promises(rig: MakeRig, artist: Artist) -> None:
    text = HALVES.replace("/*", '/*\nemits = ["left"]', 1)
    text = text.replace("s.opacity = is_left ? 1.0 : 0.0", "s.emissive = vec3(3.0, 0.1, -1.0)")
    view = draws(rig, artist, text)
    np.testing.assert_allclose(emission(view)[32, 48], [0.25, 0.1, 0.0], atol=1e-3)


TICKING = """/*
animated = true
emits = ["glow"]
[parameters]
glow = { type = "color", default = [1, 1, 1] }
*/
void material(inout Surface s, MaterialInput m, Parameters p) {
    s.albedo = vec3(0.0);
    s.specular_color = vec3(0.0);
    s.emissive = p.glow * fract(m.time_s);
}
"""


def lit_room(artist: Artist, text: str) -> Any:
    """A ticking ball over a white floor, nothing else gives light."""
    worn = material(definition=artist.definition(text))
    return scene(
        (mesh(sphere(0.3), 1, smooth=True), at(0, 0.5, 0)),
        (mesh(quad(3.0), 0), IDENTITY),
        materials=[material(), worn],
    )


def test_what_glows_with_time_lights_its_surroundings_with_time(
    renderers: Any, artist: Artist
) -> None:
    world = lit_room(artist, TICKING)
    renderer = renderers(world)
    seen = camera(vector(0, 2, 2), vector(0, 0, 0))
    means = {}
    for frame, time_s in enumerate((0.25, 0.5, 0.75, 0.25)):
        shown = renderer.render(seen, time_s, frame, "diffuse_gi")
        means[frame] = renderer.read(shown)[..., :3].mean()
    assert means[0] > 1e-3
    assert means[1] / means[0] == pytest.approx(2.0, rel=0.05)
    assert means[2] / means[0] == pytest.approx(3.0, rel=0.05)
    assert means[3] == pytest.approx(means[0], rel=1e-3)


def test_an_edit_that_glows_brighter_gets_room_in_the_voxels(
    renderers: Any, artist: Artist, device: Device
) -> None:
    renderer = renderers(lit_room(artist, TICKING))
    seen = camera(vector(0, 2, 2), vector(0, 0, 0))
    means = []
    for frame, glow in enumerate((1, 50)):
        artist.save(TICKING.replace("[1, 1, 1]", f"[{glow}, {glow}, {glow}]"))
        assert device.reload_changed_shaders() == []
        shown = renderer.render(seen, 0.5, frame, "diffuse_gi")
        means.append(renderer.read(shown)[..., :3].mean())
    assert means[1] / means[0] == pytest.approx(50.0, rel=0.03)


def test_a_watched_folder_tells_of_edits(rig: MakeRig, artist: Artist, device: Device) -> None:
    view = draws(rig, artist)
    left, _ = halves(view)
    device.watch_shaders()
    try:
        time.sleep(0.3)  # until the watch is set up
        device.reload_changed_shaders()
        artist.save(HALVES.replace("p.left :", "p.left * 2.0 :"))
        for _ in range(100):
            device.reload_changed_shaders()
            if albedo(view)[left].mean(axis=0)[0] > 0.45:
                break
            time.sleep(0.05)
        else:
            pytest.fail("the edit was never taken up")
    finally:
        device.stop_watching_shaders()


def test_a_scene_at_rest_does_no_voxel_work(renderers: Any, artist: Artist, device: Device) -> None:
    for text, times, works in (
        (TICKING, (0.5, 0.5), False),
        (TICKING.replace("animated = true", ""), (0.5, 0.75), False),
        (TICKING, (0.5, 0.75), True),
    ):
        renderer = renderers(lit_room(artist, text))
        device.reload_changed_shaders()
        for frame in (0, 1, 2):
            renderer.render(ABOVE, times[0], frame, "diffuse_gi")
        renderer.render(ABOVE, times[1], 3, "diffuse_gi")
        device.finish()
        names = {timing.name for timing in device.timings}
        assert any(name.startswith("voxelize") for name in names) == works, (text, names)


WAVE = """/*
displacement_m = 0.5
[parameters]
lift = { type = "float", default = 0.25 }
slope = { type = "float", default = 0 }
*/
vec3 displace(MaterialInput m, Parameters p) {
    return m.normal_ws * (p.lift + p.slope * m.position_ws.x);
}
void material(inout Surface s, MaterialInput m, Parameters p) { s.albedo = vec3(0.5); }
"""


def test_displaced_vertices_are_where_and_as_they_should_be(rig: MakeRig, artist: Artist) -> None:
    worn = material(definition=artist.definition(WAVE))
    scaled = IDENTITY.copy()
    scaled[:3, :3] *= 2.0
    scaled[:3, 3] = (0, 0.1, 0)
    world = scene((mesh(quad(1.0)), scaled), materials=[worn])
    view = rig(world, ABOVE)

    def points() -> Any:
        g = view.device.begin_frame()
        view.gpu.deform(g)
        g.execute()
        found = view.positions()
        return found[np.isfinite(found[..., 0])]

    np.testing.assert_allclose(points()[:, 1], 0.35, atol=2e-3)
    view.gpu.set_material(0, worn.with_value("slope", 0.3).with_value("lift", 0.1))
    view.gpu.update(None)
    assert view.gpu.changes[0].moved
    assert view.gpu.changes[0].casts
    p = points()
    np.testing.assert_allclose(p[:, 1], 0.2 + 0.3 * p[:, 0], atol=3e-3)
    g, _, gb = view.begin()
    code = int(read(g, gb.a)[32, 48])
    n = np.array([code >> shift & 1023 for shift in (0, 10, 20)]) - 512.0
    want = np.array([-0.3, 1, 0]) / 1.09**0.5
    np.testing.assert_allclose(n / np.linalg.norm(n), want, atol=4e-3)
    view.gpu.set_material(0, worn.with_value("lift", 1e3))
    view.gpu.update(None)
    np.testing.assert_allclose(points()[:, 1], 0.6, atol=3e-3)  # held at displacement_m


def test_what_becomes_displaced_gets_room_and_vertices(rig: MakeRig, artist: Artist) -> None:
    view = rig(scene((mesh(quad(1.0)), IDENTITY), (mesh(quad(1.0)), at(3, 0, 0))), ABOVE)
    before = view.gpu.geometry.positions.nbytes
    view.gpu.set_material(0, material(definition=artist.definition(WAVE)))
    view.gpu.update(None)
    assert view.gpu.geometry.positions.nbytes == 2 * before
    np.testing.assert_allclose(view.gpu.bounds[1], [4.0, 0.5, 1.0], atol=1e-6)
    low, high = view.gpu.changes[0].after or (None, None)
    np.testing.assert_allclose(low, [-1.0, -0.5, -1.0], atol=1e-6)
    np.testing.assert_allclose(high, [1.0, 0.5, 1.0], atol=1e-6)


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
