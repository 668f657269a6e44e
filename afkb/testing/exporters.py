"""The contract of an exporter."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from afkb.flow import TopologicalMap
from afkb.plugins.protocols import Exporter
from afkb.testing.require import require, require_name
from afkb.testing.sample_flow import sample_map

_RUN: Mapping[str, object] = {
    "source": "sample",
    "afkb": "0",
    "parameters": {},
    "timings_s": {},
    "counts": {},
}


def check_exporter(
    exporter: Exporter,
    folder: Path,
    topological_map: TopologicalMap | None = None,
    run: Mapping[str, object] = _RUN,
) -> None:
    """Raise unless the exporter writes the map into the empty `folder`, the same each time.

    One that says `same_bytes = False` may write other bytes the second time.
    `topological_map`, `run`: what to export, by default a small sample of each.
    """
    name = require_name(exporter, f"exporter {type(exporter).__name__}")
    who = f"exporter {name!r}"
    require(isinstance(exporter, Exporter), who, "is no Exporter", "see afkb.plugins.protocols")
    told = isinstance(exporter.in_map_folder, bool)
    require(told, who, "in_map_folder is no bool", "True if each map folder should hold its files")
    same = getattr(exporter, "same_bytes", True) or not exporter.in_map_folder
    require(same, who, "has other bytes in each map folder", "leave it to `afkb export`")
    what = sample_map() if topological_map is None else topological_map
    first, again = folder / "first", folder / "again"
    for place in (first, again):
        place.mkdir()
        _check_files(exporter.export(what, place, run), place, who)
    require(
        not getattr(exporter, "same_bytes", True) or _contents(first) == _contents(again),
        who,
        "writes other bytes the second time",
        "leave out times and paths, and order what comes from sets, or say `same_bytes = False`",
    )


def _check_files(written: Sequence[Path], folder: Path, who: str) -> None:
    names = sorted(str(p.relative_to(folder)) for p in written if p.is_relative_to(folder))
    require(
        len(names) == len(written) > 0, who, f"returns {list(written)}", "write into the folder"
    )
    found = sorted(_contents(folder))
    require(found == names, who, f"wrote {found} but says {names}", "return exactly what it wrote")
    empty = [n for n in names if not (folder / n).stat().st_size]
    require(not empty, who, f"leaves {empty} empty", "write the map, or leave the file out")


def _contents(folder: Path) -> dict[str, bytes]:
    files = sorted(p for p in folder.rglob("*") if p.is_file())
    return {str(p.relative_to(folder)): p.read_bytes() for p in files}
