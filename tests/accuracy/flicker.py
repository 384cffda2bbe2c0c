"""How still a picture stays where a moving thing hardly shines: a sequence and its changes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from elemental.frame import Renderer
from elemental.scene.evaluate import Pose, evaluate
from elemental.scene.model import Camera
from reference.metrics import LUMINANCE

Array = npt.NDArray[Any]

FAR = 0.05
"""Part of a pixel's own light that the moving thing may add to it or take from it in any frame."""
DARK = 0.01
"""Part of a picture's mean luminance below which pixels are too dark to tell."""


@dataclass(frozen=True)
class Flicker:
    """Changes of luminance from frame to frame, as parts of a pixel's own.

    `far`: part of the picture that the moving thing neither covers nor lights, and that is no
    darker than DARK. `deviation`: root of the mean square of the changes there; `most`: the largest
    of 99.9 % of them. `jitter`: root of the mean square of what turns back with the next frame,
    half the second difference: next to nothing of a light that comes near or goes, all of one that
    flickers; `lit_jitter`: the same of what is lit, not covered.
    """

    far: float
    deviation: float
    most: float
    jitter: float
    lit_jitter: float


def hidden(renderer: Renderer) -> Pose:
    """A pose in which nothing that can move shows."""
    pose = evaluate(renderer.scene, 0.0)
    return replace(pose, visible=np.zeros_like(pose.visible))


def flicker(renderer: Renderer, camera: Camera, times_s: Sequence[float]) -> Flicker:
    """Of a sequence of frames, one after the other as a window shows them."""
    light = np.stack([
        luminance(renderer.read(renderer.render(camera, t, k, "scene_color")))
        for k, t in enumerate(times_s)
    ])  # fmt: skip
    alone = hidden(renderer)
    own = luminance(renderer.read(renderer.render(camera, 0.0, 0, "scene_color", alone)))
    stands = renderer.read(renderer.render(camera, 0.0, 0, "normal", alone))
    covered = np.zeros(own.shape, np.bool_)
    for k, t in enumerate(times_s):
        seen = renderer.read(renderer.render(camera, t, k, "normal"))
        covered |= (seen != stands).any(axis=2)
    floor = DARK * own.mean()
    far = (np.abs(light - own) <= FAR * own).all(axis=0) & (own >= floor) & ~covered
    changes = np.diff(light[:, far] / own[far], axis=0)
    lit = (np.abs(light - own) > FAR * own).any(axis=0) & ~covered
    level = np.maximum(light.mean(axis=0), floor)
    return Flicker(
        far=float(far.mean()),
        deviation=_root_mean_square(changes),
        most=float(np.quantile(np.abs(changes), 0.999)),
        jitter=_root_mean_square(np.diff(changes, axis=0) / 2),
        lit_jitter=_root_mean_square(np.diff(light[:, lit] / level[lit], n=2, axis=0) / 2),
    )


def luminance(picture: Array) -> Array:
    """(H, W) float64 of (H, W, 4)."""
    return np.asarray(picture[..., :3].astype(np.float64) @ LUMINANCE)


def _root_mean_square(values: Array) -> float:
    return float(np.sqrt(np.mean(values**2))) if values.size else 0.0
