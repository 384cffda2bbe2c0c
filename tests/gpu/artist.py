"""An artist at work: a material's file that is saved again and again, and a plane that wears it."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np

from elemental.scene.definitions import MaterialDefinition, read_definition
from gpu.rig import IDENTITY, MakeRig, Rig, camera, material, mesh, read, scene, vector
from shapes import quad

ABOVE = camera(vector(0, 3, 0), vector(0, 0, 0))

HALVES = """/*
[parameters]
left = { type = "color", default = [0.25, 0.0, 0.0] }
right = { type = "color", default = [0.0, 0.25, 0.0] }
*/
void material(inout Surface s, MaterialInput m, Parameters p) {
    bool is_left = m.position_ws.x < 0.0;
    s.albedo = is_left ? p.left : p.right;
    s.opacity = is_left ? 1.0 : 0.0;
}
"""


class Artist:
    """Writes a material's file, again and again."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self._saves = 0

    def save(self, text: str) -> None:
        """As an editor does: the file's time moves on."""
        self._saves += 1
        self.path.write_text(text)
        stamp = self.path.stat().st_mtime_ns + self._saves * 10_000_000
        os.utime(self.path, ns=(stamp, stamp))

    def definition(self, text: str) -> MaterialDefinition:
        self.save(text)
        return read_definition(self.path)


def albedo(rig: Rig) -> Any:
    """(H, W, 3) of the G-buffer."""
    g, _, gb = rig.begin()
    return (read(g, gb.c)[..., :3] / 255.0) ** 2


def emission(rig: Rig) -> Any:
    g, _, gb = rig.begin()
    return read(g, gb.scene_color)[..., :3].astype(np.float32)


def halves(rig: Rig) -> tuple[Any, Any]:
    """The pixels of the plane's left and of its right half."""
    points = rig.positions()
    return points[..., 0] < -0.05, points[..., 0] > 0.05


def draws(rig: MakeRig, artist: Artist, text: str = HALVES, **fields: Any) -> Rig:
    """A plane of a material, from above."""
    worn = material(definition=artist.definition(text), **fields)
    return rig(scene((mesh(quad(2.0)), IDENTITY), materials=[worn]), ABOVE)
