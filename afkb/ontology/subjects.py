"""What is known of a category before any rule speaks: its tokens and its measures."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from afkb.csv_rows import Row
from afkb.ontology.tables import by_name

_OWN = {
    "scale": "scale", "stands_on": "stands", "moved": "moved", "shape": "shape",
    "materials": "material", "traits": "trait",
}  # fmt: skip
OWN_FAMILIES = frozenset({*_OWN.values(), "mainly", "kind"})
"""Families of tokens that come from this project's own table of categories."""


@dataclass(frozen=True, slots=True)
class Subject:
    """A category as rules see it.

    `tokens`: `family:word`, as in `trait:OpenTop` or `virtualhome:CONTAINERS`, to the place in a
    table that states it. `measures`: typical values, m and kg; the middle of a range on a
    logarithmic scale.
    """

    row: Row
    tokens: Mapping[str, str]
    measures: Mapping[str, float] = field(default_factory=dict)

    @property
    def name(self) -> str:
        """Name of the category."""
        return self.row["name"]


def read_subjects(
    categories: Iterable[Row], groups: Iterable[Row], evidence: Iterable[Row]
) -> list[Subject]:
    """The categories with their tokens: own columns, kinds by `broader`, and gathered evidence."""
    rows = by_name(categories)
    broader = {r["name"]: r.get("broader") for r in [*rows.values(), *groups]}
    gathered: dict[str, dict[str, str]] = {}
    for item in evidence:
        token = f"{item['source']}:{item['property']}"
        gathered.setdefault(item["category"], {}).setdefault(token, item["found_in"])
    for name in sorted(set(gathered) - set(rows)):
        row = next(item for item in evidence if item["category"] == name)
        raise row.error(f"category {name} is not in the table of categories; remove the row")
    return [
        Subject(row, _own_tokens(row, broader) | gathered.get(name, {}), measures_of(row))
        for name, row in rows.items()
    ]


def _own_tokens(row: Row, broader: Mapping[str, str]) -> dict[str, str]:
    words = [f"{family}:{w}" for column, family in _OWN.items() for w in row.several(column)]
    words += [f"mainly:{w}" for w in row.several("materials")[:1]]
    words += [f"kind:{name}" for name in kinds_of(row["name"], broader)]
    return dict.fromkeys(words, row.place)


def kinds_of(name: str, broader: Mapping[str, str]) -> list[str]:
    """The name and everything broader than it, nearest first; stops where a cycle closes."""
    found: list[str] = []
    while name and name not in found:
        found.append(name)
        name = broader.get(name, "")
    return found


def measures_of(row: Row) -> dict[str, float]:
    """Typical length, width, height, top, mass; and the three extents in order of size."""
    found: dict[str, float] = {}
    for what, unit in (("length", "m"), ("width", "m"), ("height", "m"), ("mass", "kg")):
        if row.get(f"{what}_min_{unit}"):
            low, high = row.number(f"{what}_min_{unit}"), row.number(f"{what}_max_{unit}")
            if not 0 < low <= high:
                raise row.error(f"{what} from {low} to {high}: expected 0 < min <= max")
            found[f"{what}_{unit}"] = math.sqrt(low * high)
    if row.get("top_min_m"):
        found["top_m"] = (row.number("top_min_m") + row.number("top_max_m")) / 2
    extents = sorted(found[f"{what}_m"] for what in ("length", "width", "height"))
    return found | dict(zip(("shortest_m", "middle_m", "longest_m"), extents, strict=True))
