"""What an extension may leave out: defaults that follow from what it says."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from afkb.csv_rows import Row
from afkb.errors import KnowledgeError
from afkb.extensions.sheet import ALL_TABLES, Entry, Sheet, label_of
from afkb.extensions.terms import ScaleLimits, Terms
from afkb.ontology.names import UNKNOWN_ROOM

_EXTENTS = ("length", "width", "height")
ELSEWHERE = 0.05
"""How many of a new evidence class a room holds that states no count (proposed)."""
_MOVED = {"Small": "Carried"}
"""Moving habit of a category that states none, by scale; `Rarely` for the others."""


def complete(sheet: Sheet, terms: Terms) -> None:
    """Fill what the rows of a sheet leave out.

    A category without a scale has that of its largest typical extent; one that stands on the
    floor without a top has its top at its height; what is small is carried, what is larger is
    rarely moved; a home has one of it. A new evidence class that some room holds is rare in the
    others. `terms`: those of the files before.
    """
    scales = terms.scales
    rules: dict[str, Callable[[Entry], dict[str, str]]] = {
        "categories": lambda entry: _category(entry.row, scales),
        "duals": lambda entry: _relationship(entry.row, scales),
        "co_occurrences": lambda entry: _relationship(entry.row, scales),
        "evidence_classes": lambda entry: {"dispersion": "1"},
        "rooms": lambda entry: {"expected_number": "0.5"},
    }
    sheet.entries = [
        _provenance(_named(entry, sheet), sheet).filled(
            rules[entry.table.name](entry) if entry.table.name in rules else {}
        )
        for entry in sheet.entries
    ]
    sheet.entries += _counts_elsewhere(sheet, terms)


def _counts_elsewhere(sheet: Sheet, terms: Terms) -> list[Entry]:
    """A count of each new evidence class for each room that states none.

    Without it the network would take the mean of those that do, and the class would tell nothing.
    """
    stated = {(e.row.get("room"), e.row.get("evidence_class")) for e in sheet.of("room_evidence")}
    counted = {evidence for _, evidence in stated}
    rooms = sorted(terms.names("room") | {e.row.get("name") for e in sheet.of("rooms")})
    found = []
    for entry in sheet.of("evidence_classes"):
        name = entry.row.get("name")
        count = sheet.elsewhere.get(name, ELSEWHERE)
        for room in rooms if name in counted else ():
            if (room, name) not in stated and room != UNKNOWN_ROOM:
                cells = {"room": room, "evidence_class": name, "expected_count": str(count)}
                source = f"{entry.row.get('source')}: count of rooms that state none"
                cells |= {"status": "proposed", "source": source}
                row = Row(entry.row.table, entry.row.line, cells)
                found.append(Entry(ALL_TABLES["room_evidence"], row))
    return found


def _provenance(entry: Entry, sheet: Sheet) -> Entry:
    return entry.filled({"status": "proposed", "source": sheet.file.name})


def _named(entry: Entry, sheet: Sheet) -> Entry:
    if entry.table.parts or not entry.row.get("name"):
        return entry
    label = entry.row.get("label") or label_of(entry.row["name"])
    cells = {"label": label, "definition": f"What {sheet.name} calls “{label}”."}
    if not entry.table.name.startswith(("duals", "co_occ")):
        cells["example"] = f"{label}, as {sheet.name} has it"
    return entry.filled(cells)


def _category(row: Row, scales: Sequence[ScaleLimits]) -> dict[str, str]:
    scale = row.get("scale") or _scale(row, _EXTENTS, scales)
    stands_on = row.get("stands_on") or ("Floor" if row.get("top_min_m") else "Anything")
    top = {}
    if stands_on == "Floor" and not row.get("top_min_m") and not row.get("top_max_m"):
        top = {"top_min_m": row.get("height_min_m"), "top_max_m": row.get("height_max_m")}
    return {
        "scale": scale,
        "stands_on": stands_on,
        "moved": _MOVED.get(scale, "Rarely"),
        "expected_number": "1",
        **top,
    }


def _relationship(row: Row, scales: Sequence[ScaleLimits]) -> dict[str, str]:
    sizes = [row.number(c) for c in ("size_x_typical_m", "size_y_typical_m") if row.get(c)]
    scale = _named_scale(max(sizes), scales) if sizes and not row.get("predicted_scale") else ""
    return {"predicted_scale": scale, "distance_mean_m": "0", "distance_sd_m": "0.3"}


def _scale(row: Row, extents: Sequence[str], scales: Sequence[ScaleLimits]) -> str:
    """The scale of the largest typical extent: the middle of its range, logarithmically."""
    try:
        typical = [math.sqrt(row.number(f"{e}_min_m") * row.number(f"{e}_max_m")) for e in extents]
    except (KnowledgeError, ValueError):
        return ""  # What is wrong with them is said where they are checked.
    return _named_scale(max(typical), scales)


def _named_scale(extent_m: float, scales: Sequence[ScaleLimits]) -> str:
    return next((s.name for s in scales if s.least_m <= extent_m < s.greatest_m), "")
