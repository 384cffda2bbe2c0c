"""A camera that flies: position, yaw and pitch, moved by keys and mouse. No window, no GL."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from elemental.core import transforms
from elemental.scene.model import Camera

LOOK_RAD_PER_PX = math.radians(0.15)
"""Turn for a mouse way of one pixel: half a turn for 1,200 pixels."""
MAX_PITCH = math.radians(89.0)
"""Short of the zenith, where yaw would lose its meaning."""
SPEED_PER_NOTCH = 1.2
"""Factor on the speed for one notch of the wheel."""
DIAGONALS_PER_S = 0.1
"""First speed: ten seconds from end to end of the scene."""
SPEED_RANGE = (1e-4, 10.0)
"""Slowest and fastest speed in scene diagonals a second."""
LEAST_NEAR = 0.03
"""Of the lens's near plane, for who flies slowest: closer, depths far away would run together, and
`open_reach` of the sun's shadows, which follows the near plane, would shrink to nothing [inferred].
"""
FAST_FACTOR = 4.0
"""Shift multiplies the speed by this, Alt divides by it."""


@dataclass
class FlyCamera:
    """Position in metres, yaw and pitch in radians: yaw 0 looks along -z, positive pitch up.

    ``lens`` gives field of view and clip distances. A camera's roll is not kept.
    """

    position: npt.NDArray[np.float64]
    yaw: float
    pitch: float
    speed: float
    """Metres a second."""
    diagonal: float
    """The scene's, in metres; the range of speeds scales with it."""
    lens: Camera

    @classmethod
    def at(cls, camera: Camera, diagonal: float) -> FlyCamera:
        """Standing where ``camera`` stands, in a scene of ``diagonal`` metres."""
        diagonal = max(diagonal, 1e-6)
        fly = cls(np.zeros(3), 0.0, 0.0, DIAGONALS_PER_S * diagonal, diagonal, camera)
        fly.jump(camera)
        return fly

    def jump(self, camera: Camera) -> None:
        """Take over another camera's place, direction and lens; the speed stays."""
        world_from_view = camera.world_from_view.astype(np.float64)
        forward = -world_from_view[:3, 2] / np.linalg.norm(world_from_view[:3, 2])
        self.position = world_from_view[:3, 3].copy()
        self.pitch = float(np.clip(math.asin(np.clip(forward[1], -1, 1)), -MAX_PITCH, MAX_PITCH))
        # Looking straight up or down, the view's own up tells where forward would be.
        level = forward
        if math.hypot(forward[0], forward[2]) < 1e-4:
            level = world_from_view[:3, 1] * (-1.0 if forward[1] > 0 else 1.0)
        self.yaw = math.atan2(-level[0], -level[2])
        self.lens = camera

    def look(self, right_px: float, down_px: float) -> None:
        """Turn by a mouse way in pixels."""
        self.yaw = math.remainder(self.yaw - LOOK_RAD_PER_PX * right_px, math.tau)
        pitch = self.pitch - LOOK_RAD_PER_PX * down_px
        self.pitch = min(max(pitch, -MAX_PITCH), MAX_PITCH)

    def scroll(self, notches: float) -> None:
        """Change the speed by notches of the wheel, up is faster."""
        lo, hi = (self.diagonal * bound for bound in SPEED_RANGE)
        self.speed = min(max(self.speed * SPEED_PER_NOTCH ** min(notches, 100.0), lo), hi)

    def fly(self, right: float, up: float, forward: float, seconds: float) -> None:
        """Move by directions in -1..1 for ``seconds``; up is the world's, diagonals no faster."""
        axes = self.axes()
        way = right * axes[0] + up * np.array([0.0, 1.0, 0.0]) + forward * axes[2]
        length = float(np.linalg.norm(way))
        amount = min(max(abs(right), abs(up), abs(forward)), FAST_FACTOR)
        if length > 1e-9:
            self.position = self.position + way / length * (amount * self.speed * seconds)

    def axes(self) -> npt.NDArray[np.float64]:
        """Rows right, up and forward, (3, 3), unit vectors in world space."""
        sin_yaw, cos_yaw = math.sin(self.yaw), math.cos(self.yaw)
        sin_pitch, cos_pitch = math.sin(self.pitch), math.cos(self.pitch)
        right = np.array([cos_yaw, 0.0, -sin_yaw])
        forward = np.array([-sin_yaw * cos_pitch, sin_pitch, -cos_yaw * cos_pitch])
        return np.stack([right, np.cross(right, forward), forward])

    def camera(self) -> Camera:
        """The lens at this place and direction; its image takes the window's aspect.

        Who flies slower than at first looks at small things: the near plane comes closer, too.
        """
        eye = self.position
        view_from_world = transforms.look_at(eye, eye + self.axes()[2])
        slowness = self.speed / (DIAGONALS_PER_S * self.diagonal)
        return replace(
            self.lens,
            world_from_view=transforms.inverse(view_from_world),
            near=min(max(slowness, LEAST_NEAR), 1.0) * self.lens.near,
            aspect=None,
        )
