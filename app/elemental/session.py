"""What every door does before the first frame: open the scene, settle settings and camera.

All of it raises InputError before anything is rendered or written.
"""

from __future__ import annotations

import difflib
import math
import os
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from elemental.core import transforms
from elemental.core.errors import InputError, named_by
from elemental.core.files import check_writable
from elemental.core.images import read_environment
from elemental.core.paths import named_file
from elemental.gpu.device import Device
from elemental.scene.camera_path import camera_at
from elemental.scene.defaults import (
    EMISSION_GATHERS,
    add_default_lights,
    fixed_exposure_ev,
    is_lit_by_emission_only,
    is_unlit,
    note_emission_only,
    note_exposure,
)
from elemental.scene.evaluate import placed_camera
from elemental.scene.image_sun import with_sun
from elemental.scene.load import load_scene
from elemental.scene.model import Camera, CameraPath, Environment, Scene, framing_camera
from elemental.scene.named_files import check_named, seen_from_here
from elemental.scene.sky_sun import note_sun
from elemental.settings import Settings

DEFAULT_SCENE = "atrium"
ANIMATION = "scene.animation"
"""The one setting that a scene is read by."""
FIXED_EXPOSURE = {"eye_adaptation.min_brightness": 1.0, "eye_adaptation.max_brightness": 1.0}
"""Settings of a scene whose exposure is known, by its file or by its sun's unit: the eye would undo
it. The file's own settings stand over these."""
NAMES_TOLD = 24
"""How many names a refusal lists: every view, and the cameras of most scenes."""
EYE_NEAR = 1e-2
"""Near plane of a camera by --eye, at most, as a part of the way to --target: a small thing in a
large scene is not cut away [inferred]."""

Point = tuple[float, float, float]


@dataclass(frozen=True)
class Stage:
    """An opened scene with the settings and the camera that a door asked for.

    ``path`` is the scene's camera path, None where it has none or a fixed camera was asked for.
    """

    scene: Scene
    settings: Settings
    camera: Camera
    path: CameraPath | None

    @property
    def camera_moves(self) -> bool:
        """Whether scene time moves the camera."""
        return self.path is not None or self.camera.node >= 0

    def camera_at(self, time_s: float) -> Camera:
        """The camera of the frame at ``time_s`` seconds of scene time."""
        if self.path is not None:
            return camera_at(self.path, time_s)
        return placed_camera(self.scene, self.camera, time_s)


def open_scene(name: str | None, assignments: Iterable[str]) -> tuple[Scene, Settings]:
    """The scene and its settings: defaults, under the scene file's, under ``key=value`` texts."""
    texts = tuple(assignments)
    asked = Settings.parse(texts)  # refuse bad words before a large file is read
    asked_keys = {text.partition("=")[0].strip() for text in texts}
    scene = load_scene(
        DEFAULT_SCENE if name is None else name,
        default_lights=False,
        animation=asked[ANIMATION] if ANIMATION in asked_keys else None,
    )
    named = {key: seen_from_here(key, asked[key]) for key in asked_keys}
    settings = own_settings(scene).replace(named, "--set")
    for key, value in named.items():
        check_named(key, value, scene.folder, "--set", key, str(asked[key]))
    if scene.exposure_ev is None and settings["exposure"] == fixed_exposure_ev(scene) != 0.0:
        note_exposure(scene, settings["exposure"])
    if settings["sky.image"]:
        file, field, name = "--set", "sky.image", asked["sky.image"]
        if field not in asked_keys:
            file, field, name = str(scene.path), "settings.sky.image", settings["sky.image"]
        with named_by(file, field, name):
            radiance = read_environment(named_file(settings["sky.image"], scene.folder))
        scene.environment = with_sun(Environment(radiance, np.ones(3, np.float32), 1.0))
    asked_lights = settings["scene.default_lights"]
    if asked_lights == "on" or (asked_lights == "auto" and is_unlit(scene)):
        add_default_lights(scene)
    note_emission_only(scene)
    note_sun(scene, settings)
    return scene, settings


def own_settings(scene: Scene) -> Settings:
    """The settings by the scene's file alone, without ``--set``. Raises InputError."""
    exposure = fixed_exposure_ev(scene) if scene.exposure_ev is None else scene.exposure_ev
    known = scene.exposure_ev is not None or exposure != 0.0
    gathers = {"gi.bounces": EMISSION_GATHERS} if is_lit_by_emission_only(scene) else {}
    fixed = FIXED_EXPOSURE if known else {}
    given = {"exposure": exposure, **fixed, **gathers, **scene.settings}
    return Settings().replace(given, str(scene.path))


@dataclass(frozen=True)
class Viewpoint:
    """Where the command line looks from; None leaves each to the scene's camera."""

    camera: str | None = None
    eye: Point | None = None
    target: Point | None = None
    fov_deg: float | None = None


