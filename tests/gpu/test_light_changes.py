"""Lights that are edited while the scene runs, profiles and masks in a frame. SH-09"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from elemental.core.errors import InputError
from elemental.frame import Renderer
from elemental.scene.blackbody import blackbody_color
from elemental.scene.ies import LightProfile
from elemental.scene.lights import LightMask
from elemental.scene.model import Light, Scene
from elemental.scene.volumes import Volume
from gpu.rig import IDENTITY, at, camera, mesh, scene, vector
from shapes import box, quad

Array = npt.NDArray[Any]
EYE = camera(vector(0, 3, 6), vector(0, 0.5, 0))


def court() -> Scene:
    lamp = Light("lamp", "point", vector(1, 1, 1), 6.0, vector(0.5, 2, 0.5), vector(0, -1, 0))
    return scene(
        (mesh(quad(6.0)), IDENTITY), (mesh(box((0.5, 1, 0.5))), at(-0.5, 0.5, 0)), lights=[lamp]
    )


def picture(renderer: Renderer, view: str = "scene_color") -> tuple[Array, list[str]]:
    """The picture, and the passes that made it."""
    frame = renderer.render(EYE, 0.0, 0, view)
    renderer.device.finish()
    return renderer.read(frame)[..., :3], [timing.name for timing in renderer.device.timings]


POLES, SIDES = np.radians([0.0, 180.0]), np.radians([0.0, 89.0, 91.0, 180.0])
HALF = LightProfile("half", POLES, SIDES, np.array([[9.0] * 2, [9.0] * 2, [0.0] * 2, [0.0] * 2]))
"""Light to one side only."""

STRIPES = LightMask("stripes", np.tile(np.array([[[1.0]], [[0.25]]], np.float32), (32, 64, 3)))
"""Fine ones, along the mask's width; their mean is 0.625."""

HALVES = LightMask("halves", np.repeat(np.array([[[1.0]], [[0.25]]], np.float32), 3, axis=2))

CHANGES: dict[str, dict[str, Any]] = {
    "temperature": {"temperature": 2400.0},
    "brighter": {"intensity": 9.0},
    "moved": {"position": vector(-1, 1.5, 1)},
    "larger": {"source_radius": 0.3},
    "kind": {"kind": "spot", "outer_angle": 0.6},
    "profile": {"profile": HALF},
    "mask": {"kind": "spot", "outer_angle": 0.6, "mask": STRIPES},
}


def test_lights_end_by_the_exposure_of_now(renderers: Any) -> None:
    """Not by that of the first frame; no map is drawn anew for it."""
    lamps = [
        Light(f"lamp {n}", "point", vector(1, 1, 1), 1.0, vector(n - 3, 2, 0), vector(0, -1, 0))
        for n in range(6)
    ]
    world = court()
    world.lights = lamps
    turned = renderers(world, exposure=4.0)
    bright, _ = picture(turned)
    turned.set_settings(turned.settings.replace({"exposure": -7.5}))
    got, passes = picture(turned)
    assert not any(name.startswith("shadow.") for name in passes)
    want, _ = picture(renderers(world, exposure=-7.5))
    np.testing.assert_array_equal(got, want)
    assert np.abs(got - bright).max() > 0.05  # they end sooner
    turned.set_settings(turned.settings.replace({"exposure": -7.9}))
    _, passes = picture(turned)
    assert "light voxels" not in passes


def test_lights_end_by_the_brightest_exposure_of_any_volume(renderers: Any) -> None:
    """Wherever the eye is, so that a walk into it lights no voxels anew."""
    world = court()
    world.lights = [replace(world.lights[0], name=f"lamp {n}") for n in range(6)]
    far = Volume("cellar", center=(1e3, 0, 0), overrides={"exposure": 5.0})
    made = renderers(world, exposure=-7.5)
    dark, _ = picture(made)
    want, _ = picture(renderers(world, exposure=5.0))
    for volume, seen in ((far, want), (replace(far, enabled=False), dark)):
        world.volumes = [volume]
        np.testing.assert_array_equal(picture(made)[0], seen)
    assert np.abs(want - dark).max() > 0.05


