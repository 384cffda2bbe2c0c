"""What a file leaves open: the light of a scene that has none, the exposure of a bright sun."""

from __future__ import annotations

import math

import numpy as np

from elemental.scene.model import Environment, FloatArray, Light, Scene
from elemental.settings import SETTINGS

SUN_ILLUMINANCE = 3.0
"""lux: nearly π, so that a white surface facing the sun has a radiance near 1 at exposure 0."""
SUN_COLOR = (1.0, 0.95, 0.88)
SUN_ELEVATION = math.radians(50.0)
SUN_AZIMUTH = math.radians(30.0)
"""From the default camera's side (+z) towards its right (+x): lit fronts, visible shadows."""
SKY_TINT = (0.75, 0.87, 1.0)
SKY_RADIANCE = 0.4
"""nit; an open horizontal surface then receives π/2.4 from the sky, 35 % of its light."""


def is_unlit(scene: Scene) -> bool:
    """Whether a scene has no light, no emission and no environment."""
    return not _is_lit_from_outside(scene) and not _emits(scene)


EMISSION_GATHERS = 2
"""Gathers of light where nothing but emission is: the first only shows what the lamps shine on."""


def is_lit_by_emission_only(scene: Scene) -> bool:
    """Whether a scene emits, and has no other light."""
    return _emits(scene) and not _is_lit_from_outside(scene)


def note_emission_only(scene: Scene) -> None:
    """Say in the notes of a scene that only its own emission lights it."""
    if is_lit_by_emission_only(scene):
        reason = (
            "lit by its own emission only; --set scene.default_lights=on adds a sun and a sky, "
            "--set sky.image=FILE a sky"
        )
        scene.notes.append(f"{scene.path}: {reason}")


def _is_lit_from_outside(scene: Scene) -> bool:
    """Whether a scene has an environment or a light."""
    return scene.environment is not None or any(light.intensity > 0.0 for light in scene.lights)


def _emits(scene: Scene) -> bool:
    used = {scene.meshes[instance.mesh].material for instance in scene.instances}
    return any(scene.materials[m].emits for m in used)


def add_default_lights(scene: Scene) -> None:
    """Give the scene a sun and, unless it has surroundings, a constant sky; say so in its notes."""
    lit = "a default sun and sky light it"
    reason = f"no light or emission: {lit}" if is_unlit(scene) else lit
    scene.lights.append(default_sun())
    if scene.environment is None:
        scene.environment = Environment(None, np.array(SKY_TINT, np.float32), SKY_RADIANCE)
    scene.notes.append(f"{scene.path}: {reason}")


def default_sun() -> Light:
    return Light(
        name="default sun",
        kind="directional",
        color=np.array(SUN_COLOR, np.float32),
        intensity=SUN_ILLUMINANCE,
        position=np.zeros(3, np.float32),
        direction=-_towards_sun(),
    )


def _towards_sun() -> FloatArray:
    flat = math.cos(SUN_ELEVATION)
    x, z = flat * math.sin(SUN_AZIMUTH), flat * math.cos(SUN_AZIMUTH)
    return np.array([x, math.sin(SUN_ELEVATION), z], np.float32)


BRIGHT_SUN = 32.0
"""lux, five stops over what exposure 0 is made for: the file means photometric units."""


def fixed_exposure_ev(scene: Scene) -> float:
    """The exposure for a scene that states none, in EV.

    A white surface facing the brightest sun gets a radiance of 1. Suns up to `BRIGHT_SUN` and
    scenes without one stay at 0.
    """
    brightest = _brightest_sun(scene)
    if brightest <= BRIGHT_SUN:
        return 0.0
    darkest = float(SETTINGS["exposure"].lo or 0.0)
    return max(round(-math.log2(brightest / math.pi), 1), darkest)


def note_exposure(scene: Scene, exposure: float) -> None:
    """Say in the notes that `fixed_exposure_ev` chose the exposure, and how to choose another."""
    chosen = f"a sun of {_brightest_sun(scene):.0f} lux: exposure {exposure:g} EV"
    scene.notes.append(f"{scene.path}: {chosen}; --set exposure=EV changes it")


def _brightest_sun(scene: Scene) -> float:
    suns = [light for light in scene.lights if light.kind == "directional"]
    return max((float(sun.strength.max()) for sun in suns), default=0.0)
