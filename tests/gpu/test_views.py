"""Debug views show what they say."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from elemental.gpu.refs import TextureHandle
from elemental.passes.views import CHANNELS, light_view, surface_view
from gpu.rig import IDENTITY, MakeRig, camera, material, mesh, read, scene, sun, vector
from shapes import quad

ABOVE = camera(vector(0.1, 3, 0.1), vector(0, 0, 0), fov_y=0.5)
"""Sees the quad around the centre and nothing in the corners."""
CENTER, CORNER = (32, 48), (0, 0)


def codes(rig: MakeRig, name: str) -> tuple[np.ndarray, np.ndarray]:
    """The view's centre and corner pixels."""
    surface = material(base_color=vector(0.25, 0.5, 1.0, 1), roughness=0.5)
    world = scene((mesh(quad(1.0)), IDENTITY), materials=[surface], lights=[sun(vector(0, -1, 0))])
    view = rig(world, ABOVE)
    g, block, gb = view.begin()
    image: TextureHandle
    if name in CHANNELS:
        image = surface_view(g, block, gb, name)
    else:
        image = light_view(g, block, gb, view.shadows, name)
    pixels = read(g, image)
    return pixels[CENTER], pixels[CORNER]


@pytest.mark.parametrize(
    ("name", "shown"),
    [
        ("normal", (128, 255, 128)),
        ("diffuse", (137, 188, 255)),
        ("specular", (56, 56, 56)),
        ("ao", (255, 255, 255)),
        ("subsurface", (0, 0, 0)),
        ("decal_mask", (255, 255, 255)),
    ],
)
def test_colours_are_shown_as_display_codes(rig: MakeRig, name: str, shown: tuple[int]) -> None:
    center, corner = codes(rig, name)
    np.testing.assert_allclose(center[:3], shown, atol=2)
    np.testing.assert_array_equal(corner, (0, 0, 0, 255))


def test_shadow_is_the_share_that_arrives_and_direct_its_radiance(rig: MakeRig) -> None:
    shadow, _ = codes(rig, "shadow")
    np.testing.assert_allclose(shadow[:3], 1.0, atol=1e-3)
    direct, _ = codes(rig, "direct")
    assert np.all(direct[:3] > [0.25, 0.5, 1.0])
    assert np.all(direct[:3] < [0.33, 0.58, 1.08])


def test_shadow_is_black_where_a_surface_faces_away(rig: MakeRig) -> None:
    """From the light, whether it casts shadows or not."""
    for casts in (True, False):
        lamp = replace(sun(vector(0, 1, 0)), casts_shadow=casts)
        world = scene((mesh(quad(1.0)), IDENTITY), materials=[material()], lights=[lamp])
        view = rig(world, ABOVE)
        assert view.visibility()[CENTER] == 0.0


def test_false_colours_tell_values_apart(rig: MakeRig) -> None:
    for name in ("depth", "specular_power", "lighting_model"):
        center, corner = codes(rig, name)
        assert center[:3].max() > 60
        np.testing.assert_array_equal(corner[:3], 0)
