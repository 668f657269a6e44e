"""A small copy of the ontology's tables: a few categories, so that a build takes no time."""

from __future__ import annotations

import csv
import shutil
from collections.abc import Callable, Iterable
from pathlib import Path

from afkb.knowledge import bundled_ontology

CATEGORIES = frozenset((
    "SomethingElse", "Cup", "Mug", "Table", "KitchenTable", "Desk", "Chair", "Bed", "Book", "Pen",
    "Mirror", "StandingMirror", "Bowl", "Counter", "Ball", "Bathtub", "TrashCan", "Doorframe",
    "Door", "Television", "Display", "Carton", "Tetrapak", "Canister", "Bottle", "WaterBottle",
))  # fmt: skip
GROUPS = frozenset(("Food",))
_ABOUT_CATEGORIES = ("category", "evidence_category", "predicted_category", "object", "given")


def small_tables(folder: Path, categories: Iterable[str] = CATEGORIES) -> Path:
    """The bundled tables with these categories alone, in `folder`."""
    kept = frozenset(categories)
    shutil.copytree(bundled_ontology().parent / "tables", folder, dirs_exist_ok=True)
    for path in sorted(folder.rglob("*.csv")):
        if path.name == "categories.csv" or path.parent.name == "categories":
            _keep(path, lambda row: row["name"] in kept)
        else:
            _keep(path, lambda row: _about(row, kept))
    return folder


def _about(row: dict[str, str], kept: frozenset[str]) -> bool:
    if "features" in row and not row["definition"]:
        return row["name"] in kept | GROUPS
    return all(not row.get(column) or row[column] in kept for column in _ABOUT_CATEGORIES)


def _keep(path: Path, wanted: Callable[[dict[str, str]], bool]) -> None:
    with path.open(encoding="utf-8", newline="") as file:
        reader = csv.DictReader(file)
        names, rows = reader.fieldnames or (), [row for row in reader if wanted(row)]
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, names, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
