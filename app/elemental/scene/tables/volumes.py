"""Post-process volumes of a scene file."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field, model_validator

from elemental.scene.tables.base import Name, NonNegative, Positive, Table, Vec3
from elemental.scene.volumes import BLEND_RADIUS_M, BLEND_WEIGHT, PRIORITY

Size = Annotated[list[Positive], Field(min_length=3, max_length=3)]


class VolumeTable(Table):
    name: Name | None = None
    shape: Literal["box", "sphere"] = "box"
    center: Vec3 = [0.0, 0.0, 0.0]
    rotation_deg: Vec3 = [0.0, 0.0, 0.0]
    size: Size | None = None
    radius: Positive | None = None
    priority: NonNegative = PRIORITY
    blend_radius: NonNegative = BLEND_RADIUS_M
    blend_weight: Annotated[float, Field(ge=0.0, le=1.0)] = BLEND_WEIGHT
    enabled: bool = True
    unbound: bool = False
    settings: dict[str, Any] = {}

    @model_validator(mode="after")
    def _has_its_measure(self) -> VolumeTable:
        if self.shape == "box" and self.radius is not None:
            raise ValueError("a box has a size, not a radius")
        if self.shape == "sphere" and self.size is not None:
            raise ValueError("a sphere has a radius, not a size")
        return self
