"""The same questions over the same statements, in four engines; their answers must be equal.

    python -m bench.sparql peers [MAP...] [--triples N] [--repeats N]

The statements: scenes of 20,000 triples and more, with the duals and the hierarchy of the ontology,
all in one graph. Each engine is loaded in a process of its own from the same N-Triples; load time
and memory are that process's (the import of the engine not counted). Times are of CPU, and of the
clock for the server, which have the way over HTTP in them; `--json` has both.
"""

from __future__ import annotations

import argparse
import json
import resource
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from pyoxigraph import DefaultGraph, Quad, RdfFormat, Store

from afkb.knowledge import AfNet
from afkb.store import StoredMap
from afkb.store.sparql_loading import load_ontologies
from afkb.store.vocabulary import term
from bench.detectors.data import NoData
from bench.sparql import engines
from bench.sparql.questions import QUESTIONS, text
from bench.sparql.scenes import add_arguments, fleet, folders_of, timed

__all__ = ["add_arguments", "run", "table"]

IN_PROCESS = {"afkb": "Afkb", "rdflib": "Rdflib", "owlready2": "Owlready"}
SERVER = "Oxigraph server"


def run(args: argparse.Namespace) -> dict[str, Any]:
    """By engine: load, memory, and each question's times; and whether all answers are equal."""
    with folders_of(args) as folders, TemporaryDirectory() as scratch:
        maps = fleet(folders, args.triples)
        file = Path(scratch, "fleet.nt")
        scenes, all_of_it = write_statements(maps, file)
        found = {name: _apart(name, file, args.repeats) for name in IN_PROCESS}
        try:
            with engines.oxigraph_server(file) as server:
                found[SERVER] = {"questions": _asked(server, args.repeats)}
        except NoData as missing:
            sys.stderr.write(f"{SERVER}: {missing}\n")
    answers = {
        name: {q: own.pop("rows") for q, own in e["questions"].items()} for name, e in found.items()
    }
    differing = [
        f"{name}: {question}"
        for name, own in answers.items()
        for question, rows in own.items()
        if rows is not None and rows != answers["afkb"][question]
    ]
    return {
        "maps": len(maps),
        "triples of scenes": scenes,
        "triples": all_of_it,
        "engines": found,
        "answers that differ from afkb's": differing,
    }


def write_statements(maps: Sequence[StoredMap], file: Path) -> tuple[int, int]:
    """Scenes, duals and hierarchy as N-Triples; how many are of scenes, and how many in all."""
    store = Store()
    for stored in maps:
        store.extend(Quad(q.subject, q.predicate, q.object) for q in stored.store)
    scenes = len(store)
    ontology = Store()
    load_ontologies(ontology, AfNet().files)
    duals = [
        q.subject for q in ontology.quads_for_pattern(None, term("rdf:type"), term("afn:Dual"))
    ]
    kept = [q for dual in duals for q in ontology.quads_for_pattern(dual, None, None)]
    kept += ontology.quads_for_pattern(None, term("skos:broader"), None)
    store.extend(Quad(q.subject, q.predicate, q.object) for q in kept)
    store.dump(output=str(file), format=RdfFormat.N_TRIPLES, from_graph=DefaultGraph())
    return scenes, len(store)


def _apart(name: str, file: Path, repeats: int) -> dict[str, Any]:
    """An engine's figures, from a process of its own."""
    command = [sys.executable, "-m", "bench.sparql.peers", name, str(file), str(repeats)]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    return dict(json.loads(done.stdout.splitlines()[-1]))


def _asked(engine: engines.Engine, repeats: int) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for name, (kind, _) in QUESTIONS.items():
        try:
            rows = sorted(map(list, engine.ask(text(name))), key=str)
        except Exception as error:
            found[name] = {"kind": kind, "rows": None, "can't": " ".join(str(error).split())[:100]}
            continue
        times = timed(lambda name=name: engine.ask(text(name)), repeats)  # type: ignore[misc]
        found[name] = {"kind": kind, "rows": rows, "answers": len(rows)} | times
    return found


def _main() -> None:
    name, file, repeats = sys.argv[1:]
    kind = getattr(engines, IN_PROCESS[name])
    kind(_nothing(Path(file)))
    before = _resident_mb()
    cpu, wall = time.process_time(), time.perf_counter()
    engine = kind(Path(file))
    shape = {
        "load_cpu_ms": round((time.process_time() - cpu) * 1000, 1),
        "load_wall_ms": round((time.perf_counter() - wall) * 1000, 1),
        "memory_mb": round(_resident_mb() - before, 1),
    }
    sys.stdout.write(json.dumps(shape | {"questions": _asked(engine, int(repeats))}) + "\n")


def _resident_mb() -> float:
    """Memory of this process now (Linux). Its peak is no use: a child inherits its parent's."""
    pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1])
    return pages * resource.getpagesize() / (1 << 20)


def _nothing(beside: Path) -> Path:
    """A file of one statement, so that imports are done before the clock runs."""
    empty = beside.with_name("nothing.nt")
    empty.write_text("<urn:a> <urn:b> <urn:c> .\n", encoding="utf-8")
    return empty


def table(result: dict[str, Any]) -> Iterator[str]:
    """Engines side by side: medians and 95th percentiles, ms of the clock, and load."""
    scenes, triples = result["triples of scenes"], result["triples"]
    yield f"{result['maps']} maps, {scenes} triples of scenes, {triples} in all"
    names = list(result["engines"])
    yield f"{'ms of CPU, server of the clock: median (p95)':48}" + "".join(
        f"{name:>22}" for name in names
    )
    for question, (kind, _) in QUESTIONS.items():
        cells = [result["engines"][name]["questions"][question] for name in names]
        told = [
            _told(cell, "wall" if name == SERVER else "cpu")
            for name, cell in zip(names, cells, strict=True)
        ]
        label = f"{question} [{kind}]" if kind != "typical" else question
        yield f"{label[:47]:48}" + "".join(f"{cell:>22}" for cell in told)
    for key in ("load_cpu_ms", "load_wall_ms", "memory_mb"):
        cells = [result["engines"][name].get(key, "-") for name in names]
        yield f"{key:48}" + "".join(f"{cell:>22}" for cell in cells)
    differing = result["answers that differ from afkb's"]
    yield "all answers are equal" if not differing else f"answers differ: {differing}"


def _told(cell: dict[str, Any], clock: str) -> str:
    if "answers" not in cell:
        return "can't"
    return f"{cell[f'{clock}_median_ms']:.2f} ({cell[f'{clock}_p95_ms']:.2f})"


if __name__ == "__main__":
    _main()
