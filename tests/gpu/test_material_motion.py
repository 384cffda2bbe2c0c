"""Artist's materials that change with time, and those that displace. SH-10"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from elemental.gpu.device import Device
from elemental.scene.deform import deformed
from elemental.scene.evaluate import evaluate
from gpu.artist import ABOVE, Artist
from gpu.moving import bending_stage, pose_of
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


def test_what_moves_is_displaced_where_it_is(rig: MakeRig, artist: Artist) -> None:
    """height = 0.1 + 0.3 x in the world, for a plane that slides by 0.4 m along x and back."""
    worn = material(definition=artist.definition(WAVE)).with_value("slope", 0.3)
    world = scene((mesh(quad(1.0)), IDENTITY), materials=[worn.with_value("lift", 0.1)])
    world.instances[0].dynamic = True
    view = rig(world, ABOVE)
    for x in (0.4, 0.0):
        view.gpu.update(
            pose_of(
                instances=np.array([0]),
                world_from_local=at(x, 0, 0)[None],
                visible=np.array([True]),
            )
        )
        g = view.device.begin_frame()
        view.gpu.deform(g)
        g.execute()
        points = view.positions()
        p = points[np.isfinite(points[..., 0])]
        assert abs(p[:, 0].mean() - x) < 0.05
        np.testing.assert_allclose(p[:, 1], 0.1 + 0.3 * p[:, 0], atol=3e-3)
        low, high = view.gpu.box(0)
        np.testing.assert_allclose([low[1], high[1]], [-0.5, 0.5], atol=1e-5)


def test_what_bends_is_displaced_from_where_it_bends_to(on_device: Any, artist: Artist) -> None:
    """Each frame anew, whether the pose or the time changes: nothing adds up."""
    text = WAVE.replace("/*", "/*\nanimated = true", 1).replace("p.slope", "fract(m.time_s) *")
    text = text.replace("* * m.position_ws.x", "* 0.125")
    world = bending_stage()
    world.materials[0] = material(definition=artist.definition(text))
    gpu = on_device(world)
    number = 1
    shape = world.meshes[world.instances[number].mesh]
    for pose_s, time_s in ((0.25, 0.5), (0.25, 0.75), (0.7, 0.75)):
        pose = evaluate(world, pose_s)
        gpu.update(pose, time_s)
        g = gpu._device.begin_frame()
        gpu.deform(g)
        g.execute()
        want = deformed(shape, pose.joints.get(number), pose.weights.get(number))
        first = int(gpu.geometry.packed.placed_vertex[number])
        positions = gpu.geometry.positions.read(np.float32).reshape(-1, 3)
        got = positions[first : first + len(want.positions)]
        lift = 0.25 + time_s * 0.125
        np.testing.assert_allclose(got, want.positions + lift * want.normals, atol=2e-4)
