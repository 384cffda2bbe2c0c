"""A glowing ball that moves leaves the rest of the picture still: [docs/gi.md] has the atrium."""

# GI-06

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from accuracy.flicker import FAR, Flicker, flicker, hidden, luminance
from elemental.frame import Renderer
from elemental.gpu.device import Device
from elemental.scene.extent import settle
from elemental.scene.model import Scene
from elemental.scene.motion import RigBuilder
from elemental.settings import Settings
from gpu.moving import slide
from gpu.rig import IDENTITY, at, camera, mesh, scene, sun, vector
from gpu.voxel.scenes import colored, glowing
from shapes import box, quad, sphere

EYE = camera(vector(0, 2.5, 5.5), vector(0, 0.4, 0))
FRAMES = 12
TIMES_S = [k / 24.0 for k in range(FRAMES)]


def court() -> Scene:
    """A sunlit floor with two pillars; a ball that drifts by 1 m/s behind the left one."""
    made = scene(
        (mesh(quad(6.0)), IDENTITY),
        (mesh(box((0.4, 1.6, 0.4)), 1), at(-1, 0.8, 0)),
        (mesh(box((0.4, 1.6, 0.4)), 1), at(1.5, 0.8, 0.5)),
        (mesh(sphere(0.3), 2, smooth=True), IDENTITY),
        materials=[colored(0.7, 0.7, 0.7), colored(0.7, 0.3, 0.2), glowing(3.0, 2.5, 2.0)],
        lights=[sun(vector(0.5, -1.0, -0.4), 2.0)],
    )
    builder = RigBuilder()
    ball = builder.node()
    builder.tracks = [slide(ball, (-2.3, 0.6, -1.0), (-1.3, 0.6, -1.0))]
    made.instances[3].dynamic, made.instances[3].node = True, ball
    made.motion = builder.motion()
    settle(made)
    return made


@pytest.fixture(scope="module")
def found(device: Device) -> Any:
    """(what flickers, the picture without the ball before and after)."""
    settings = Settings({"gi.resolution": 64, "gi.bounces": 2, "shadow.resolution": 512})
    renderer = Renderer(device, court(), settings, (96, 64))

    def still() -> Any:
        return renderer.read(renderer.render(EYE, 0.0, 0, "scene_color", hidden(renderer)))

    before = still()
    made = flicker(renderer, EYE, TIMES_S)
    yield made, before, still()
    renderer.release()


def test_what_a_ball_hardly_lights_hardly_changes(found: tuple[Flicker, Any, Any]) -> None:
    """By 0.05 % from frame to frame, root of the mean square; 99.9 % of it by less than 0.5 %."""
    made, _, _ = found
    print(made)
    assert made.far > 0.45
    assert 0.0 < made.deviation < 0.0005
    assert made.most < 0.005
    assert made.jitter < 0.0003


def test_what_a_ball_lights_goes_with_it_smoothly(found: tuple[Flicker, Any, Any]) -> None:
    """As an area light; as voxels, in their steps, it jitters by 4.6 % (`gi.area_lights=false`)."""
    made, _, _ = found
    assert 0.0 < made.lit_jitter < 0.03


def test_what_it_left_is_as_it_was(found: tuple[Flicker, Any, Any]) -> None:
    """No trail: where no ball is, none was, to the steps of half floats."""
    _, before, after = found
    np.testing.assert_allclose(after, before, rtol=2.0**-9, atol=2.0**-14)


class Flash(Renderer):
    """A renderer whose every second picture is a little brighter, half of it by far."""

    def read(self, frame: Any) -> Any:
        picture = super().read(frame)
        if frame.is_linear:
            self.count = getattr(self, "count", 0) + 1
            picture[:, ::2, :3] *= 1.0 + 0.5 * FAR * (self.count % 2)
        return picture


def test_a_flicker_is_found(device: Device) -> None:
    """Of 2.5 % in half of the pixels: a jitter of that over the root of 2."""
    settings = Settings({"gi.enabled": False, "shadow.resolution": 512})
    renderer = Flash(device, court(), settings, (96, 64))
    made = flicker(renderer, EYE, TIMES_S)
    assert made.jitter == pytest.approx(0.5 * FAR / np.sqrt(2.0), rel=0.15)
    assert luminance(np.ones((1, 1, 4))) == pytest.approx(1.0, abs=1e-3)
    renderer.release()
