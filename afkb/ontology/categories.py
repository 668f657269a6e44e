"""What follows for a category from how often people move it (paper §II.D.i)."""

from __future__ import annotations

from dataclasses import replace

from afkb.csv_rows import Row

MATCHING_WEIGHT = {"Fixed": 1.0, "RarelyMoved": 0.8, "OftenMoved": 0.4, "Carried": 0.3}
"""Weight of a thing when maps are matched, by moving habit; 0.3 is p_d of paper §II.D.i."""
_HABITS = {"Rarely": "RarelyMoved", "Often": "OftenMoved"}


def completed(row: Row) -> Row:
    """A category's row with its movability, and its matching weight where it has none."""
    habit = _HABITS.get(row["moved"], row["moved"])
    if habit not in MATCHING_WEIGHT:
        raise row.error(f"moved {row['moved']!r} is none of: Fixed, Rarely, Often, Carried")
    cells = row.cells | {"moved": habit, "movability": movability_of(habit)}
    cells.setdefault("matching_weight", str(MATCHING_WEIGHT[habit]))
    return replace(row, cells=cells)


def movability_of(habit: str) -> str:
    """`Static` for what is fixed or rarely moved, else `Dynamic`."""
    return "Static" if habit in ("Fixed", "RarelyMoved") else "Dynamic"
