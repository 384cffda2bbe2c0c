"""Motions of models and lights in a scene file."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator

from elemental.scene.tables.base import (
    Name,
    NonNegative,
    Number,
    Table,
    Vec3,
    check_increasing,
)

SHORTEST_PERIOD_S = 1e-3


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
        check_increasing([key.time for key in self.keys or ()])
        return self
