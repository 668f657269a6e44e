"""Writes report.html: one file that opens from disk and shows what was mapped."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from html import escape
from pathlib import Path
from string import Template

from afkb import __version__
from afkb.drawing import drawing_of, inline_script, inline_style, part
from afkb.flow import TopologicalMap
from afkb_report import tables

REPORT = "report.html"
_PARTS = Path(__file__).parent


class ReportExporter:
    """Writes report.html; part of every map folder.

    The page is the same for the same map, byte for byte. What differs between two runs, the
    timings, it shows from run.json beside it.
    """

    name = "report"
    in_map_folder = True

    def export(
        self, topological_map: TopologicalMap, folder: Path, run: Mapping[str, object]
    ) -> Sequence[Path]:
        """Write the page into the folder; of `run` only the names of its stages are used."""
        written = folder / REPORT
        written.write_text(page(topological_map, run), encoding="utf-8")
        return [written]


def page(topological_map: TopologicalMap, run: Mapping[str, object]) -> str:
    """The page's HTML: plan, evidence, and tables of counts, rooms, things, closures, timings."""
    drawing = drawing_of(topological_map)
    template = Template((_PARTS / "page.html").read_text(encoding="utf-8"))
    return template.substitute(
        version=escape(__version__),
        style=inline_style(),
        script=inline_script("report.js"),
        summary=escape(drawing.summary),
        board=Template(part("board.html")).substitute(plan=drawing.svg),
        drawing=_in_script(drawing.as_json()),
        counts=tables.counts(topological_map),
        rooms=tables.rooms(topological_map),
        things=tables.things(topological_map),
        closures=tables.closures(topological_map),
        notes=tables.notes(topological_map),
        timings=tables.timings(run),
    )


def _in_script(data: Mapping[str, object]) -> str:
    """JSON that can't end the script element that it stands in, whatever names it has."""
    text = json.dumps(data, separators=(",", ":"), ensure_ascii=False, allow_nan=False)
    return text.replace("&", "\\u0026").replace("<", "\\u003c").replace(">", "\\u003e")