@pytest.mark.parametrize("change", CHANGES)
def test_an_edited_light_lights_the_next_frame(renderers: Any, change: str) -> None:
    """As in a scene that began with it; nothing is voxelized anew."""
    edited = renderers(court(), **{"gi.bounces": 2})
    before, first = picture(edited)
    assert any(name.startswith("voxelize") for name in first)
    _, still = picture(edited)
    assert "light voxels" not in still
    light = replace(edited.scene.lights[0], **CHANGES[change])
    edited.set_lights([light])
    got, passes = picture(edited)
    assert "light voxels" in passes
    assert not any(name.startswith("voxelize") for name in passes)
    fresh = court()
    fresh.lights = [light]
    want, _ = picture(renderers(fresh, **{"gi.bounces": 2}))
    np.testing.assert_array_equal(got, want)
    if change != "larger":  # which only highlights show
        assert np.abs(got - before).max() > 0.05


def test_floor_and_voxels_under_a_mask_get_its_mean(renderers: Any) -> None:
    """A sun through stripes of a quarter and all of the light, finer than pixels and voxels."""
    light = Light("sun", "directional", vector(1, 1, 1), 2.0, vector(0, 0, 0), vector(0, -1, 0))
    world = scene((mesh(quad(6.0)), IDENTITY), (mesh(box((0.1, 2, 3))), at(-2.0, 1, 0)))
    bare, masked = (replace(light, mask=mask, mask_size=0.8) for mask in (None, STRIPES))
    for view, spread in (("direct", 0.05), ("diffuse_gi", 0.02)):
        seen = []
        for lamp in (bare, masked):
            world.lights = [lamp]
            seen.append(picture(renderers(world, **{"gi.bounces": 1}), view)[0][..., 0])
        lit = seen[0] > 0.02 * seen[0].max()
        share = seen[1][lit] / seen[0][lit]
        assert np.mean(seen[1][lit]) == pytest.approx(0.625 * np.mean(seen[0][lit]), rel=0.03)
        assert np.std(share) < spread


def test_a_mask_that_scrolls_is_elsewhere_and_lights_voxels_anew(renderers: Any) -> None:
    """After a whole mask all is as before; with time standing still nothing is done."""
    world = court()
    world.lights = [
        replace(world.lights[0], kind="spot", outer_angle=0.6, mask=HALVES, mask_scroll=(0.0, 0.25))
    ]
    made = renderers(world, **{"gi.bounces": 1})
    seen = []
    for frame, time_s in enumerate((0.0, 2.0, 2.0, 4.0)):
        shown = made.render(EYE, time_s, frame, "scene_color")
        made.device.finish()
        passes = [timing.name for timing in made.device.timings]
        assert ("light voxels" in passes) is (frame != 2)
        assert any(name.startswith("shadow.") for name in passes) is (frame == 0)  # maps stay
        seen.append(made.read(shown)[..., :3])
    assert np.abs(seen[1] - seen[0]).max() > 0.05
    np.testing.assert_array_equal(seen[2], seen[1])
    np.testing.assert_array_equal(seen[3], seen[0])


def test_what_no_light_is_is_refused_and_the_old_ones_stay(renderers: Any) -> None:
    made = renderers(court())
    lamp = made.scene.lights[0]
    with pytest.raises(InputError, match="light 'lamp': intensity: is negative"):
        made.set_lights([replace(lamp, intensity=-1.0)])
    assert made.scene.lights == [lamp]
    made.set_lights([])
    assert picture(made, "direct")[0].max() == 0.0


def test_a_warm_lamp_lights_floor_and_voxels_in_its_colour(renderers: Any) -> None:
    """A grey room keeps the ratios of the light's primaries, in direct and in indirect light."""
    world = court()
    world.lights = [replace(world.lights[0], temperature=2200.0)]
    made = renderers(world)
    want = blackbody_color(2200.0)
    for view in ("direct", "diffuse_gi"):
        color = picture(made, view)[0].reshape(-1, 3).mean(axis=0)
        np.testing.assert_allclose(color / color[0], want / want[0], atol=0.02)


def test_voxels_see_the_profile(renderers: Any) -> None:
    """A lamp that shines to one side only leaves the voxels of the other dark."""
    world = court()
    lamp = replace(world.lights[0], position=vector(0, 2, 0), profile=HALF)
    sides = []
    for roll in (0.0, np.pi):
        world.lights = [replace(lamp, roll=roll)]
        image = picture(renderers(world), "voxels")[0].sum(axis=-1)
        half = image.shape[1] // 2
        sides.append(image[:, half:].sum() / image[:, :half].sum())
    assert sides[0] > 2.0
    assert sides[1] < 0.5
