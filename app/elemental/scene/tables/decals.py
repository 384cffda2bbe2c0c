"""The decals of a scene file."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field, model_validator

from elemental.scene.tables.base import Name, Number, Table, Vec3

Length = Annotated[float, Field(ge=1e-4, le=1e6)]
Angle = Annotated[float, Field(ge=0.0, le=180.0)]
LEAST_SINE = 1e-3
"""Of the angle between `direction` and `up`, which tells where a picture's top is."""


class DecalTable(Table):
    name: Name | None = None
    position: Vec3
    direction: Vec3
    up: Vec3 = [0.0, 1.0, 0.0]
    size: Annotated[list[Length], Field(min_length=3, max_length=3)]
    opacity: Annotated[float, Field(ge=0.0, le=1.0)] = 1.0
    order: Annotated[int, Field(ge=-1000, le=1000)] = 0
    fade_deg: Annotated[list[Angle], Field(min_length=2, max_length=2)] = [60.0, 80.0]
    channels: Annotated[
        list[Literal["color", "normal", "roughness", "emission"]], Field(min_length=1)
    ] = ["color", "normal", "roughness", "emission"]
    shader: Name | None = None
    parameters: dict[str, Any] = {}

    @model_validator(mode="after")
    def _is_a_box(self) -> DecalTable:
        if not any(self.direction):
            raise ValueError("direction has length 0")
        if sine_between(self.direction, self.up) < LEAST_SINE:
            raise ValueError("up is along direction")
        if self.fade_deg[0] > self.fade_deg[1]:
            raise ValueError("fade_deg does not increase")
        return self


def sine_between(a: list[Number], b: list[Number]) -> float:
    """Of the angle between two vectors, 0 if one has no length."""
    product = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    squared = sum(x * x for x in a) * sum(x * x for x in b)
    return float((sum(x * x for x in product) / squared) ** 0.5) if squared > 0.0 else 0.0
