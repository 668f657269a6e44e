"""Every query of the library over a fleet of maps with the whole ontology, as users ask it.

python -m bench.sparql library [MAP...] [--triples N] [--repeats N]
"""

from __future__ import annotations

import argparse
import statistics
from collections.abc import Iterator
from typing import Any

from afkb.knowledge import AfNet
from afkb.store import Dataset
from afkb.store.named import named_queries
from bench.sparql.scenes import add_arguments, fleet, folders_of, timed

__all__ = ["add_arguments", "run", "table"]


def run(args: argparse.Namespace) -> dict[str, Any]:
    """Load time, and by query its rows and times."""
    with folders_of(args) as folders:
        maps = fleet(folders, args.triples)
    files = AfNet().files
    load = timed(lambda: Dataset.load(maps, files), 3)
    everything = Dataset.load(maps, files)
    queries = {
        known.name: {
            "rows": len(everything.ask(known.sparql).rows),
            **timed(lambda known=known: everything.ask(known.sparql), args.repeats),  # type: ignore[misc]
        }
        for known in named_queries()
    }
    scenes = sum(len(one.store) for one in maps)
    return {
        "triples of scenes": scenes,
        "triples": len(everything.store),
        "load": load,
        "queries": queries,
    }


def table(result: dict[str, Any]) -> Iterator[str]:
    """The queries, the slowest first."""
    yield f"{result['triples of scenes']} triples of scenes, {result['triples']} with the ontology"
    yield f"load: {result['load']['cpu_median_ms']:.0f} ms of CPU"
    rows = sorted(result["queries"].items(), key=lambda item: -item[1]["cpu_median_ms"])
    for name, own in rows:
        yield (
            f"@{name:28} {own['rows']:5} rows {own['cpu_median_ms']:8.2f} ms of CPU "
            f"(p95 {own['cpu_p95_ms']:.2f}), {own['wall_median_ms']:8.2f} of the clock"
        )
    medians = [own["cpu_median_ms"] for own in result["queries"].values()]
    within = sum(ms <= 5 for ms in medians)
    yield f"median {statistics.median(medians):.2f} ms; {within} of {len(medians)} within 5 ms"
