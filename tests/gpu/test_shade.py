"""Direct light in rendered frames against closed forms."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from elemental.scene.model import Camera, Environment, Light
from formulas import environment_brdf
from gpu.rig import IDENTITY, UNLIT, MakeRig, at, camera, material, mesh, scene, sun, vector
from shapes import quad, sphere

Array = npt.NDArray[Any]
ABOVE = camera(vector(0.1, 4, 0.2), vector(0, 0, 0), fov_y=0.5)


def expected(
    p: Array, n: Array, to_light: Array, irradiance: float | Array, view: Camera = ABOVE
) -> Array:
    """Radiance of a white dielectric of roughness 1 in float64: Lambert, as far as the mirrored
    share leaves it, plus the slides' Gaussian specular at the smallest power, with Schlick's
    Fresnel and its energy balanced."""
    f0, power = 0.04, 0.5
    eye = view.world_from_view[:3, 3].astype(np.float64)
    v = eye - p
    v /= np.linalg.norm(v, axis=-1, keepdims=True)
    h = v + to_light
    h /= np.linalg.norm(h, axis=-1, keepdims=True)
    lambert = np.clip(np.sum(n * to_light, axis=-1), 0, 1)
    angle = np.arccos(np.power(0.04, 1.0 / power))
    norm_angle = (np.clip(np.sum(n * h, axis=-1), 0, 1) - 1) / (np.cos(angle) - 1)
    fresnel = f0 + (1 - f0) * (1 - np.sum(v * h, axis=-1)) ** 5
    specular = fresnel * np.exp(-(norm_angle**2)) * lambert / (angle**2 * 2 * np.pi**1.5)
    mirrored = environment_brdf(
        f0, (2 / (power + 2)) ** 0.25, np.clip(np.sum(n * v, axis=-1), 0, 1)
    )
    albedo = np.minimum(1.0, 1.0 - mirrored)
    return irradiance * (albedo / np.pi * lambert + specular)


def test_a_lambertian_plane_under_the_sun(rig: MakeRig) -> None:
    """radiance = albedo / pi * illuminance * cos, and the specular part."""
    for tilt in (0.0, 0.6, 1.2):
        direction = vector(np.sin(tilt), -np.cos(tilt), 0)
        world = scene((mesh(quad(2.0)), IDENTITY), lights=[sun(direction, casts_shadow=False)])
        view = rig(world, ABOVE)
        radiance, points = view.scene_color()[..., 0], view.positions()
        hit = np.isfinite(points[..., 0])
        want = expected(points[hit], vector(0, 1, 0), -direction, np.pi)
        assert hit.sum() > 2000
        np.testing.assert_allclose(radiance[hit], want, rtol=6e-3)


def test_a_lambertian_sphere_under_the_sun(rig: MakeRig) -> None:
    direction = vector(0.3, -1, -0.4)
    to_light = -direction / np.linalg.norm(direction)
    ball = mesh(sphere(rings=64), smooth=True)
    world = scene((ball, IDENTITY), lights=[sun(direction, casts_shadow=False)])
    view = rig(world, ABOVE)
    radiance, points = view.scene_color()[..., 0], view.positions()
    hit = np.isfinite(points[..., 0])
    p = points[hit]
    n = p / np.linalg.norm(p, axis=1, keepdims=True)
    want = expected(p, n, to_light, np.pi)
    assert np.abs(radiance[hit] - want).max() < 0.02
    assert np.abs(radiance[hit] - want).mean() < 0.003


def test_a_point_light_obeys_the_inverse_square(rig: MakeRig) -> None:
    position = vector(0.3, 0.7, -0.2)
    lamp = Light(
        "lamp", "point", vector(1, 1, 1), 2.0, position, vector(0, -1, 0), casts_shadow=False
    )
    view = rig(scene((mesh(quad(2.0)), IDENTITY), lights=[lamp]), ABOVE)
    radiance, points = view.scene_color()[..., 0], view.positions()
    hit = np.isfinite(points[..., 0])
    offset = position - points[hit]
    distance = np.linalg.norm(offset, axis=1)
    to_light = offset / distance[:, None]
    want = expected(points[hit], vector(0, 1, 0), to_light, 2.0 / distance**2)
    np.testing.assert_allclose(radiance[hit], want, rtol=8e-3)


def test_a_spot_lights_a_disc_between_its_angles(rig: MakeRig) -> None:
    lamp = Light("lamp", "spot", vector(1, 1, 1), 5.0, vector(0, 2, 0), vector(0, -1, 0),
                 inner_angle=0.15, outer_angle=0.3, casts_shadow=False)  # fmt: skip
    view = rig(scene((mesh(quad(2.0)), IDENTITY), lights=[lamp]), ABOVE)
    radiance, points = view.scene_color()[..., 0], view.positions()
    angle = np.arctan2(np.linalg.norm(points[..., [0, 2]], axis=-1), 2.0)
    lit_fully, dark = angle < 0.15, angle > 0.3
    assert lit_fully.sum() > 50
    assert radiance[lit_fully].min() > 0.3
    assert radiance[dark].max() == 0.0
    ring = (angle > 0.16) & (angle < 0.29)
    falloff = (np.cos(angle[ring]) - np.cos(0.3)) / (np.cos(0.15) - np.cos(0.3))
    reference = 5.0 / np.pi * np.cos(angle[ring]) ** 3 / 4.0 * falloff**2
    assert np.all(radiance[ring] > 0.95 * reference)
    assert np.all(radiance[ring] < 1.25 * reference)


def test_emission_is_added_and_unlit_is_left_alone(rig: MakeRig) -> None:
    light = sun(vector(0, -1, 0), casts_shadow=False)
    glow, flat = vector(2, 1, 0.5), vector(0.5, 0.25, 0.125, 1)
    materials = [
        material(emissive=glow, base_color=vector(0, 0, 0, 1), metallic=1.0),
        material(base_color=flat, definition=UNLIT),
    ]
    world = scene(
        (mesh(quad(0.8), 0), at(-0.5, 0, 0)),
        (mesh(quad(0.8), 1), at(0.5, 0, 0)),
        materials=materials,
        lights=[light],
    )
    view = rig(world, ABOVE)
    radiance, points = view.scene_color(), view.positions()
    left, right = points[..., 0] < -0.2, points[..., 0] > 0.2
    np.testing.assert_allclose(radiance[left][:, :3], np.tile(glow, (left.sum(), 1)), rtol=0.02)
    np.testing.assert_allclose(
        radiance[right][:, :3], np.tile(flat[:3], (right.sum(), 1)), rtol=1e-3
    )


def test_the_sky_is_behind_everything(rig: MakeRig) -> None:
    sky = Environment(None, vector(0.5, 1, 2), 3.0)
    view = rig(scene((mesh(quad(0.5)), IDENTITY), environment=sky), ABOVE)
    radiance, points = view.scene_color(), view.positions()
    behind = ~np.isfinite(points[..., 0])
    np.testing.assert_array_equal(radiance[behind][:, 3], 0.0)
    want = np.tile([1.5, 3.0, 6.0], (behind.sum(), 1))
    np.testing.assert_allclose(radiance[behind][:, :3], want, rtol=1e-3)
    assert radiance[~behind][:, :3].max() == 0.0


def test_the_sky_is_seen_where_it_is(rig: MakeRig) -> None:
    """Each pixel behind the scene shows the image in the direction of its own ray."""
    polar, azimuth = np.mgrid[0:64, 0:128]
    polar, azimuth = (polar + 0.5) / 64 * np.pi, ((azimuth + 0.5) / 128 - 0.5) * 2 * np.pi
    sine = np.sin(polar)
    d = np.stack([sine * np.sin(azimuth), np.cos(polar), -sine * np.cos(azimuth)], axis=-1)
    sky = Environment((1.5 + d).astype(np.float32), vector(1, 1, 1), 1.0)
    aside = camera(vector(1, 2, 3), vector(2, 2.5, 1), fov_y=1.0)
    view = rig(scene((mesh(quad(0.5)), IDENTITY), environment=sky), aside)
    got = view.scene_color()[..., :3]
    x, y = np.meshgrid((np.arange(96) + 0.5) / 48 - 1, 1 - (np.arange(64) + 0.5) / 32)
    tangent = np.tan(0.5)
    ray = np.stack([x * tangent * 1.5, y * tangent, -np.ones_like(x)], axis=-1)
    ray = ray @ aside.world_from_view[:3, :3].T
    ray /= np.linalg.norm(ray, axis=-1, keepdims=True)
    np.testing.assert_allclose(got, 1.5 + ray, atol=0.02)


def test_translucent_surfaces_blend_over_in_order(rig: MakeRig) -> None:
    """Two unlit panes of opacity 1/2, given near first: far, then near, over the sky."""
    panes = [
        material(base_color=vector(1, 0, 0, 0.5), alpha_mode="blend", definition=UNLIT),
        material(base_color=vector(0, 1, 0, 0.5), alpha_mode="blend", definition=UNLIT),
    ]
    world = scene(
        (mesh(quad(2.0), 0), at(0, 1, 0)),
        (mesh(quad(2.0), 1), IDENTITY),
        materials=panes,
        environment=Environment(None, vector(0, 0, 1), 1.0),
    )
    got = rig(world, ABOVE).scene_color()[32, 48, :3]
    np.testing.assert_allclose(got, [0.5, 0.25, 0.25], rtol=1e-3)
