"""Lighting models in frames: chosen by the G-buffer, lit from behind, in a furnace. SH-05"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from elemental.frame import Renderer
from elemental.gpu.device import Device
from elemental.scene.definitions import builtin
from elemental.scene.model import Environment, Material, Scene
from elemental.settings import Settings
from gpu.rig import IDENTITY, MakeRig, at, camera, material, mesh, read, scene, sun, vector
from shapes import box, quad, sphere

Array = npt.NDArray[Any]
ABOVE = camera(vector(0.1, 3, 0.2), vector(0, 0, 0))
MODELS = {"unlit": 0, "standard": 1, "subsurface": 2, "cloth": 3}
THROUGH = 0.5


def of(name: str, **fields: Any) -> Material:
    return material(definition=builtin(name), **fields)


def leaf() -> Material:
    """Black but for the light that shines through."""
    black = of("subsurface", base_color=vector(0, 0, 0, 1), double_sided=True)
    return black.with_value("subsurface", [THROUGH] * 3)


@pytest.mark.parametrize(("name", "code"), MODELS.items())
def test_a_material_chooses_its_lighting_model(rig: MakeRig, name: str, code: int) -> None:
    """The two bits of GBufferA's alpha, and the subsurface colour in D."""
    view = rig(scene((mesh(quad(2.0)), IDENTITY), materials=[of(name)]), ABOVE)
    g, _, gb = view.begin()
    assert int(read(g, gb.a)[32, 48]) >> 30 == code
    g, _, gb = view.begin()
    through = (read(g, gb.d)[32, 48][1:] / 255.0) ** 2
    want = [0.55, 0.16, 0.08] if name == "subsurface" else [0, 0, 0]
    np.testing.assert_allclose(through, want, atol=4e-3)


def shone_through(view_points: Array, to_light: Array) -> Array:
    """Radiance of the leaf under irradiance pi: glsl/lib/lighting_models.glsl in float64, without
    the mirrored part, which light from behind has not."""
    to_eye = ABOVE.world_from_view[:3, 3].astype(np.float64) - view_points
    to_eye /= np.linalg.norm(to_eye, axis=-1, keepdims=True)
    wrapped = np.clip((0.5 - to_light[1]) / 1.5**2, 0, 1)
    forward = 6.5 * np.clip(-to_eye @ to_light, 0, 1) ** 12
    return np.asarray(THROUGH * (0.65 * wrapped + 0.35 * forward))


@pytest.mark.parametrize("shadowed", [False, True])
def test_a_leaf_shines_when_lit_from_behind(rig: MakeRig, shadowed: bool) -> None:
    """[Mittring12 "SSS Material Example"]: unshadowed, and shadowed by a bar behind half of it."""
    upwards = vector(0.2, 1, 0.1)
    to_light = (-upwards / np.linalg.norm(upwards)).astype(np.float64)
    world = scene(
        (mesh(quad(2.0), 0), IDENTITY),
        (mesh(box((4.0, 0.2, 4.0)), 1), at(2.3, -1.0, 0)),
        materials=[leaf(), of("standard", base_color=vector(0, 0, 0, 1))],
        lights=[sun(upwards, casts_shadow=shadowed)],
    )
    view = rig(world, ABOVE)
    radiance, points = view.scene_color()[..., 0], view.positions()
    on_leaf = np.isfinite(points[..., 0]) & (np.abs(points[..., 1]) < 0.01)
    p = points[on_leaf]
    want, got = shone_through(p, to_light), radiance[on_leaf]
    # The bar's edge at x = 0.3 shades the leaf beyond x = 0.3 + 0.2 +- 0.02.
    clear, behind = p[:, 0] < 0.3, p[:, 0] > 0.7
    assert min(clear.sum(), behind.sum()) > 200
    np.testing.assert_allclose(got[clear], want[clear], rtol=0.02, atol=2e-3)
    if shadowed:
        assert got[behind].max() < 0.01
    else:
        np.testing.assert_allclose(got[behind], want[behind], rtol=0.02, atol=2e-3)


