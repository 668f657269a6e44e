"""docs/grounding.md says of every feature what the ontology says of it."""

from __future__ import annotations

from pathlib import Path

from afkb.knowledge import AfNet, Feature
from afkb.knowledge.model import Measure

PAGE = Path(__file__).parents[2] / "docs" / "grounding.md"


def cells(*of: str) -> str:
    return "| " + " | ".join(of) + " |"


def line_of_feature(f: Feature) -> str:
    measures = ", ".join(f"`{name}`" for name in f.parameters)
    strength = f"{f.grounding_strength:g}" if f.grounding_strength else ""
    how, on = ", ".join(f.grounded_by), ", ".join(f.grounded_on)
    return cells(f"`{f.name}`", how, on, strength, measures, f.grounding_reason)


def line_of_measure(m: Measure) -> str:
    unit = "" if m.measured_in == "1" else m.measured_in
    return cells(f"`{m.measure_name}`", unit, ", ".join(m.measure_of), m.primitive, m.definition)


def tables(base: AfNet) -> list[str]:
    """The rows of the page's tables, in order."""
    order = ("structural", "material", "grasp")
    features = sorted(base.features.values(), key=lambda f: (order.index(f.kind), f.name))
    measures = sorted(base.measures.values(), key=lambda m: (m.primitive, m.measure_name))
    return [*map(line_of_feature, features), *map(line_of_measure, measures)]


def test_the_page_lists_every_feature_and_measure_as_the_ontology_has_it() -> None:
    rows = [row for row in PAGE.read_text(encoding="utf-8").splitlines() if row.startswith("| `")]
    assert rows == tables(AfNet())
