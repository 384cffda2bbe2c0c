# GI-14
"""The environment's cone pyramid: constants stay, the mean stays, cones average what they see."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from elemental.frame import Renderer
from elemental.gpu.device import Device
from elemental.passes.sky import Sky, level_half_angle, mean_radiance
from elemental.scene.image_sun import with_sun
from elemental.scene.model import Environment
from elemental.settings import Settings
from glsl.harness import run_glsl
from gpu.rig import IDENTITY, camera, mesh, scene, vector
from shapes import quad

Array = npt.NDArray[Any]
ONE = vector(1, 1, 1)


def sphere_directions(count: int) -> Array:
    """(count, 3) points of a spiral that covers the sphere evenly."""
    i = np.arange(count) + 0.5
    y = 1 - 2 * i / count
    angle = i * np.pi * (3 - np.sqrt(5))
    reach = np.sqrt(1 - y * y)
    return np.stack([reach * np.cos(angle), y, reach * np.sin(angle)], axis=-1)


def pixel_directions(height: int) -> Array:
    """(H, 2H, 3) directions of an equirectangular image's pixels, by scene.model.Environment."""
    polar = (np.arange(height) + 0.5) / height * np.pi
    azimuth = ((np.arange(2 * height) + 0.5) / (2 * height) - 0.5) * 2 * np.pi
    sine = np.sin(polar)[:, None]
    x, z = sine * np.sin(azimuth), -sine * np.cos(azimuth)
    return np.stack([x, np.broadcast_to(np.cos(polar)[:, None], x.shape), z], axis=-1)


def octahedral_grid(side: int) -> tuple[Array, Array]:
    """(directions (side^2, 3), shares of the sphere) of a fine grid of octahedral coordinates."""
    steps = (np.arange(side) + 0.5) / side * 2 - 1
    x, y = (a.ravel() for a in np.meshgrid(steps, steps))
    z = 1 - np.abs(x) - np.abs(y)
    folded = z < 0
    x, y = (
        np.where(folded, (1 - np.abs(y)) * np.copysign(1, x), x),
        np.where(folded, (1 - np.abs(x)) * np.copysign(1, y), y),
    )
    q = np.stack([x, y, z], axis=-1)
    length = np.linalg.norm(q, axis=1)
    return q / length[:, None], length**-3 / (length**-3).sum()


def make_sky(device: Device, environment: Environment | None) -> Sky:
    sky = Sky(device)
    g = device.begin_frame()
    sky.update(g, environment)
    g.execute()
    return sky


def look(sky: Sky, device: Device, directions: Array, half_angle: float) -> Array:
    """sky_radiance, (N, 3)."""
    body = f"sky_radiance(d, {half_angle})"
    inputs = {"d": directions}
    reads, params = sky.reads(), sky.params()
    return run_glsl(device, ["lib/sky.glsl"], body, inputs, "vec3", reads=reads, params=params)


ANGLES = (0.0, 0.01, 0.1, 0.4, 0.8, np.pi / 2)


@pytest.mark.parametrize("with_image", [False, True])
def test_a_constant_environment_stays_constant(device: Device, with_image: bool) -> None:
    """Also over the octahedral map's seams and corners."""
    image = np.full((64, 128, 3), (2.0, 0.5, 7.0), np.float32) if with_image else None
    tint = ONE if with_image else vector(2, 0.5, 7)
    sky = make_sky(device, Environment(image, tint, 1.0))
    for angle in ANGLES:
        got = look(sky, device, sphere_directions(5000), angle)
        np.testing.assert_allclose(got, np.tile([2.0, 0.5, 7.0], (5000, 1)), rtol=2e-6)
    sky.release()


def test_no_environment_is_black(device: Device) -> None:
    sky = make_sky(device, None)
    assert look(sky, device, sphere_directions(100), 0.5).max() == 0.0
    sky.release()


def sunny(height: int = 128) -> Array:
    """A dim gradient with a small sun, 20,000 times brighter."""
    d = pixel_directions(height)
    image = np.ones((*d.shape[:2], 3)) * (1.0 + 0.5 * d[..., 1:2])
    image[d @ (np.array([0.6, 0.48, -0.64])) > np.cos(0.03)] = (20000.0, 15000.0, 10000.0)
    return image.astype(np.float32)


def test_the_mean_over_the_sphere_is_kept_at_every_width(device: Device) -> None:
    image = sunny()
    mean = mean_radiance(image)
    sky = make_sky(device, Environment(image, ONE, 1.0))
    directions, weights = octahedral_grid(1024)
    for angle in ANGLES:
        got = weights @ look(sky, device, directions, angle).astype(np.float64)
        np.testing.assert_allclose(got, mean, rtol=5e-3)
    sky.release()


