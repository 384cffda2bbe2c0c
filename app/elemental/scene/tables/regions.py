"""Boxes of a scene file whose voxels are finer or coarser."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, model_validator

from elemental.scene.tables.base import Table, Vec3


class RegionTable(Table):
    min: Vec3
    max: Vec3
    level_offset: Annotated[int, Field(ge=-2, le=2)]

    @model_validator(mode="after")
    def _is_a_box(self) -> RegionTable:
        if any(low >= high for low, high in zip(self.min, self.max, strict=True)):
            raise ValueError("max is not greater than min on every axis")
        return self
