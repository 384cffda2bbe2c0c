"""Cameras of a scene file, and their path."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, model_validator

from elemental.scene.tables.base import (
    FieldOfView,
    Name,
    NonNegative,
    Positive,
    Table,
    Vec3,
    check_increasing,
)


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
        check_increasing([key.time for key in self.keys])
        return self
