"""The area lights that shaders loop over."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from elemental.core.layout import Block, layouts, pack, pack_array
from elemental.passes.emitter_views import EMITTERS_MAX, first_views
from elemental.scene.area_lights import FACES_MAX, AreaLight, area_lights, followed
from elemental.scene.evaluate import Pose
from elemental.scene.model import Scene

NO_MAPS, SOME_MAPS, ALL_MAPS = range(3)
"""Values of AREA_MAPS in glsl/lib/area_shadow.glsl."""
NO_VIEW = int(layouts().constant("NO_VIEW"))


def pack_area_lights(lights: Sequence[AreaLight], views: Sequence[int] = ()) -> Block:
    """The AreaLights block of glsl/shared/area_light.glsl; at most FACES_MAX of them. views: the
    number of each light's first shadow view, NO_VIEW without; none has any by default."""
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
        shadow_view=[*views, *[NO_VIEW] * (FACES_MAX - len(views))],
    )
    return pack(
        layouts().block("AreaLights"), faces=faces, count=len(lights), inverse_radiance=inverse
    )


def area_maps(block: Block) -> int:
    """Which of a block's lights have shadow maps."""
    views = block["faces"]["shadow_view"][: int(block["count"])]
    if not (views > NO_VIEW).any():
        return NO_MAPS
    return ALL_MAPS if (views > NO_VIEW).all() else SOME_MAPS


class AreaLightBlock:
    """A scene's area lights, and the block that tells shaders where poses have carried them.

    `lights` are those at rest, none while ``enabled`` is off; of those that stand the strongest are
    in `mapped`, which is to be given to `update_shadows`, where ``maps``, and `unmapped` counts the
    others. `choose` again when a material or a setting changed. Poses are compared as objects.
    """

    def __init__(self, scene: Scene, enabled: bool, maps: bool = False) -> None:
        self._scene = scene
        self.choose(enabled, maps)

    def choose(self, enabled: bool, maps: bool) -> None:
        """Find the scene's area lights anew."""
        self.lights = area_lights(self._scene) if enabled else []
        instances = self._scene.instances
        stand = [n for n, light in enumerate(self.lights) if not instances[light.instance].dynamic]
        stand.sort(key=lambda number: -self.lights[number].flux)
        mapped = stand[:EMITTERS_MAX] if maps else []
        self.mapped = [self.lights[number] for number in mapped]
        self.unmapped = len(stand) - len(mapped) if maps else 0
        first = dict(zip(mapped, first_views(self.mapped), strict=True))
        self._views = [first.get(number, NO_VIEW) for number in range(len(self.lights))]
        self.block = pack_area_lights(self.lights, self._views)
        self._followed: Pose | None = None

    def follow(self, pose: Pose) -> None:
        """Carry the lights along with the instances that emit them."""
        if self.lights and pose is not self._followed:
            moved = followed(self._scene, self.lights, pose)
            self.block = pack_area_lights(moved, self._views)
            self._followed = pose
