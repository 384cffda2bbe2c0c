# GI-14 SH-09
"""The sun of an environment's image: what is a sun, where, how large, and of what power."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from elemental.scene.image_sun import WIDEST_RIM, find_sun, with_sun
from elemental.scene.lights import ImageSun
from elemental.scene.model import Environment, Scene
from elemental.scene.sky_sun import SkySun, note_sun, told
from elemental.settings import Settings

Array = npt.NDArray[Any]
RED_SUN = np.array([9000.0, 6000.0, 3000.0])


def directions(height: int) -> Array:
    """(H, 2H, 3) of the texels' centres, by scene.model.Environment."""
    polar = (np.arange(height) + 0.5) / height * np.pi
    azimuth = ((np.arange(2 * height) + 0.5) / (2 * height) - 0.5) * 2 * np.pi
    sine = np.sin(polar)[:, None]
    x, z = sine * np.sin(azimuth), -sine * np.cos(azimuth)
    return np.stack([x, np.broadcast_to(np.cos(polar)[:, None], x.shape), z], axis=-1)


def solid_angles(height: int) -> Array:
    """(H, 1) sr of a texel of each row, exact."""
    edges = np.cos(np.arange(height + 1) / height * np.pi)
    return ((edges[:-1] - edges[1:]) * np.pi / height)[:, None]


def unit(*v: float) -> Array:
    return np.array(v) / np.linalg.norm(v)


def sky(height: int = 256) -> Array:
    """A smooth gradient, blue above."""
    d = directions(height)
    return (np.array([0.4, 0.5, 0.8]) * (1.0 + 0.5 * d[..., 1:2])).astype(np.float32)


def add_disc(image: Array, towards: Array, radius: float, radiance: Array | float) -> Array:
    """Adds a disc whose texels are covered by parts, as a camera sees it."""
    height, fine = len(image), 8
    d = directions(height * fine)
    inside = (d @ towards > np.cos(radius)).reshape(height, fine, 2 * height, fine)
    share = inside.mean(axis=(1, 3), dtype=np.float64)[..., None]
    return (image + share * radiance).astype(np.float32)


def irradiance(image: Array, normal: Array) -> Array:
    """(3,) of a plane under an image."""
    height = len(image)
    weight = np.maximum(directions(height) @ normal, 0.0) * solid_angles(height)
    return np.einsum("hw,hwc->c", weight, image.astype(np.float64))


def found(image: Array) -> ImageSun:
    sun = find_sun(image)
    assert sun is not None
    return sun


PLACES = {
    "high": unit(0.3, 0.8, -0.5),
    "seam": unit(0.02, 0.4, 1.0),
    "zenith": unit(0.02, 1.0, 0.01),
    "low": unit(-1.0, 0.1, 0.2),
}


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("radius_deg", [0.27, 1.0, 4.0])
def test_environment_and_light_have_the_image_s_irradiance(place: str, radius_deg: float) -> None:
    """On planes of any orientation, each primary, within 1 % of what the whole image has at most;
    most of it is the light's."""
    towards = PLACES[place]
    strength = RED_SUN * (0.5 / radius_deg) ** 2
    image = add_disc(sky(), towards, math.radians(radius_deg), strength)
    sun = found(image)
    facing = irradiance(image, towards)
    rng = np.random.default_rng(1)
    for normal in (towards, *rng.normal(size=(20, 3))):
        n = normal / np.linalg.norm(normal)
        lit = sun.light.strength * max(float(-sun.light.direction @ n), 0.0)
        np.testing.assert_array_less(
            np.abs(irradiance(sun.without, n) + lit - irradiance(image, n)), 0.01 * facing
        )
    disc = add_disc(0.0 * sky(), towards, math.radians(radius_deg), strength)
    np.testing.assert_allclose(sun.light.strength, irradiance(disc, towards), rtol=0.02)


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("radius_deg", [0.27, 1.0, 2.5, 5.0])
def test_direction_and_size_are_the_disc_s_within_a_texel(place: str, radius_deg: float) -> None:
    texel = math.pi / 256
    # A disc smaller than a texel may lie where four of them meet.
    sun = found(add_disc(sky(), PLACES[place], math.radians(radius_deg), 5e3))
    aside = math.acos(min(float(-sun.light.direction @ PLACES[place]), 1.0))
    assert aside < 0.5 * texel
    blur = texel if math.radians(radius_deg) < texel else 0.5 * texel
    assert abs(sun.light.source_radius - math.radians(radius_deg)) < blur


def test_the_hole_is_filled_with_the_rim_and_nothing_else_changes() -> None:
    image = add_disc(sky(), PLACES["high"], math.radians(1.0), RED_SUN)
    sun = found(image)
    far = np.arccos(directions(256) @ PLACES["high"]) > WIDEST_RIM
    np.testing.assert_array_equal(sun.without[far], image[far])
    np.testing.assert_allclose(sun.without, sky(), rtol=0.05)
    assert (sun.without <= image).all()