def set_stage(
    name: str | None, assignments: Iterable[str], viewpoint: Viewpoint, size: tuple[int, int]
) -> Stage:
    """``open_scene`` and ``choose_camera`` for a picture of ``size`` pixels."""
    scene, settings = open_scene(name, assignments)
    camera = choose_camera(scene, viewpoint, size[0] / size[1])
    path = scene.camera_path if viewpoint.camera is None and viewpoint.eye is None else None
    if path is not None and viewpoint.fov_deg is not None:
        path = replace(path, fov_y=camera.fov_y)
    return Stage(scene, settings, camera, path)


def headless_device() -> Device:
    """A device without a window. Raises InputError where the machine has no OpenGL 4.3."""
    try:
        return Device.headless()
    except RuntimeError as error:
        raise InputError("", "", str(error)) from error


def choose_camera(scene: Scene, viewpoint: Viewpoint, aspect: float) -> Camera:
    """The camera that a viewpoint names. Raises InputError for one that can't be."""
    camera = scene.default_camera(aspect)
    if viewpoint.camera is not None:
        named = {camera.name: camera for camera in reversed(scene.cameras)}
        camera = named[known_name("--camera", viewpoint.camera, list(named), str(scene.path))]
    if viewpoint.eye is not None or viewpoint.target is not None:
        free = framing_camera(*scene.bounds(), aspect)  # clips by the scene's size, not by a file's
        world_from_view, distance = _look(viewpoint)
        camera = replace(
            free,
            name="--eye",
            world_from_view=world_from_view,
            fov_y=camera.fov_y,
            near=min(free.near, EYE_NEAR * distance),
        )
    if viewpoint.fov_deg is not None:
        camera = replace(camera, fov_y=math.radians(viewpoint.fov_deg))
    return camera


def _look(viewpoint: Viewpoint) -> tuple[transforms.Matrix, float]:
    """(world_from_view, metres from the eye to the target)."""
    if viewpoint.camera is not None:
        raise InputError("--eye", "", "not together with --camera")
    if viewpoint.eye is None or viewpoint.target is None:
        raise InputError("--eye", "", "needs --target, and --target needs --eye")
    try:
        world_from_view = transforms.inverse(transforms.look_at(viewpoint.eye, viewpoint.target))
    except ValueError:
        raise InputError("--target", "", "is the same point as --eye") from None
    return world_from_view, math.dist(viewpoint.eye, viewpoint.target)


def known_name(flag: str, name: str, names: Sequence[str], file: str = "") -> str:
    """``name`` if it is among ``names``; else InputError with the nearest one."""
    if name in names:
        return name
    nearest = difflib.get_close_matches(name, names, n=1, cutoff=0.6)
    known = ", ".join(names[:NAMES_TOLD]) + (", …" if len(names) > NAMES_TOLD else "")
    reason = f"no such name as {name!r}; "
    reason += f"did you mean {nearest[0]!r}?" if nearest else f"known: {known or 'none'}"
    raise InputError(file, flag, reason) if file else InputError(flag, "", reason)


def check_output(flag: str, path: Path, suffixes: tuple[str, ...]) -> None:
    """Refuse a file that can't be written or has another suffix, before work is spent on it."""
    if path.suffix.lower() not in suffixes:
        raise InputError(flag, str(path), f"the name must end in {' or '.join(suffixes)}")
    try:
        if path.is_dir():
            raise InputError(flag, str(path), "is a folder")
        if not path.parent.is_dir():
            raise InputError(flag, str(path), f"the folder {path.parent} does not exist")
        check_writable(path)
    except OSError as error:
        raise InputError(flag, str(path), f"can't be written ({error.strerror})") from error
    if not os.access(path.parent, os.W_OK | os.X_OK):
        raise InputError(flag, str(path), f"the folder {path.parent} can't be written")


FRAME_NUMBER = re.compile(r"%0?([0-9]{0,2})d")
WIDER_NUMBER = re.compile(r"%[0-9]{3,}d")
OTHER_CONVERSION = re.compile(r"%[-+#0-9]*(?:\.[0-9]+)?[diouxXeEfFgGaAcs](?=\.|$)")
"""Of printf, at the end of a name or of a part before a dot; 100% a.png and 5%a_1.png are names."""


def frame_file(pattern: Path, frame: int) -> Path:
    """``out.%04d.png`` for frame 7 is ``out.0007.png``; a name without a pattern is itself.

    Raises InputError for a number wider than two digits can say, for what looks like a pattern but
    is none, and for a path without a name.
    """
    if not pattern.name:
        raise InputError("-o", str(pattern), "is a folder")
    rest = FRAME_NUMBER.sub("_", pattern.name)
    wider, other = WIDER_NUMBER.search(rest), OTHER_CONVERSION.search(rest)
    if wider is not None:
        raise InputError("-o", str(pattern), f"{wider[0]!r} is wider than 99 digits")
    if other is not None:
        raise InputError("-o", str(pattern), f"{other[0]!r} is no frame number; %d or %04d is")
    return pattern.with_name(FRAME_NUMBER.sub(lambda m: f"{frame:0{m[1] or 1}d}", pattern.name))
