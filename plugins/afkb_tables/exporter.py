"""Writes a map as CSV tables, with a description that tools read."""

from __future__ import annotations

import csv
import json
from collections.abc import Mapping, Sequence
from pathlib import Path

from afkb import __version__
from afkb.flow import TopologicalMap
from afkb_tables.tables import Table, tables

PACKAGE = "datapackage.json"


class CsvExporter:
    """CSV tables for spreadsheets and pandas, described by a Frictionless data package."""

    name = "csv"
    in_map_folder = False

    def export(
        self, topological_map: TopologicalMap, folder: Path, run: Mapping[str, object]
    ) -> Sequence[Path]:
        """Write a file a table, and datapackage.json; `run` is not used."""
        made = tables(topological_map)
        files = [_write(table, folder) for table in made]
        package = folder / PACKAGE
        package.write_text(json.dumps(_package(made), indent=1) + "\n", encoding="utf-8")
        return [package, *files]


def _write(table: Table, folder: Path) -> Path:
    path = folder / f"{table.name}.csv"
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(column.name for column in table.columns)
        writer.writerows(map(_told, row) for row in table.rows)
    return path


def _told(value: object) -> object:
    """A cell: nothing where nothing is known, truth values as the schema has them."""
    if isinstance(value, bool):
        return "true" if value else "false"
    return "" if value is None else value


def _package(made: Sequence[Table]) -> dict[str, object]:
    return {
        "profile": "tabular-data-package",
        "name": "topological-affordance-map",
        "description": f"A map that afkb {__version__} exported; map frame, z up, m, rad and s.",
        "resources": [
            {
                "profile": "tabular-data-resource",
                "name": table.name,
                "path": f"{table.name}.csv",
                "description": table.what,
                "format": "csv",
                "encoding": "utf-8",
                "schema": {
                    "fields": [
                        {"name": c.name, "type": c.type, "description": c.what}
                        for c in table.columns
                    ],
                    "missingValues": [""],
                    **({"primaryKey": table.key} if table.key else {}),
                },
            }
            for table in made
        ],
    }
