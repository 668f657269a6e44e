"""Every table that the ontology is built from, read together, and the afbits that they make."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from afkb.csv_rows import Row
from afkb.ontology.afbits import DrawnAfbit, draw_afbits
from afkb.ontology.categories import completed
from afkb.ontology.heights import with_undersides
from afkb.ontology.rules import read_rules
from afkb.ontology.schema import TABLES
from afkb.ontology.subjects import read_subjects
from afkb.ontology.tables import by_name, read_table

if TYPE_CHECKING:
    from afkb.figures import Figures

_UNLIKE_OTHERS = (
    "vocabulary", "afbits", "evidence", "review", "entity_definitions", "links", "units",
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class Tables:
    """The rows of every table, by the table's name, and what was counted in homes beside them."""

    rows: dict[str, list[Row]]
    figures: Figures | None = None

    @classmethod
    def read(cls, folder: Path) -> Tables:
        """Read a folder of tables; `KnowledgeError` with file and line."""
        names = (*_UNLIKE_OTHERS, *(t.name for t in TABLES))
        rows = {name: read_table(folder, name) for name in names}
        figures = _figures(folder.parent / "counts")
        categories = with_undersides(map(completed, rows["categories"]), figures)
        return cls(rows | {"categories": categories}, figures)

    def afbits(self) -> list[DrawnAfbit]:
        """Every afbit that the tables state or make, those that are held back among them."""
        subjects = read_subjects(
            self.rows["categories"], self.rows["category_groups"], self.rows["evidence"]
        )
        rules = read_rules(self.rows["rules"])
        return draw_afbits(subjects, self.kinds, rules, self.rows["afbits"], self.rows["review"])

    @property
    def kinds(self) -> dict[str, str]:
        """Feature to structural, material or grasp."""
        return {name: row["kind"] for name, row in by_name(self.rows["features"]).items()}


def _figures(counts: Path) -> Figures | None:
    """What was counted in homes; None where there is no folder of counts."""
    if not counts.is_dir():
        return None
    from afkb.figures import Figures

    return Figures.load(counts)
