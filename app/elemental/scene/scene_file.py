"""Scene files: TOML that names glTF files, lights, an environment, cameras and settings.

name = "Courtyard"                  # default: the file's name
exposure_ev = 0.5                   # stops

[[models]]                          # glTF files; their lights, cameras and animations come along
file = "courtyard/courtyard.glb"    # beside this file
name = "courtyard"                  # what motions call it; default: the file's name
translation = [0.0, 0.0, 0.0]       # m
rotation_deg = [0.0, 90.0, 0.0]     # about the x, then the y, then the z axis
scale = 1.0

[[lights]]
kind = "spot"                       # or "directional", "point"
position = [0.0, 3.0, 0.0]          # m; not for directional lights
direction = [0.0, -1.0, 0.0]        # the way the light travels; not for point lights
color = [1.0, 0.9, 0.8]             # linear
intensity = 40.0                    # lux if directional, else candela
range = 20.0                        # m; default: none
inner_angle_deg = 20.0              # half angles of a spot light
outer_angle_deg = 30.0
source_radius = 0.05                # m
casts_shadow = true

[[motions]]                         # moves one model or one of the lights above
model = "courtyard"                 # or: light = "lamp"
orbit = { center = [0.0, 1.0, 0.0], axis = [0.0, 1.0, 0.0], period = 8.0 }   # s a turn, < 0 back
spin = { axis = [0.0, 1.0, 0.0], period = 2.0 }    # about its own origin
interpolation = "linear"            # between keys; or "step", "smooth" (turns stay linear)
loop = true                         # or keep to the last key
keys = [                            # two at least; all but the time have defaults
  { time = 0.0, translation = [0.0, 0.0, 0.0] },   # m, from where it stands
  { time = 1.0, rotation_deg = [0.0, 90.0, 0.0], scale = 0.5, visible = true },   # about its origin
]

[environment]
file = "sky.hdr"                    # .hdr or .exr, equirectangular; default: constant
tint = [1.0, 1.0, 1.0]
intensity = 1.0

[[cameras]]                         # the first is the default; the models' follow
name = "door"
eye = [0.0, 1.6, 8.0]
target = [0.0, 1.5, 0.0]
up = [0.0, 1.0, 0.0]
fov_y_deg = 45.0
near = 0.05

[camera_path]
fov_y_deg = 45.0
loop = true
keys = [{ time = 0.0, eye = [0.0, 2.0, 8.0], target = [0.0, 1.0, 0.0] }]   # two at least

[[regions]]                         # voxel resolution of a box, in levels
min = [-1.0, 0.0, -1.0]
max = [1.0, 2.0, 1.0]
level_offset = 1                    # -2 (coarser) to +2 (finer)

[settings]                          # defaults for this scene, below --set
gi.resolution = 256
"""

from __future__ import annotations

import tomllib
from itertools import pairwise
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from elemental.core.errors import CombinedInputError, InputError
from elemental.core.files import read_file

Number = Annotated[float, Field(ge=-1e12, le=1e12)]
Positive = Annotated[float, Field(gt=0.0, le=1e12)]
NonNegative = Annotated[float, Field(ge=0.0, le=1e12)]
Vec3 = Annotated[list[Number], Field(min_length=3, max_length=3)]
Color = Annotated[list[NonNegative], Field(min_length=3, max_length=3)]
HalfAngle = Annotated[float, Field(gt=0.0, le=90.0)]
FieldOfView = Annotated[float, Field(ge=0.01, le=179.0)]
Name = Annotated[str, Field(min_length=1, max_length=100, pattern=r"^[^\x00-\x1f\x7f]*$")]

SHORTEST_PERIOD_S = 1e-3


class Table(BaseModel):
    model_config = ConfigDict(
        extra="forbid", strict=True, allow_inf_nan=False, frozen=True, hide_input_in_errors=True
    )


class ModelTable(Table):
    file: Name
    name: Name | None = None
    translation: Vec3 = [0.0, 0.0, 0.0]
    rotation_deg: Vec3 = [0.0, 0.0, 0.0]
    scale: Positive = 1.0


class LightTable(Table):
    kind: Literal["directional", "point", "spot"]
    name: Name | None = None
    position: Vec3 | None = None
    direction: Vec3 | None = None
    color: Color = [1.0, 1.0, 1.0]
    intensity: NonNegative = 1.0
    range: Positive | None = None
    inner_angle_deg: Annotated[float, Field(ge=0.0, le=90.0)] = 0.0
    outer_angle_deg: HalfAngle = 45.0
    source_radius: NonNegative = 0.0
    casts_shadow: bool = True

    @model_validator(mode="after")
    def _has_its_place(self) -> LightTable:
        wanted = {"directional": ("direction",), "point": ("position",)}
        for key in wanted.get(self.kind, ("position", "direction")):
            if getattr(self, key) is None:
                raise ValueError(f"a {self.kind} light needs a {key}")
        if self.direction is not None and not any(self.direction):
            raise ValueError("direction has length 0")
        if self.kind == "spot" and self.inner_angle_deg > self.outer_angle_deg:
            raise ValueError("inner_angle_deg is greater than outer_angle_deg")
        return self


class EnvironmentTable(Table):
    file: Name | None = None
    tint: Color = [1.0, 1.0, 1.0]
    intensity: NonNegative = 1.0


class CameraTable(Table):
    name: Name
    eye: Vec3
    target: Vec3
    up: Vec3 = [0.0, 1.0, 0.0]
    fov_y_deg: FieldOfView = 45.0
    near: Positive = 0.05
    far: Positive | None = None

    @model_validator(mode="after")
    def _looks_somewhere(self) -> CameraTable:
        if self.eye == self.target:
            raise ValueError("eye and target are the same point")
        if not any(self.up):
            raise ValueError("up has length 0")
        if self.far is not None and self.far <= self.near:
            raise ValueError("far is not beyond near")
        return self


