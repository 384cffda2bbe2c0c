"""The sun of the environment's image among the scene's lights, as the settings have it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from elemental.scene.image_sun import LUMINANCE
from elemental.scene.lights import Environment, ImageSun, Light
from elemental.scene.model import FloatArray, Scene
from elemental.settings import Settings


class SkySun:
    """Adds the sun to the lights; what it gives is the very object of before while nothing else
    was asked for."""

    def __init__(self) -> None:
        self._asked: tuple[ImageSun, FloatArray] | None = None
        self._light: Light | None = None

    def joined(
        self, lights: Sequence[Light], environment: Environment | None, settings: Settings
    ) -> Sequence[Light]:
        """The lights and, behind them, the sun if it shines."""
        if environment is None or environment.sun is None:
            return lights
        factor = _factor(environment, settings)
        if not factor.any():
            return lights
        sun = environment.sun
        if self._asked is None or self._asked[0] is not sun or (self._asked[1] != factor).any():
            self._asked = (sun, factor)
            self._light = replace(sun.light, color=sun.light.color * factor)
        assert self._light is not None, "made when it was asked for"
        return [*lights, self._light]


def _factor(environment: Environment, settings: Settings) -> FloatArray:
    """(3,) on the light of the image's sun; 0 where it stays in the image or nothing shines."""
    if not (settings["sky.sun"] and settings["sky.enabled"]):
        return np.zeros(3, np.float32)
    scale = np.float32(environment.intensity * settings["sky.intensity"])
    return np.asarray(environment.tint * scale, np.float32)


def note_sun(scene: Scene, settings: Settings) -> None:
    """Say in the notes of a scene where the sun of its environment stands and how bright it is."""
    for sun in SkySun().joined([], scene.environment, settings):
        reason = "shines as a light with shadows; --set sky.sun=off leaves it in the image"
        scene.notes.append(f"{scene.path}: the environment's sun, {told(sun)}, {reason}")


def told(sun: Light) -> str:
    """Where a sun stands and how bright it is: ``54° high towards (0.33, 0.81, 0.49), 31 lux``."""
    x, y, z = (-sun.direction.astype(np.float64)).tolist()
    height = math.degrees(math.asin(min(max(y, -1.0), 1.0)))
    lux = float(sun.strength @ LUMINANCE)
    return f"{height:.0f}° high towards ({x:.2f}, {y:.2f}, {z:.2f}), {lux:.3g} lux"
