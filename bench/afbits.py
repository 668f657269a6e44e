"""How right the rules are that make afbits, against verdicts that people wrote down first.

    python -m bench.afbits [--tables ontology/tables] [--json]

A round is a set of categories drawn at random; every structural and material afbit that the rules
of the day made of them got a verdict and a reason, and what they missed was added. `judged`: what
was judged then. `now`: what today's rules, and rows stated by hand, make of the same categories,
before the review itself holds anything back. What a change of rules added to a round was judged
afterwards, in a file of its own (`…-after`), and counts for `now` alone.
"""

from __future__ import annotations

import argparse
import json
from collections import Counter, defaultdict
from dataclasses import asdict, dataclass
from pathlib import Path

from afkb.csv_rows import Row
from afkb.ontology.table_folder import Tables

ROUNDS = {
    "1: 100 categories, seed 20261122, rules then changed": "round-1",
    "2: 50 others, seed 20261123, drawn after the change": "round-2",
}


@dataclass(frozen=True)
class Score:
    """Counts of one round; precision is right / (right + wrong), recall right / all that hold."""

    categories: int
    right: int
    wrong: int
    unjudged: int
    missed: int

    @property
    def precision(self) -> float:
        """Share of what was judged that is right."""
        return self.right / max(self.right + self.wrong, 1)

    @property
    def recall(self) -> float:
        """Share of what holds that was made."""
        return self.right / max(self.right + self.missed, 1)


def judged(rows: list[Row]) -> Score:
    """The score of the rules at the time of the verdicts."""
    verdicts = Counter(row["verdict"] for row in rows)
    return Score(
        len({row["category"] for row in rows}),
        verdicts["right"],
        verdicts["wrong"],
        0,
        verdicts["missing"],
    )


def now(rows: list[Row], tables: Tables) -> Score:
    """The score of today's rules on the same categories, by the same verdicts."""
    verdicts = {(r["category"], r.get("part"), r["feature"]): r["verdict"] for r in rows}
    categories = {row["category"] for row in rows}
    made = {
        afbit.key
        for afbit in tables.afbits()
        if afbit.kind != "grasp" and afbit.key[0] in categories and not afbit.supplied
    }
    found = Counter(verdicts.get(key, "unjudged") for key in made)
    holding = {key for key, verdict in verdicts.items() if verdict != "wrong"}
    return Score(
        len(categories),
        found["right"] + found["missing"],
        found["wrong"],
        found["unjudged"],
        len(holding - made),
    )


def main() -> None:
    """Print both scores of every round."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "--tables", type=Path, default=Path(__file__).parents[1] / "ontology" / "tables"
    )
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    tables = Tables.read(arguments.tables)
    rounds: dict[str, list[Row]] = defaultdict(list)
    for row in tables.rows["review"]:
        rounds[Path(row.table).stem[: len("round-1")]].append(row)
    result = {
        title: {
            "judged": judged([r for r in rounds[stem] if "-after" not in r.table]),
            "now": now(rounds[stem], tables),
        }
        for title, stem in ROUNDS.items()
    }
    if arguments.json:
        print(json.dumps({t: {k: asdict(s) for k, s in r.items()} for t, r in result.items()}))
        return
    for title, scores in result.items():
        print(f"round {title}")
        for when, score in scores.items():
            print(
                f"  {when:7} {score.right} right, {score.wrong} wrong: precision "
                f"{score.precision:.3f}; missed {score.missed}: recall {score.recall:.3f}"
                + (f"; {score.unjudged} without a verdict" if score.unjudged else "")
            )


if __name__ == "__main__":
    main()
