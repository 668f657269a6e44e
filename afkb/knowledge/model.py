"""What the knowledge base knows, as frozen plain data; units are SI, probabilities 0 to 1.

Every item has its `name` (IRI fragment), `iri`, `label`, `status` (stated, published taxonomy,
taken from data, recalled, proposed), `source` and `place` (file and line), so that a conclusion can
cite its axiom.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from afkb.ontology.names import BY_DETECTOR, BY_MEASURES
from afkb.ontology.notation import write_afbit

Range = tuple[float, float]
"""Lower and upper end, in the unit that the field's name tells."""


@dataclass(frozen=True, slots=True)
class Trapezoid:
    """Fuzzy range of a measure: 0 up to `z1`, 1 from `n1` to `n2`, 0 from `z2`."""

    z1: float
    n1: float
    n2: float
    z2: float

    def __call__(self, value: float) -> float:
        """Membership of the value, 0 to 1.

        >>> Trapezoid(0.0, 1.0, 2.0, 4.0)(3.0)
        0.5
        """
        if not self.z1 < value < self.z2:
            return 0.0
        if value < self.n1:
            return (value - self.z1) / (self.n1 - self.z1)
        return 1.0 if value <= self.n2 else (self.z2 - value) / (self.z2 - self.n2)


@dataclass(frozen=True, slots=True)
class Statement:
    """What every item of the ontology has."""

    name: str
    iri: str
    label: str
    status: str
    source: str
    place: str


@dataclass(frozen=True, slots=True)
class Feature(Statement):
    """An affordance feature (paper §II.A) and how detectors ground it.

    `kind`: structural, material or grasp. `broader`: feature of which this is a narrower kind.
    `parameters`: fuzzy ranges of measures, keyed by measure and unit (`area_m2`, `height_m`).
    `grounded_by`: how detectors come to it, one or more of
    `afkb.ontology.names.GROUNDED_BY`; `grounded_on`: what affords it. `grounding_strength`: its
    probability where every measure fits fully; `grounding_reason`: why it is weak, or none is.
    """

    kind: str
    definition: str
    grounding: str
    broader: str | None = None
    parameters: Mapping[str, Trapezoid] = field(default_factory=dict)
    grounded_by: tuple[str, ...] = ()
    grounded_on: tuple[str, ...] = ()
    grounding_strength: float = 0.0
    grounding_reason: str = ""

    @property
    def by_measures_alone(self) -> bool:
        """Whether nothing but measures tells of it: no detector of its own, no prior."""
        return self.grounded_by == (BY_MEASURES,)

    @property
    def is_weak(self) -> bool:
        """Whether what grounds it is a hint and no more: never evidence against anything."""
        return bool(self.grounded_by) and not {BY_DETECTOR, BY_MEASURES} & set(self.grounded_by)


@dataclass(frozen=True, slots=True)
class Measure(Statement):
    """What a fuzzy range may be of: `measure_name` as ranges name it, its unit, and what has it."""

    measure_name: str
    measured_in: str
    measure_of: tuple[str, ...]
    primitive: str
    definition: str


@dataclass(frozen=True, slots=True)
class Scale(Statement):
    """A class of size by the largest extent, m: from the lower limit up to below the upper one."""

    extent_m: Range


