"""Lights and surroundings of a scene file."""

from __future__ import annotations

from typing import Annotated, Literal, TypeAlias

from pydantic import Field, model_validator

from elemental.scene.blackbody import COOLEST, HOTTEST
from elemental.scene.tables.base import (
    Color,
    HalfAngle,
    Name,
    NonNegative,
    Positive,
    Table,
    Vec2,
    Vec3,
)

RollAngle: TypeAlias = Annotated[float, Field(ge=-360.0, le=360.0)]


class LightTable(Table):
    kind: Literal["directional", "point", "spot"]
    name: Name | None = None
    position: Vec3 | None = None
    direction: Vec3 | None = None
    color: Color = [1.0, 1.0, 1.0]
    temperature: Annotated[float, Field(ge=COOLEST, le=HOTTEST)] | None = None
    intensity: NonNegative | None = None
    lumen: NonNegative | None = None
    ies: Name | None = None
    roll_deg: RollAngle = 0.0
    range: Positive | None = None
    inner_angle_deg: Annotated[float, Field(ge=0.0, le=90.0)] = 0.0
    outer_angle_deg: HalfAngle = 45.0
    source_radius: NonNegative = 0.0
    casts_shadow: bool = True
    mask: Name | None = None
    mask_size: Positive = 1.0
    mask_scroll: Vec2 = [0.0, 0.0]

    @model_validator(mode="after")
    def _has_its_place(self) -> LightTable:
        wanted = {"directional": ("direction",), "point": ("position",)}
        for key in wanted.get(self.kind, ("position", "direction")):
            if getattr(self, key) is None:
                raise ValueError(f"a {self.kind} light needs a {key}")
        if self.direction is not None and not any(self.direction):
            raise ValueError("direction has length 0")
        for key in ("lumen", "ies"):
            if self.kind == "directional" and getattr(self, key) is not None:
                raise ValueError(f"a directional light has no {key}; its intensity is in lux")
        if self.kind == "point" and self.mask is not None:
            raise ValueError("a point light has no mask; a spot or directional light may have one")
        if self.lumen is not None and self.intensity is not None:
            raise ValueError("intensity and lumen say the same thing; give one")
        if self.kind == "spot" and self.inner_angle_deg > self.outer_angle_deg:
            raise ValueError("inner_angle_deg is greater than outer_angle_deg")
        return self


class LightChangeTable(Table):
    """What becomes of a light that a model brings along."""

    name: Name
    position: Vec3 | None = None
    direction: Vec3 | None = None
    color: Color | None = None
    temperature: Annotated[float, Field(ge=COOLEST, le=HOTTEST)] | None = None
    intensity: NonNegative | None = None
    range: Positive | None = None
    inner_angle_deg: Annotated[float, Field(ge=0.0, le=90.0)] | None = None
    outer_angle_deg: HalfAngle | None = None
    source_radius: NonNegative | None = None
    casts_shadow: bool | None = None
    roll_deg: RollAngle | None = None
    mask: Name | None = None
    mask_size: Positive | None = None
    mask_scroll: Vec2 | None = None


class EnvironmentTable(Table):
    file: Name | None = None
    tint: Color = [1.0, 1.0, 1.0]
    intensity: NonNegative = 1.0
