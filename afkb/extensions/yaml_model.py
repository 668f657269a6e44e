"""What an extension in YAML may say: the keys, their types, and which may be left out."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field

Pair = Annotated[list[float], Field(min_length=2, max_length=2)]
"""Least and greatest typical value, or mean and standard deviation, in the unit of the key."""
OpenPair = Annotated[list[float | None], Field(min_length=2, max_length=2)]
"""Lower and upper limit; `null` where there is none."""
Four = Annotated[list[float], Field(min_length=4, max_length=4)]
Word = Annotated[str, Field(min_length=1, pattern=r"^[^|\s]+$")]
"""A name; nothing in it may part it in two."""
Text = Annotated[str, Field(min_length=1)]
IRI = r"^[A-Za-z][A-Za-z0-9+.-]*:[^\s<>\"{}|\\^`]+[#/]$"
Status = Literal["stated", "published taxonomy", "taken from data", "recalled", "proposed"]


class _Strict(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False)


class Entry(_Strict):
    """What every entry may say; the label is made from the name, the status is `proposed`."""

    label: Text | None = None
    definition: Text | None = None
    example: Text | None = None
    note: Text | None = None
    status: Status | None = None
    source: Text | None = None


class Category(Entry):
    """A kind of thing. Needed: what it is a kind of, and its three extents."""

    broader: Word
    length_m: Pair
    width_m: Pair
    height_m: Pair
    top_m: Pair | None = None
    mass_kg: Pair | None = None
    scale: Word | None = None
    stands_on: Literal["Floor", "Support", "Wall", "Structure", "Anything"] | None = None
    moved: Literal["Fixed", "Rarely", "Often", "Carried"] | None = None
    matching_weight: float | None = None
    expected_number: float | None = None
    shape: Word | None = None
    materials: list[Word] = []
    traits: list[Word] = []
    afbits: list[Text] = []


Subject = Literal["body", "surface", "opening", "upright", "part", "gap"]
Subjects = Annotated[list[Subject], BeforeValidator(lambda v: [v] if isinstance(v, str) else v)]
"""One kind of thing, or several."""


class Feature(Entry):
    """An affordance, and the fuzzy ranges of the measures by which a detector grounds it.

    `grounded_on`: what affords it, if its measures fit; then the detector `grounded` reports it.
    """

    kind: Literal["structural", "material", "grasp"]
    definition: Text
    grounding: Text | None = None
    grounding_status: Status | None = None
    observability: Text | None = None
    broader: Word | None = None
    examples: list[Text] = []
    parameters: dict[Word, Four] = {}
    grounded_on: Subjects | None = None
    grounded_by: Literal["detector", "measures", "weak measures", "nothing"] | None = None
    grounding_strength: float | None = None
    grounding_reason: Text | None = None


class Measure(Entry):
    """What a detector of one's own measures, for the fuzzy ranges of features."""

    definition: Text
    measure_name: Annotated[str, Field(pattern=r"^[a-z][a-z0-9_]*$")]
    measure_of: Subjects
    measured_in: Text | None = None
    primitive: Text | None = None


class _Relationship(Entry):
    strength: float
    distance_m: Pair | None = None
    size_m: Pair
    predicted_scale: Word | None = None


class Dual(_Relationship):
    """One direction of a pair of affordances: what is seen predicts what is not."""

    evidence: Word
    predicted: Word
    relation: Literal["below", "on", "near"]
    evidence_bottom_m: float | None = None


class CoOccurrence(_Relationship):
    """The same affordance nearby: between two evidence classes, or between two categories."""

    feature: Word
    evidence_class: Word | None = None
    predicted_class: Word | None = None
    evidence_category: Word | None = None
    predicted_category: Word | None = None


class EvidenceClass(Entry):
    """An affordance at a size and height, which is counted to tell rooms apart.

    `counts`: how many a room holds on average; `elsewhere`: how many any other room does.
    """

    feature: Word
    length_m: OpenPair | None = None
    width_m: OpenPair | None = None
    top_m: OpenPair | None = None
    dispersion: float | None = None
    counts: dict[Word, float] = {}
    elsewhere: Annotated[float, Field(gt=0)] | None = None


class Room(Entry):
    """A kind of room; `holds`: how many of an evidence class it holds on average."""

    definition: Text
    expected_number: float | None = None
    holds: dict[Word, float] = {}


class Parameter(Entry):
    """A number with a name, as a plugin may read it."""

    value: float


class Extension(_Strict):
    """A whole file."""

    extension: Annotated[str, Field(pattern=r"^[A-Za-z][A-Za-z0-9_-]*$")]
    iri: Annotated[str, Field(pattern=IRI)] | None = None
    label: Text | None = None
    definition: Text | None = None
    license: Annotated[str, Field(pattern=r"^https?://[^\s<>\"]+$")] | None = None
    status: Status | None = None
    source: Text | None = None
    categories: dict[str, Category] = {}
    afbits: list[Text] = []
    features: dict[str, Feature] = {}
    duals: dict[str, Dual] = {}
    co_occurrences: dict[str, CoOccurrence] = {}
    evidence_classes: dict[str, EvidenceClass] = {}
    rooms: dict[str, Room] = {}
    parameters: dict[str, Parameter] = {}
    measures: dict[str, Measure] = {}
    groups: dict[str, Entry] = {}
    shapes: dict[str, Entry] = {}
    materials: dict[str, Entry] = {}
    traits: dict[str, Entry] = {}
    parts: dict[str, Entry] = {}
    poses: dict[str, Entry] = {}
    homes: list[Text] = []


SECTIONS: dict[str, type[Entry]] = {
    "categories": Category,
    "measures": Measure,
    "features": Feature,
    "duals": Dual,
    "co_occurrences": CoOccurrence,
    "evidence_classes": EvidenceClass,
    "rooms": Room,
    "parameters": Parameter,
    "groups": Entry,
    "shapes": Entry,
    "materials": Entry,
    "traits": Entry,
    "parts": Entry,
    "poses": Entry,
}
"""Section to what its entries are."""