def window(image: Array) -> Array:
    """The image with a bright window 30 degrees wide."""
    bright = image.copy()
    bright[80:120, 200:240] = 40.0
    return bright


NO_SUNS = {
    "constant": np.full((64, 128, 3), 2.0, np.float32),
    "black": np.zeros((64, 128, 3), np.float32),
    "one texel": np.ones((1, 1, 3), np.float32),
    "one row": np.ones((1, 500, 3), np.float32),
    "a column": np.arange(300, dtype=np.float32).reshape(100, 1, 3) ** 3,
    "overcast": add_disc(sky(), unit(0, 1, 0.3), math.radians(40.0), 3.0),
    "window": window(sky()),
    "moon": add_disc(sky(), unit(0, 1, 0.3), math.radians(0.27), 100.0),
    "too wide": add_disc(sky(), unit(0, 1, 0.3), math.radians(15.0), 1e3),
    "coarse": np.where(np.arange(48).reshape(4, 4, 3) > 44, 1e6, 1.0).astype(np.float32),
}


@pytest.mark.parametrize("name", NO_SUNS)
def test_images_without_a_compact_sun_stay_whole(name: str) -> None:
    assert find_sun(NO_SUNS[name]) is None
    whole = with_sun(Environment(NO_SUNS[name], np.ones(3, np.float32), 1.0))
    assert whole.sun is None
    assert whole.radiance is NO_SUNS[name]


def test_a_sun_in_a_black_sky_leaves_black() -> None:
    sun = found(add_disc(np.zeros((256, 512, 3)), PLACES["high"], math.radians(1.0), 1.0))
    assert sun.without.max() == 0.0


def test_of_two_suns_the_brighter_is_taken_and_the_other_stays() -> None:
    first, second = PLACES["high"], PLACES["low"]
    image = add_disc(sky(), first, math.radians(0.8), 2e3)
    image = add_disc(image, second, math.radians(0.4), 3e3)  # higher peak, less light
    sun = found(image)
    assert float(-sun.light.direction @ first) > math.cos(math.pi / 256)
    near = directions(256) @ second > math.cos(WIDEST_RIM)
    np.testing.assert_array_equal(sun.without[near], image[near])


def lit(settings: dict[str, Any], tint: Array | None = None, intensity: float = 1.0) -> Array:
    """(3,) lux of the sun under settings, 0 where it is no light."""
    environment = environment_with_sun(tint, intensity)
    joined = SkySun().joined([], environment, Settings().replace(settings, "test"))
    return np.sum([light.strength for light in joined], axis=0) * np.ones(3)


IMAGE = add_disc(sky(64), PLACES["high"], math.radians(3.0), 500.0)


def environment_with_sun(tint: Array | None = None, intensity: float = 1.0) -> Environment:
    color = np.ones(3, np.float32) if tint is None else tint
    return with_sun(Environment(IMAGE, color, intensity))


def test_the_light_follows_the_settings_and_the_scene_file() -> None:
    plain = lit({})
    assert plain.min() > 1.0
    np.testing.assert_allclose(lit({"sky.intensity": 2.5}), 2.5 * plain, rtol=1e-6)
    tint = np.array([1.0, 0.5, 0.0], np.float32)
    np.testing.assert_allclose(lit({}, tint, 3.0), 3.0 * tint * plain, rtol=1e-6)
    for off in ({"sky.sun": False}, {"sky.enabled": False}, {"sky.intensity": 0.0}):
        np.testing.assert_array_equal(lit(off), 0.0)


def test_the_very_light_stays_while_nothing_changes() -> None:
    """What was made for it holds as long as it is the same object."""
    environment, suns = environment_with_sun(), SkySun()
    first = suns.joined([], environment, Settings())[0]
    assert suns.joined([], environment, Settings().replace({"exposure": 1.0}, ""))[0] is first
    brighter = Settings().replace({"sky.intensity": 2.0}, "")
    assert suns.joined([], environment, brighter)[0] is not first


def test_one_line_tells_of_the_sun() -> None:
    scene = Scene("test", Path("a.toml"), environment=environment_with_sun())
    note_sun(scene, Settings())
    (note,) = scene.notes
    (light,) = SkySun().joined([], scene.environment, Settings())
    assert told(light).startswith("54° high towards (0.3")
    assert told(light).endswith(" lux")
    assert note.startswith(f"a.toml: the environment's sun, {told(light)}, shines")
    note_sun(scene, Settings().replace({"sky.sun": False}, ""))
    assert len(scene.notes) == 1
