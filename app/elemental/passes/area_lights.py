"""The area lights that shaders loop over."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from elemental.core.layout import Block, layouts, pack, pack_array
from elemental.scene.area_lights import FACES_MAX, AreaLight, area_lights, followed
from elemental.scene.evaluate import Pose
from elemental.scene.model import Scene


def pack_area_lights(lights: Sequence[AreaLight]) -> Block:
    """The AreaLights block of glsl/shared/area_light.glsl; at most FACES_MAX of them."""
    # A parallelogram without extent would divide by its area: those that are left over have one.
    unused = FACES_MAX - len(lights)
    radii = [light.ball_radius for light in lights]
    edges_u = np.array([light.edge_u for light in lights] + [(1.0, 0.0, 0.0)] * unused)
    edges_v = np.array([light.edge_v for light in lights] + [(0.0, 1.0, 0.0)] * unused)
    edges_u[: len(lights)][np.array(radii, bool)] = 1.0, 0.0, 0.0
    edges_v[: len(lights)][np.array(radii, bool)] = 0.0, 1.0, 0.0
    brightest = max((float(light.radiance.max()) for light in lights), default=0.0)
    inverse = 1.0 / brightest if brightest > 0.0 else 1.0
    faces = pack_array(
        layouts().struct("AreaLight", "std140"),
        FACES_MAX,
        corner_ws=[light.corner for light in lights] + [np.zeros(3)] * unused,
        edge_u_ws=edges_u,
        edge_v_ws=edges_v,
        area_m2=np.linalg.norm(np.cross(edges_u, edges_v), axis=1),
        radiance=[light.radiance for light in lights] + [np.zeros(3)] * unused,
        ball_radius=radii + [0.0] * unused,
        both_sides=[float(light.both_sides) for light in lights] + [0.0] * unused,
    )
    return pack(
        layouts().block("AreaLights"), faces=faces, count=len(lights), inverse_radiance=inverse
    )


class AreaLightBlock:
    """A scene's area lights, and the block that tells shaders where poses have carried them.

    `lights` are those at rest, none while ``enabled`` is off. `choose` again when a material or the
    setting changed. Poses are compared as objects.
    """

    def __init__(self, scene: Scene, enabled: bool) -> None:
        self._scene = scene
        self.choose(enabled)

    def choose(self, enabled: bool) -> None:
        """Find the scene's area lights anew."""
        self.lights = area_lights(self._scene) if enabled else []
        self.block = pack_area_lights(self.lights)
        self._followed: Pose | None = None

    def follow(self, pose: Pose) -> None:
        """Carry the lights along with the instances that emit them."""
        if self.lights and pose is not self._followed:
            self.block = pack_area_lights(followed(self._scene, self.lights, pose))
            self._followed = pose
