"""Where the shadow maps of area lights look from. No GL here.

Each of the strongest that stand has nine points: the middles of a parallelogram's nine parts, 3x3
or in a row where it is long, or nine within a ball, spread as its disc is from wherever it is seen.
Five faces of a cube that stands on the light see the half space before it, six all around.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from elemental.core import transforms
from elemental.core.layout import layouts
from elemental.passes.shadow_fit import Bounds, Cut, FittedView, emitter_view
from elemental.scene.area_lights import AreaLight

EMITTERS_MAX = 4
"""Most area lights with shadow maps: of 256 texels a side those take 45 to 54 MiB, twice that where
parts of the scene move. One of 54 views costs the atrium's first frame 0.4 s on the software driver
[measured]."""
POINTS = int(layouts().constant("AREA_POINTS"))
LONG_FACE = float(layouts().constant("LONG_FACE"))
BALL_SPREAD = float(layouts().constant("BALL_SPREAD"))
LEAST_HEIGHT = float(layouts().constant("LEAST_HEIGHT"))
SIDE_OF_MAPS = 4
"""Of a side of the other lights' maps theirs are one part [measured: a half instead changes the
energies of docs/accuracy.md by 1 % at most]."""
MOST_TEXELS = 512
"""Their longest side: a light's maps then take 45 to 54 MiB, twice that where parts move."""
BALL_MARGIN = 1.001
"""Of the distance of a ball's farthest vertex: what is within is the ball itself."""
FAR_BEHIND_M = 1e30
"""Below a light's plane: all that is behind it."""

CUBE = (
    ((0.0, 0.0, 1.0), (0.0, 1.0, 0.0)),
    ((1.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
    ((-1.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
    ((0.0, 1.0, 0.0), (0.0, 0.0, 1.0)),
    ((0.0, -1.0, 0.0), (0.0, 0.0, 1.0)),
    ((0.0, 0.0, -1.0), (0.0, 1.0, 0.0)),
)
"""(direction, up) of a point's views in its light's frame, as `emitter_view` of
glsl/lib/area_map.glsl counts them; the last is for lights that shine backwards too."""


def side_of_maps(resolution: int) -> int:
    """Texels, where the other lights' maps have so many."""
    return min(resolution // SIDE_OF_MAPS, MOST_TEXELS)


def views_a_point(light: AreaLight) -> int:
    """Views from each of its points."""
    return len(CUBE) if light.both_sides or light.is_ball else len(CUBE) - 1


def first_views(emitters: Sequence[AreaLight]) -> list[int]:
    """The number of each one's first view, where theirs come before all others."""
    counts = [POINTS * views_a_point(light) for light in emitters]
    return [sum(counts[:number]) for number in range(len(counts))]


def points(light: AreaLight) -> npt.NDArray[np.float64]:
    """(9, 3) m, world space."""
    corner, u, v = (x.astype(np.float64) for x in (light.corner, light.edge_u, light.edge_v))
    if light.is_ball:
        signs = np.array([[k & 1, k >> 1 & 1, k >> 2] for k in range(8)]) * 2.0 - 1.0
        return np.concatenate([[corner], corner + BALL_SPREAD * light.ball_radius * signs])
    columns, rows = _parts(u, v)
    middles_u, middles_v = ((np.arange(count) + 0.5) / count for count in (columns, rows))
    return np.array([corner + s * u + t * v for t in middles_v for s in middles_u])


def _parts(u: npt.NDArray[np.float64], v: npt.NDArray[np.float64]) -> tuple[int, int]:
    """How many lie along each edge: `parts_along` of glsl/lib/area_light.glsl."""
    long_u, long_v = np.linalg.norm(u), np.linalg.norm(v)
    if long_u > LONG_FACE * long_v:
        return POINTS, 1
    return (1, POINTS) if long_v > LONG_FACE * long_u else (3, 3)


def emitter_views(light: AreaLight, bounds: Bounds, resolution: int) -> list[FittedView]:
    """The views from its points, one point after the other."""
    frame, cut, size = _frame(light), _cut(light), _size(light)
    views = []
    for point in points(light):
        for direction, up in CUBE[: views_a_point(light)]:
            towards, above = np.array(direction) @ frame, np.array(up) @ frame
            rotation = transforms.look_at(point, point + towards, above)
            views.append(emitter_view(point, size, rotation, bounds, resolution, cut))
    return views


def _frame(light: AreaLight) -> npt.NDArray[np.float64]:
    """(3, 3): its axes by rows, along the first edge, across it, and forwards; a ball's are the
    world's."""
    if light.is_ball:
        return np.eye(3)
    u, v = light.edge_u.astype(np.float64), light.edge_v.astype(np.float64)
    front = np.cross(u, v) / np.linalg.norm(np.cross(u, v))
    along = u / np.linalg.norm(u)
    return np.array([along, np.cross(front, along), front])


def _size(light: AreaLight) -> float:
    """m: a ball's diameter, the side of a square as large as a face."""
    if light.is_ball:
        return 2.0 * light.ball_radius
    return float(np.sqrt(np.linalg.norm(np.cross(light.edge_u, light.edge_v))))


def _cut(light: AreaLight) -> Cut:
    """What casts no shadow: the light itself, and what is behind it."""
    if light.is_ball:
        return Cut(ball=(*light.corner.tolist(), BALL_MARGIN * light.outer_radius))
    front = _frame(light)[2]
    plane = (*front.tolist(), -float(front @ light.corner))
    least = LEAST_HEIGHT * _size(light)
    return Cut(plane=plane, heights=(-least if light.both_sides else -FAR_BEHIND_M, least))