class PathKeyTable(Table):
    time: NonNegative
    eye: Vec3
    target: Vec3

    @model_validator(mode="after")
    def _looks_somewhere(self) -> PathKeyTable:
        if self.eye == self.target:
            raise ValueError("eye and target are the same point")
        return self


class PathTable(Table):
    fov_y_deg: FieldOfView = 45.0
    near: Positive = 0.05
    loop: bool = False
    keys: Annotated[list[PathKeyTable], Field(min_length=2, max_length=10_000)]

    @model_validator(mode="after")
    def _goes_forward(self) -> PathTable:
        _check_increasing([key.time for key in self.keys])
        return self


def _check_increasing(times: list[float]) -> None:
    if any(b <= a for a, b in pairwise(times)):
        raise ValueError("the keys' times do not increase")


class TurnTable(Table):
    axis: Vec3 = [0.0, 1.0, 0.0]
    period: Number

    @model_validator(mode="after")
    def _turns(self) -> TurnTable:
        if not any(self.axis):
            raise ValueError("axis has length 0")
        if abs(self.period) < SHORTEST_PERIOD_S:
            raise ValueError(f"period is less than {SHORTEST_PERIOD_S:g} s")
        return self


class OrbitTable(TurnTable):
    center: Vec3


class MotionKeyTable(Table):
    time: NonNegative
    translation: Vec3 = [0.0, 0.0, 0.0]
    rotation_deg: Vec3 = [0.0, 0.0, 0.0]
    scale: NonNegative = 1.0
    visible: bool = True


class MotionTable(Table):
    model: Name | None = None
    light: Name | None = None
    orbit: OrbitTable | None = None
    spin: TurnTable | None = None
    interpolation: Literal["step", "linear", "smooth"] = "linear"
    loop: bool = True
    keys: Annotated[list[MotionKeyTable], Field(min_length=2, max_length=10_000)] | None = None

    @model_validator(mode="after")
    def _moves_something(self) -> MotionTable:
        if (self.model is None) == (self.light is None):
            raise ValueError("names either a model or a light")
        if self.orbit is None and self.spin is None and self.keys is None:
            raise ValueError("has neither keys nor an orbit nor a spin")
        _check_increasing([key.time for key in self.keys or ()])
        return self


class RegionTable(Table):
    min: Vec3
    max: Vec3
    level_offset: Annotated[int, Field(ge=-2, le=2)]

    @model_validator(mode="after")
    def _is_a_box(self) -> RegionTable:
        if any(low >= high for low, high in zip(self.min, self.max, strict=True)):
            raise ValueError("max is not greater than min on every axis")
        return self


class SceneFile(Table):
    """The whole file, checked but for what it names."""

    name: Name | None = None
    exposure_ev: Annotated[float, Field(ge=-32.0, le=32.0)] | None = None
    models: Annotated[list[ModelTable], Field(min_length=1)]
    lights: list[LightTable] = []
    motions: list[MotionTable] = []
    environment: EnvironmentTable | None = None
    cameras: list[CameraTable] = []
    camera_path: PathTable | None = None
    regions: list[RegionTable] = []
    settings: dict[str, Any] = {}

    @model_validator(mode="after")
    def _names_differ(self) -> SceneFile:
        names = [camera.name for camera in self.cameras]
        doubled = sorted({name for name in names if names.count(name) > 1})
        if doubled:
            raise ValueError(f"two cameras are named {doubled[0]!r}")
        return self


def read_scene_file(path: Path) -> SceneFile:
    """Parse and check a scene file.

    Raises InputError for a file that can't be read or is no TOML, and CombinedInputError with a
    line for each wrong, missing or unknown key.
    """
    try:
        tables = tomllib.loads(read_file(path).decode("utf-8"))
    except (ValueError, RecursionError) as error:
        raise InputError(path, "TOML", f"is broken ({error})") from error
    try:
        return SceneFile.model_validate(tables)
    except ValidationError as error:
        found = error.errors(include_url=False, include_input=False)
        reasons = [
            (_field(e["loc"]), _reason(e["type"], e["msg"], e.get("ctx", {}))) for e in found
        ]
        raise CombinedInputError(path, reasons) from error


def flat_settings(settings: dict[str, Any], prefix: str = "") -> dict[str, Any]:
    """Nested tables as dotted keys: {"gi": {"resolution": 256}} -> {"gi.resolution": 256}."""
    flat: dict[str, Any] = {}
    for key, value in settings.items():
        if isinstance(value, dict):
            flat |= flat_settings(value, f"{prefix}{key}.")
        else:
            flat[prefix + key] = value
    return flat


def _field(place: tuple[int | str, ...]) -> str:
    """("lights", 0, "kind") as lights[0].kind."""
    field = ""
    for step in place:
        field += f"[{step}]" if isinstance(step, int) else f".{step}" if field else step
    return field


def _reason(kind: str, message: str, context: dict[str, Any]) -> str:
    """pydantic's words in those of the other errors."""
    if kind == "extra_forbidden":
        return "is an unknown key"
    if kind == "missing":
        return "is missing"
    if kind == "too_short":
        return f"needs {context['min_length']} items or more, not {context['actual_length']}"
    if kind == "too_long":
        return f"needs {context['max_length']} items or fewer, not {context['actual_length']}"
    return message.removeprefix("Value error, ").replace("Input should", "should")
