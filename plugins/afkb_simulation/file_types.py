"""What single values of a world file may be."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import AfterValidator, BaseModel, ConfigDict, Field

Name = Annotated[str, Field(pattern=r"^[A-Za-z][A-Za-z0-9_-]*$")]
Category = Annotated[str, Field(pattern=r"^[A-Z][A-Za-z0-9]*$")]
Positive = Annotated[float, Field(gt=0, le=100)]
NotNegative = Annotated[float, Field(ge=0, le=100)]
Coordinate = Annotated[float, Field(ge=-200, le=200)]
Degrees = Annotated[float, Field(ge=-3600, le=3600)]
XY = tuple[Coordinate, Coordinate]
Probability = Annotated[float, Field(ge=0, le=1)]


def _ordered(limits: tuple[float, float]) -> tuple[float, float]:
    if limits[0] >= limits[1]:
        raise ValueError(f"nearest {limits[0]} is not below farthest {limits[1]}; swap them")
    return limits


Limits = Annotated[tuple[NotNegative, Positive], AfterValidator(_ordered)]

FileName = Annotated[str, Field(min_length=1)]
Up = Literal["y", "z"]


class Strict(BaseModel):
    """Unknown keys, words for numbers, and numbers that are not finite are refused."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False)
