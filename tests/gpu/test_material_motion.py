"""Artist's materials that change with time, and those that displace. SH-10"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from elemental.gpu.device import Device
from gpu.artist import ABOVE, Artist
from gpu.rig import IDENTITY, MakeRig, at, camera, material, mesh, read, scene, vector
from shapes import quad, sphere

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
