"""Cameras, their paths, and one that frames a scene without any."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from elemental.core import transforms
from elemental.scene.arrays import FloatArray


@dataclass
class Camera:
    """A perspective camera looking down its -z: `fov_y` in radians, `near` and `far` in m.

    `far` None: as far as the scene reaches; `aspect` None: the image's own. A `node` of
    `Scene.motion`'s rig moves it.
    """

    name: str
    world_from_view: FloatArray
    fov_y: float
    near: float
    far: float | None = None
    aspect: float | None = None
    node: int = -1


@dataclass
class CameraPath:
    """A camera's motion: keys at `times` (K,) float64 s, increasing; eyes, targets (K, 3) m."""

    times: npt.NDArray[np.float64]
    eyes: FloatArray
    targets: FloatArray
    fov_y: float
    near: float
    loop: bool = False


FRAMING_FOV_Y = math.radians(39.3)
"""Of the Cornell box's published camera (35 mm film, 25 mm sensor)."""
FRAMING_MARGIN = 1.05
FRAMING_ELEVATION = math.radians(30.0)
"""How far a camera looks down on a flat scene; on one as high as deep it looks level."""
FRAMING_NEAR = 1e-3
"""Near plane of a framing camera as a part of the scene's diagonal."""


def framing_camera(low: FloatArray, high: FloatArray, aspect: float) -> Camera:
    """A camera in front of (+z of) the box low..high that just sees all eight corners.

    glTF assets face +z, so this looks at their front.
    """
    size = np.maximum(high - low, 0.0).astype(np.float64)
    diagonal = float(np.linalg.norm(size)) or 1.0
    flatness = float(np.clip(1.0 - size[1] / max(size[2], 1e-3 * diagonal), 0.0, 1.0))
    elevation = FRAMING_ELEVATION * flatness
    backward = np.array([0.0, math.sin(elevation), math.cos(elevation)])
    up = np.array([0.0, math.cos(elevation), -math.sin(elevation)])
    signs = np.array(np.meshgrid([-0.5, 0.5], [-0.5, 0.5], [-0.5, 0.5])).reshape(3, 8).T
    corners = signs * size * FRAMING_MARGIN
    tan_y = math.tan(FRAMING_FOV_Y / 2)
    reach = np.maximum(np.abs(corners[:, 0]) / (tan_y * aspect), np.abs(corners @ up) / tan_y)
    distance = max(float((corners @ backward + reach).max()), 1e-2 * diagonal)
    center = (low.astype(np.float64) + high) / 2
    view_from_world = transforms.look_at(center + distance * backward, center, up)
    return Camera(
        name="default",
        world_from_view=transforms.inverse(view_from_world),
        fov_y=FRAMING_FOV_Y,
        near=FRAMING_NEAR * diagonal,
    )
