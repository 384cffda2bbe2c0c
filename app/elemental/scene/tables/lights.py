"""Lights and surroundings of a scene file."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator

from elemental.scene.tables.base import (
    Color,
    HalfAngle,
    Name,
    NonNegative,
    Positive,
    Table,
    Vec3,
)


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
