"""What the tables of a scene file have in common: number ranges and strictness."""

from __future__ import annotations

from itertools import pairwise
from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

Number = Annotated[float, Field(ge=-1e12, le=1e12)]
Positive = Annotated[float, Field(gt=0.0, le=1e12)]
NonNegative = Annotated[float, Field(ge=0.0, le=1e12)]
Vec2 = Annotated[list[Number], Field(min_length=2, max_length=2)]
Vec3 = Annotated[list[Number], Field(min_length=3, max_length=3)]
Color = Annotated[list[NonNegative], Field(min_length=3, max_length=3)]
HalfAngle = Annotated[float, Field(ge=0.01, le=90.0)]
FieldOfView = Annotated[float, Field(ge=0.01, le=179.0)]
Name = Annotated[str, Field(min_length=1, max_length=100, pattern=r"^[^\x00-\x1f\x7f]*$")]


class Table(BaseModel):
    """A table whose keys are all known and of the very type that is asked for."""

    model_config = ConfigDict(
        extra="forbid", strict=True, allow_inf_nan=False, frozen=True, hide_input_in_errors=True
    )


def check_increasing(times: list[float]) -> None:
    """Raises ValueError where a key is no later than the one before."""
    if any(b <= a for a, b in pairwise(times)):
        raise ValueError("the keys' times do not increase")
