"""The parametric shapes that worlds are furnished with, by name."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

from afkb_simulation import furniture, vessels
from afkb_simulation.built import Built, Size

Build = Callable[[Size, Mapping[str, float]], Built]


@dataclass(frozen=True, slots=True)
class Shape:
    """A kind of thing: usual size (x, y, z, m), what else can be set, and how it is built."""

    build: Build
    size: Size
    parameters: Mapping[str, float] = field(default_factory=dict)


_HOLLOW = {"wall_m": 0.005}

SHAPES: Mapping[str, Shape] = MappingProxyType(
    {
        "table": Shape(furniture.table, (0.8, 1.2, 0.75)),
        "stool": Shape(furniture.table, (0.35, 0.35, 0.45)),
        "chair": Shape(furniture.chair, (0.45, 0.45, 0.9), {"seat_m": 0.45}),
        "couch": Shape(furniture.couch, (0.9, 1.9, 0.8), {"seat_m": 0.42}),
        "bed": Shape(furniture.bed, (2.0, 1.5, 0.5), {"headboard_m": 0.9}),
        "counter": Shape(furniture.counter, (0.6, 2.0, 0.92)),
        "shelf": Shape(furniture.shelf, (0.35, 0.9, 1.8), {"boards": 5}),
        "wardrobe": Shape(furniture.solid, (0.6, 1.2, 2.0)),
        "cabinet": Shape(furniture.solid, (0.45, 0.45, 0.6)),
        "bathtub": Shape(furniture.bathtub, (0.75, 1.6, 0.55), {"wall_m": 0.06}),
        "sink": Shape(furniture.sink, (0.48, 0.56, 0.85), {"wall_m": 0.03}),
        "toilet": Shape(furniture.toilet, (0.66, 0.38, 0.76)),
        "display": Shape(furniture.display, (0.2, 0.6, 0.42)),
        "mug": Shape(vessels.mug, (0.085, 0.085, 0.1), {"wall_m": 0.004}),
        "cup": Shape(vessels.straight, (0.08, 0.08, 0.09), {"wall_m": 0.003}),
        "bowl": Shape(vessels.bowl, (0.2, 0.2, 0.08), {"wall_m": 0.005}),
        "pot": Shape(vessels.straight, (0.24, 0.24, 0.16), {"wall_m": 0.004}),
        "bucket": Shape(vessels.straight, (0.28, 0.28, 0.3), _HOLLOW),
        "trash_can": Shape(vessels.straight, (0.3, 0.3, 0.45), _HOLLOW),
        "vase": Shape(vessels.bowl, (0.14, 0.14, 0.26), _HOLLOW),
        "plate": Shape(vessels.plate, (0.24, 0.24, 0.02)),
        "bottle": Shape(vessels.bottle, (0.075, 0.075, 0.28)),
        "can": Shape(vessels.cylinder, (0.067, 0.067, 0.12)),
        "canister": Shape(vessels.cylinder, (0.12, 0.12, 0.22)),
        "ball": Shape(vessels.ball, (0.2, 0.2, 0.2)),
        "cushion": Shape(vessels.ball, (0.4, 0.6, 0.14)),
        "open_box": Shape(vessels.open_carton, (0.4, 0.3, 0.25), _HOLLOW),
        "tray": Shape(vessels.open_carton, (0.3, 0.45, 0.05), _HOLLOW),
        "box": Shape(furniture.solid, (0.2, 0.3, 0.15)),
        "carton": Shape(furniture.solid, (0.07, 0.095, 0.24)),
        "block": Shape(furniture.solid, (0.2, 0.2, 0.2)),
        "book": Shape(furniture.solid, (0.16, 0.23, 0.025)),
    }
)
