"""Writes report.html: one file that opens from disk and shows what was mapped."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from html import escape
from pathlib import Path
from string import Template

from afkb import __version__
from afkb.flow import NodeKind, TopologicalMap
from afkb_report import tables
from afkb_report.plan import plan

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
    """The page's HTML: plan, legend, and tables of counts, rooms, things, closures, timings."""
    template = Template((_PARTS / "page.html").read_text(encoding="utf-8"))
    return template.substitute(
        version=escape(__version__),
        style=(_PARTS / "style.css").read_text(encoding="utf-8"),
        script=(_PARTS / "page.js").read_text(encoding="utf-8"),
        summary=escape(_summary(topological_map)),
        plan=plan(topological_map),
        counts=tables.counts(topological_map),
        rooms=tables.rooms(topological_map),
        things=tables.things(topological_map),
        closures=tables.closures(topological_map),
        notes=tables.notes(topological_map),
        timings=tables.timings(run),
    )


def _summary(m: TopologicalMap) -> str:
    seen = sum(e.kind is NodeKind.OBSERVED for e in m.entities)
    counted = (
        (len(m.rooms), "room"),
        (len(m.places), "robot place"),
        (seen, "thing seen"),
        (len(m.entities) - seen, "thing predicted"),
        (len(m.closures), "loop closure"),
    )
    return " · ".join(f"{n} {_plural(what) if n != 1 else what}" for n, what in counted)


def _plural(what: str) -> str:
    return what.replace("thing", "things") if "thing" in what else f"{what}s"