@dataclass(frozen=True, slots=True)
class Category(Statement):
    """A kind of thing with its typical sizes and afbits.

    - `length_m`, `width_m`: longer and shorter horizontal extent; `height_m`: own vertical extent.
    - `top_height_m`: of its main upward surface above the floor, None where it is put on things.
    - `underside_m`: typical height of its underside above the floor, None where nobody said.
    - `mass_kg`: typical range, None where it makes no sense.
    - `afbits`: feature name to strength, of the whole thing or of a part that stands for it, as
      the seat does for a chair (paper §II.A). `AfNet.afbits` has all, part by part.
    - `movability`: `Static` or `Dynamic`; `matching_weight`: when maps are matched (§II.D.i).
    - `moved`: `Fixed`, `RarelyMoved`, `OftenMoved` or `Carried`, None where nobody said.
    - `shape`, `materials`, `traits`: what rules make afbits from.
    - `report_rates`: feature name to how often a detector reports it on such a thing, where that is
      not the afbit's strength: a lid hides a concavity.
    - `expected_number`: how many a home has on average.
    """

    broader: str | None
    entity_class: str | None
    scale: str
    stands_on: str
    length_m: Range
    width_m: Range
    height_m: Range
    top_height_m: Range | None
    movability: str
    matching_weight: float
    expected_number: float
    afbits: Mapping[str, float]
    definition: str = ""
    underside_m: Range | None = None
    mass_kg: Range | None = None
    moved: str | None = None
    shape: str | None = None
    materials: tuple[str, ...] = ()
    traits: tuple[str, ...] = ()
    report_rates: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Afbit(Statement):
    """One statement: a category, or a part of it, has an affordance (paper §II.A).

    `part`: by which it affords it, None for the whole. `pose` and `scale` are the typical ones,
    None where nobody said. `rules` made it. `independent_sources`: public tables, and the paper,
    that speak for it; `reviewed`: whether a person judged it right.
    """

    category: str
    feature: str
    strength: float
    part: str | None = None
    pose: str | None = None
    scale: str | None = None
    rules: tuple[str, ...] = ()
    independent_sources: int = 0
    reviewed: bool = False

    @property
    def notation(self) -> str:
        """The statement in one line, as in `Mug > ContainAbility = 0.95`."""
        cells = {
            name: str(value)
            for name in ("category", "part", "feature", "pose", "scale", "strength")
            if (value := getattr(self, name)) is not None
        }
        return write_afbit(cells)


@dataclass(frozen=True, slots=True)
class RoomCategory(Statement):
    """What a room is for: number of such rooms in a home, mean count per evidence class (§II.F)."""

    expected_number: float
    expected_counts: Mapping[str, float]


@dataclass(frozen=True, slots=True)
class EvidenceClass(Statement):
    """An affordance at a size and height (paper §II.F); ranges are half-open, in metres."""

    feature: str
    length_m: Range
    width_m: Range
    top_height_m: Range
    dispersion: float

    @property
    def least_area_m2(self) -> float:
        """Area of the smallest thing of the class: of two that hold, the larger is the closer."""
        return max(self.length_m[0], 0.0) * max(self.width_m[0], 0.0)

    def holds(self, size_xyz: tuple[float, float, float], top_height_m: float) -> bool:
        """Whether a thing of that size (m) with its top at that height (m) is of the class."""
        width, length = sorted(size_xyz[:2])
        return (
            self.length_m[0] <= length < self.length_m[1]
            and self.width_m[0] <= width < self.width_m[1]
            and self.top_height_m[0] <= top_height_m < self.top_height_m[1]
        )


@dataclass(frozen=True, slots=True)
class Relationship(Statement):
    """A statement by which a seen thing predicts an unseen one with probability `strength`.

    `distance_m`: mean and standard deviation of the horizontal distance between centres.
    `size_xy_m`: typical extent of what is predicted; `predicted_scale`: its scale.
    """

    strength: float
    distance_m: Range
    size_xy_m: Range
    predicted_scale: str


@dataclass(frozen=True, slots=True)
class Dual(Relationship):
    """One direction of an affordance dual (paper §II.D.ii).

    `relation`: below, on or near. A thing whose bottom is lower than `evidence_bottom_min_m` above
    the floor predicts nothing.
    """

    evidence: str
    predicted: str
    relation: str
    evidence_bottom_min_m: float = -math.inf


@dataclass(frozen=True, slots=True)
class CoOccurrence(Relationship):
    """The same affordance at a larger scale nearby (paper §II.D.iii), or a listed pair of it.

    A rule names evidence classes; a listed pair names categories and sets the strength of the
    rules for things of its `evidence_category`.
    """

    feature: str
    evidence_class: str | None = None
    predicted_class: str | None = None
    evidence_category: str | None = None
    predicted_category: str | None = None

    @property
    def is_rule(self) -> bool:
        """Whether it predicts by itself, rather than setting the strength of a rule."""
        return self.evidence_class is not None and self.predicted_class is not None
