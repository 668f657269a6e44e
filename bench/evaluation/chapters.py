"""What is measured, in the order of the document: chapters of commands."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Measurement:
    """A figure's command: words of a shell line, `$AFKB_DATA` for the folder of recordings.

    - `name`: of its file of results. `before`: commands that make what it looks at, in a scratch
      folder. `repeats`: how often it runs, where its figures differ from run to run.
    """

    name: str
    command: str
    about: str = ""
    before: tuple[str, ...] = ()
    repeats: int = 1


@dataclass(frozen=True, slots=True)
class Chapter:
    """Measurements that answer one question."""

    title: str
    about: str
    measurements: tuple[Measurement, ...]


def _parts(package: str, *parts: str, repeats: int = 1) -> tuple[Measurement, ...]:
    short = package.removeprefix("bench.")
    return tuple(
        Measurement(f"{short}-{part}", f"python -m {package} {part}", repeats=repeats)
        for part in parts
    )


def _detectors(*parts: str, repeats: int = 1) -> tuple[Measurement, ...]:
    return tuple(
        Measurement(f"detectors-{p}", f"python -m bench.detectors --only {p}", repeats=repeats)
        for p in parts
    )


def _home(name: str) -> Measurement:
    recording = f"$AFKB_DATA/homes/{name}"
    return Measurement(
        f"homes-{name}",
        f"python -m bench.homes {name} --truth {recording}/truth.json",
        before=(f"afkb map {recording}/bag --out {name}",),
    )


CHAPTERS = (
    Chapter(
        "The paper's scenarios",
        "The paper's figures, ours, and how each was obtained "
        "([the paper, reproduced](paper-reproduced.md)).",
        (
            Measurement("reproduce-worlds", "afkb reproduce --worlds --out reproduced"),
            Measurement("reproduce-homes", "afkb reproduce --data $AFKB_DATA --out reproduced"),
            Measurement("paper-home", "python -m bench.paper_home"),
        ),
    ),
    Chapter(
        "What is seen in a frame",
        "At true poses, so that only detectors are judged. Open3D's planar patches and RANSAC are "
        "measured on the same frames in the same run. What the words mean: "
        "[how well it works](how-well-it-works.md).",
        (
            *_detectors("surfaces", "mosd", "redkitchen", "containers", "doorways", "movability"),
            *_detectors("calibration", "robustness"),
            *_detectors("speed", repeats=3),
            Measurement("floor-plans", "python -m bench.floor_plans"),
        ),
    ),
    Chapter(
        "Maps beside the truth",
        "Homes mapped from depth, laser and drifting odometry. More of it: "
        "[how well maps last](how-well-maps-last.md).",
        (
            *map(_home, ("merom", "merom-later", "pomaria")),
            *_parts("bench.mapping", "trajectory", "loops", "relations", "faults", "locate"),
            *_parts("bench.mapping", "diff", "floorplans", "vacuum", "growth", "lightness"),
        ),
    ),
    Chapter(
        "What is inferred",
        "Rooms, what they hold, what things are, what was not seen, and where things are found; "
        "pgmpy and pyAgrum answer the same questions in the run that tells the speed "
        "([how well it infers](how-well-it-infers.md)).",
        (
            *_parts("bench.inference", "rooms", "contents", "homes", "learning", "things"),
            *_parts("bench.inference", "context", "predicted", "rules", "finding", "hardships"),
            *_parts("bench.inference", "speed", repeats=3),
        ),
    ),
    Chapter(
        "Questions in SPARQL",
        "The same queries on the same 20,000 triples, with equal answers, beside rdflib, owlready2 "
        "and Oxigraph's server.",
        (
            *_parts("bench.sparql", "peers", repeats=3),
            *_parts("bench.sparql", "library"),
            *_parts("bench.sparql", "startup", repeats=3),
        ),
    ),
    Chapter(
        "The server",
        "`afkb serve` under attack, crowded, and at everyday work ([serving](serving.md)), and its "
        "page at work in a browser.",
        (
            *_parts("bench.serving", "attacks"),
            *_parts("bench.serving", "crowd", "everyday", repeats=3),
            Measurement("page", "python -m bench.page", repeats=3),
        ),
    ),
    Chapter(
        "What maps weigh",
        "Sizes in each format, and the time to load, beside spark-dsg ([exports](exports.md)).",
        _parts("bench.exports", "formats", "peers"),
    ),
    Chapter(
        "Recordings",
        "Reading speed beside others, and that the same recording gives the same map in every "
        "format ([your own data](your-own-data.md)).",
        (*_parts("bench.sources", "reading", repeats=3), *_parts("bench.sources", "agreement")),
    ),
    Chapter(
        "Killed at random moments",
        "Kill -9 during mapping, updating, a batch and an upload; afterwards every folder and "
        "every graph is the old one or the new one.",
        _parts("bench.endurance", "writing", "maps", "updates", "batches", "uploads"),
    ),
    Chapter(
        "The ontology",
        "How right its rules are against verdicts that were written down first, and how well what "
        "was counted in some homes tells of others.",
        (
            Measurement("afbits", "python -m bench.afbits"),
            Measurement("figures", "python -m bench.figures"),
        ),
    ),
)
MEASUREMENTS = {m.name: m for chapter in CHAPTERS for m in chapter.measurements}