def test_thick_bodies_let_less_light_through(rig: MakeRig) -> None:
    """A slab's upper side with the sun below; light is looked for 3 cm deep at most."""
    seen = {}
    for thickness in (0.003, 0.02, 0.2):
        slab = mesh(box((2.0, thickness, 2.0)))
        world = scene(
            (slab, at(0, -thickness / 2, 0)), materials=[leaf()], lights=[sun(vector(0, 1, 0))]
        )
        view = rig(world, ABOVE, size=(48, 32))
        seen[thickness] = float(np.median(view.scene_color()[12:20, 18:30, 0]))
    assert seen[0.003] > 0.25
    assert 0.2 * seen[0.003] < seen[0.02] < 0.8 * seen[0.003]
    assert seen[0.2] < 0.01


def test_light_wraps_around_what_it_shines_through(rig: MakeRig) -> None:
    """Past the terminator a ball of wax is lit, one of stone is not."""
    far = camera(vector(0, 0, 3), vector(0, 0, 0))
    lit = {}
    for name in ("standard", "subsurface"):
        world = scene(
            (mesh(sphere(0.5), smooth=True), IDENTITY),
            materials=[of(name)],
            lights=[sun(vector(0, -1, 0), casts_shadow=False)],
        )
        view = rig(world, far)
        y = view.positions()[..., 1]
        lit[name] = view.scene_color()[..., 0][(y < -0.05) & (y > -0.15)]
    assert lit["standard"].max() == 0.0
    assert lit["subsurface"].min() > 0.05


def furnace(device: Device, world: Scene) -> tuple[Array, Array]:
    """Radiance of the ball under an even white sky, and which pixels it fills."""
    settings = Settings().replace({"gi.resolution": 64, "fxaa.enabled": False})
    renderer = Renderer(device, world, settings, (96, 64))
    shown = renderer.render(camera(vector(0, 0, 3), vector(0, 0, 0)), 0.0, 0, "scene_color")
    picture = renderer.read(shown)
    renderer.release()
    return picture[..., :3], picture[..., 3] > 0.5


@pytest.mark.parametrize(
    ("name", "roughness"), [("standard", 0.1), ("standard", 1.0), ("subsurface", 0.6), ("cloth", 1)]
)
def test_a_ball_in_a_white_furnace_is_white_at_most(
    device: Device, name: str, roughness: float
) -> None:
    white = of(name, roughness=roughness)
    if name == "subsurface":
        white = white.with_value("subsurface", [0.5, 0.5, 0.5])
    world = scene(
        (mesh(sphere(0.7, rings=48), smooth=True), IDENTITY),
        materials=[white],
        environment=Environment(None, vector(1, 1, 1), 1.0),
    )
    radiance, hit = furnace(device, world)
    assert hit.sum() > 500
    assert np.percentile(radiance[hit], 99) <= 1.02
    # Of what a solid ball would let through from behind, nothing arrives.
    assert radiance[hit].mean() > {"cloth": 0.8, "subsurface": 0.7}.get(name, 0.9)


def test_indirect_light_shines_through(device: Device) -> None:
    """A black leaf over a wide glowing floor: half of its subsurface colour is lit by the floor."""
    glow = of("standard", base_color=vector(0, 0, 0, 1), emissive=vector(1, 1, 1))
    world = scene(
        (mesh(quad(1.0), 0), at(0, 0.6, 0)),
        (mesh(quad(8.0), 1), IDENTITY),
        materials=[leaf(), glow],
    )
    seen = {}
    for through in (THROUGH, 0.0):
        world.materials[0] = leaf().with_value("subsurface", [through] * 3)
        settings = Settings().replace({"gi.resolution": 128, "gi.area_lights": False})
        renderer = Renderer(device, world, settings, (48, 32))
        shown = renderer.render(ABOVE, 0.0, 0, "scene_color")
        seen[through] = float(np.median(renderer.read(shown)[13:19, 20:28, 0]))
        renderer.release()
    assert seen[0.0] < 0.02
    assert seen[THROUGH] == pytest.approx(0.5 * THROUGH, rel=0.15)


def test_what_no_material_asks_for_costs_nothing(renderers: Any, device: Device) -> None:
    """Neither the pass for light from behind nor the code of the models is there."""
    for name, models in (("standard", set()), ("subsurface", {"subsurface"}), ("cloth", {"cloth"})):
        world = scene((mesh(sphere(0.5), smooth=True), IDENTITY), materials=[of(name)])
        renderer = renderers(world)
        assert renderer._meshes.materials.lighting_models == models
        renderer.render(ABOVE, 0.0, 0, "scene_color")
        device.finish()
        names = {timing.name for timing in device.timings}
        assert ("cones.through" in names) == (name == "subsurface")
