"""P(purpose of a room | its doors, walls, area and shape), by figures of homes.

The paper's baseline [11] tells rooms by "number of doors, number and size of walls etc." (§II.F).
Its figures are in `figures.csv`, each with its source.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from afkb.csv_rows import read_rows
from afkb.flow import TopologicalMap
from afkb.inference import network_of
from afkb.knowledge import UNKNOWN_ROOM, AfNet
from afkb_room_shape.shape import Shape, shape_of

FIGURES = Path(__file__).with_name("figures.csv")
AREA_SPREAD = 0.6
"""Standard deviation of the logarithm of a room's area: from half to twice the mean (proposed).

The figures are of large new homes; flats of half their size are as common.
"""
ELONGATION_SPREAD = 0.35
"""Standard deviation of the logarithm of a room's elongation (proposed)."""
WALLS_SPREAD = 0.5
"""Standard deviation of the logarithm of the number of walls (proposed): maps show half-walls."""
LEAST_WALLS = 3
"""No room has fewer; a map that shows fewer has not seen them."""
_COLUMNS = ("room", "area_m2", "doors", "elongation", "walls", "source")


@dataclass(frozen=True, slots=True)
class RoomFigures:
    """Of a room category: mean area (m²), mean numbers of doors and walls, typical elongation."""

    area_m2: float
    doors: float
    elongation: float
    walls: float

    def log_likelihood(self, shape: Shape) -> float:
        """Log P(shape | category): doors are Poisson, all else is log-normal."""
        return (
            _log_normal(shape.area_m2, self.area_m2, AREA_SPREAD)
            + _log_normal(shape.elongation, self.elongation, ELONGATION_SPREAD)
            + _log_poisson(shape.doors, self.doors)
            + _log_normal(max(shape.walls, LEAST_WALLS), self.walls, WALLS_SPREAD)
        )


class ShapeClassifier:
    """Tells what rooms are for by doors and walls.

    The prior is the ontology's: how many rooms of each category a home has.
    """

    name = "doors-and-walls"

    def __init__(self, knowledge_base: AfNet, figures: Path = FIGURES) -> None:
        self._knowledge_base = knowledge_base
        self._figures = {
            row["room"]: RoomFigures(
                *(row.number(name) for name in ("area_m2", "doors", "elongation", "walls"))
            )
            for row in read_rows(figures, _COLUMNS)
        }

    def beliefs(self, topological_map: TopologicalMap) -> Mapping[str, Mapping[str, float]]:
        """Room id to posterior, of every room that has an outline."""
        shapes = {r.id: shape_of(r, topological_map) for r in topological_map.rooms}
        return {id_: self.posterior(shape) for id_, shape in shapes.items() if shape is not None}

    def posterior(self, shape: Shape) -> dict[str, float]:
        """P(room category | shape), summing to 1; `UnknownRoom` is as likely as rooms on average.

        So is a category that has no figures, as one that an extension brings.
        """
        prior = network_of(self._knowledge_base).room_posterior({})
        told = {r: f.log_likelihood(shape) for r, f in self._figures.items() if r in prior}
        weights = [prior[room] for room in told]
        best = max(told.values(), default=0.0)
        likely = {room: math.exp(value - best) for room, value in told.items()}
        mean = sum(map(operator.mul, weights, likely.values())) / sum(weights) if told else 1.0
        joint = {room: p * likely.get(room, mean) for room, p in prior.items()}
        total = math.fsum(joint.values())
        known = {room: p / total for room, p in joint.items()}
        return {UNKNOWN_ROOM: 0.0} | known


def _log_normal(value: float, typical: float, spread: float) -> float:
    return -0.5 * (math.log(value / typical) / spread) ** 2 - math.log(value)


def _log_poisson(number: int, mean: float) -> float:
    return number * math.log(mean) - mean - math.lgamma(number + 1)