def test_narrow_lookups_return_the_image_where_it_points(device: Device) -> None:
    """Axes, seams and the sense of rotation: a smooth image comes back within its resolution."""
    d = pixel_directions(128)
    image = np.stack([1.5 + d[..., 0], 1.5 + d[..., 1], 1.5 + d[..., 2]], axis=-1)
    sky = make_sky(device, Environment(image.astype(np.float32), ONE, 1.0))
    directions = sphere_directions(4000)
    np.testing.assert_allclose(look(sky, device, directions, 0.0), 1.5 + directions, atol=0.01)
    sky.release()


@pytest.mark.parametrize("half_angle", [0.1, 0.3, 0.8, 1.5])
def test_a_cone_averages_what_it_sees(device: Device, half_angle: float) -> None:
    """A linear field's mean over a cap of half angle a about d is the value at d times
    (1 + cos a) / 2; a sharp horizon gives the covered fraction."""
    d = pixel_directions(128)
    image = np.repeat(2.0 + d[..., 1:2], 3, axis=-1)
    sky = make_sky(device, Environment(image.astype(np.float32), ONE, 1.0))
    directions = sphere_directions(3000)
    got = look(sky, device, directions, half_angle)[:, 0]
    want = 2.0 + directions[:, 1] * (1 + np.cos(half_angle)) / 2
    np.testing.assert_allclose(got, want, atol=0.05)
    sky.release()


def test_levels_double_their_cones() -> None:
    angles = [level_half_angle(level, 5) for level in range(5)]
    assert angles[0] == 0.0
    np.testing.assert_allclose(angles[1:], np.pi / 2 / np.array([8, 4, 2, 1]))


def test_the_map_is_built_only_for_a_new_image(device: Device) -> None:
    image = np.ones((64, 128, 3), np.float32)
    sky = Sky(device)
    counts, keys = [], []
    for environment in (
        Environment(image, ONE, 1.0),
        Environment(image, ONE, 2.0),
        Environment(image.copy(), ONE, 2.0),
        None,
        None,
    ):
        g = device.begin_frame()
        sky.update(g, environment)
        counts.append(len(g.passes) > 0)
        keys.append(sky.key)
        g.execute()
    assert counts == [True, False, True, False, False]
    assert len(set(keys)) == 4
    sky.release()


def test_the_eye_sees_the_sun_that_cones_do_not(device: Device) -> None:
    """Once it is a light the drawn sky is what it was to the bit; at any width no trace is left."""
    whole = make_sky(device, Environment(sunny(), ONE, 1.0))
    cut = Sky(device)
    g = device.begin_frame()
    cut.update(g, with_sun(Environment(sunny(), ONE, 1.0)), without_sun=True)
    g.execute()
    directions = np.concatenate([sphere_directions(2000), [[0.6, 0.48, -0.64]]])
    seen = look(cut.drawn(), device, directions, 0.0)
    np.testing.assert_array_equal(seen, look(whole, device, directions, 0.0))
    assert seen.max() > 5000.0
    for angle in ANGLES:
        assert look(cut, device, directions, angle).max() < 1.6
    assert whole.drawn() is whole
    for sky in (whole, cut):
        sky.release()


def test_the_sun_lights_a_floor_as_the_settings_say(device: Device) -> None:
    """From one frame to the next, and without the environment or its switch not at all."""
    environment = with_sun(Environment(sunny(), ONE, 1.0))
    assert environment.sun is not None
    floor = scene((mesh(quad(1.0)), IDENTITY), environment=environment)
    above = camera(vector(0, 3, 0.01), vector(0, 0, 0), fov_y=0.3)
    renderer = Renderer(device, floor, Settings().replace({"gi.enabled": False}, ""), (16, 16))

    def direct(**changes: Any) -> float:
        named = {key.replace("_", "."): value for key, value in changes.items()}
        renderer.set_settings(Settings().replace({"gi.enabled": False, **named}, ""))
        picture = renderer.read(renderer.render(above, 0.0, 0, "direct"))
        return float(picture[8, 8, :3].mean())

    lit = direct()
    light = environment.sun.light
    diffuse = light.strength.mean() * -light.direction[1] / np.pi
    assert lit == pytest.approx(diffuse, rel=0.05)  # and some gloss
    assert direct(sky_intensity=0.5) == pytest.approx(0.5 * lit, rel=1e-3)
    assert direct(sky_sun=False) == direct(sky_enabled=False) == 0.0
    assert direct() == lit
    renderer.release()
