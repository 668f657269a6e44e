"""The three rules by which repeated predictions add up: how fast each saturates, how right it is.

    python -m bench.inference rules [--rooms hm3d_regions.csv] [--map MAP --home HOME]... [--json]

- saturation: probability after one to eight pieces of evidence, each another thing; and after as
  many looks at one thing from distinct viewpoints, which the mapper counts for what is new in them.
- rooms: whether a real room holds a table or desk, told from how many seats it holds, one piece of
  evidence each (`--rooms`, a table of whole rooms).
- simulated: a thing is there or not, and up to eight looks tell of it, rightly as often as the
  axiom's strength says. A share of looks repeats what the first one said. `every look`: each counts
  as evidence of its own, as in the paper's formula; `what is new`: repetitions don't.
- recordings: the predictions of homes under each rule, against their truth, as in `predicted`.

Rules: `log-odds` (Bayes, even prior, clamped), `noisy-or`, and `literal`, the paper's p + 1/p,
clamped to 1.
"""

from __future__ import annotations

import argparse
import csv
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from afkb.inference.update_rules import RULES, in_part, log_odds
from afkb.knowledge import AfNet
from afkb.plugins.host import PluginHost
from bench.detectors.data import NoData, data_folder
from bench.inference import home_maps
from bench.inference.blinded import blinded, nothing
from bench.inference.predicted import calibration
from bench.inference.predicted_truth import Predicted, predictions_of

MOST = 8
SEATS = ("chair", "stool", "bar stool", "armchair")
TABLES = ("table", "desk", "kitchen island", "counter table")
SIGHTING = 0.9
"""How sure a detector is of a thing at a look, when its looks are simulated."""
WORLDS, SEED = 20_000, 7
REPEATED = (0.0, 0.5, 1.0)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The table of rooms, and maps of homes."""
    home_maps.add_arguments(parser)
    parser.add_argument("--rooms", type=Path, default=data_folder() / "rooms" / "hm3d_regions.csv")


def run(args: argparse.Namespace) -> dict[str, Any]:
    """Each question's answer, by rule."""
    kb = AfNet()
    dual = max(d.strength for d in kb.duals if d.relation == "below")
    near = max(c.strength for c in kb.co_occurrences if c.is_rule)
    return {
        "saturation": {rule: saturation(rule, (dual, near)) for rule in RULES},
        "rooms": of_rooms(args.rooms, near) if args.rooms.is_file() else {},
        "simulated": {rule: simulated(rule, dual) for rule in RULES},
        "recordings": of_recordings(args),
    }


def saturation(rule: str, strengths: Sequence[float]) -> dict[str, list[float]]:
    """Probability after each piece of evidence, by what the pieces are."""
    found = {}
    for strength in strengths:
        found[f"things, {strength}"] = [round(added(rule, strength, n), 3) for n in _numbers()]
        found[f"looks at one, {strength}"] = [
            round(looks_at_one(rule, strength, n), 3) for n in _numbers()
        ]
    return found


def _numbers() -> range:
    return range(1, MOST + 1)


def added(rule: str, strength: float, number: int) -> float:
    """Probability after so many independent pieces of evidence of one strength."""
    p = strength
    for _ in range(number - 1):
        p = RULES[rule](p, strength)
    return p


def looks_at_one(rule: str, strength: float, number: int) -> float:
    """The same after looks at one thing: each counts for how much surer the thing has become."""
    p, existence = strength, SIGHTING
    for _ in range(number - 1):
        surer = log_odds(existence, SIGHTING)
        if surer > existence:
            p = RULES[rule](p, in_part(rule, strength, surer - existence))
        existence = surer
    return p


def of_rooms(path: Path, strength: float) -> dict[str, Any]:
    """Whether rooms with seats hold a table: the share by seats, and each rule's calibration."""
    seats, holds = [], []
    with path.open(encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            things = _things(row["objects"])
            if number := sum(n for name, n in things.items() if _is_one_of(name, SEATS)):
                seats.append(min(number, MOST))
                holds.append(any(_is_one_of(name, TABLES) for name in things))
    true, count = np.array(holds), np.array(seats)
    shares = [round(float(true[count == n].mean()), 3) for n in _numbers()]
    return {
        "rooms": len(seats),
        "rooms by seats": [int((count == n).sum()) for n in _numbers()],
        "share by seats": shares,
        **{rule: calibration([added(rule, strength, n) for n in seats], holds) for rule in RULES},
    }


def _things(cell: str) -> Mapping[str, int]:
    named = (item.rpartition(":") for item in cell.split("|") if ":" in item)
    return Counter({name: int(number) for name, _, number in named})


def _is_one_of(name: str, kinds: Sequence[str]) -> bool:
    """Whether a label ends in one of the kinds: a dining table is a table, a table lamp is none."""
    return any(name == kind or name.endswith(f" {kind}") for kind in kinds)


def simulated(rule: str, strength: float) -> dict[str, dict[str, Any]]:
    """Calibration by what share of looks repeats the first, and by what is counted."""
    rng = np.random.default_rng(SEED)
    found: dict[str, dict[str, Any]] = {}
    for repeated in REPEATED:
        told: dict[str, list[float]] = {"every look": [], "what is new": []}
        true = rng.random(WORLDS) < 0.5
        for there in true:
            looks, new = _looks(rng, bool(there), strength, repeated)
            told["every look"].append(_folded(RULES[rule], looks))
            told["what is new"].append(_folded(RULES[rule], looks[new]))
        for counted, p in told.items():
            found[f"{repeated:.0%} repeated, {counted}"] = calibration(p, true.tolist())
    return found


def _looks(rng: np.random.Generator, there: bool, strength: float, repeated: float) -> Any:
    """What one to eight looks say (strength for it, 1 - strength against), and which are new."""
    number = int(rng.integers(1, MOST + 1))
    right = rng.random(number) < strength
    new = rng.random(number) >= repeated
    new[0] = True
    says = np.where(right == there, strength, 1 - strength)
    return np.where(new, says, says[0]), new


def _folded(rule: Callable[[float, float], float], looks: Sequence[float]) -> float:
    p = float(looks[0])
    for evidence in looks[1:]:
        p = rule(p, float(evidence))
    return p


def of_recordings(args: argparse.Namespace) -> dict[str, Any]:
    """Calibration over all steps of the predictions of homes, by rule."""
    host = PluginHost()
    found = {}
    try:
        homes = home_maps.home_maps(args, host)
    except NoData:
        return {}
    for rule in RULES:
        told: list[Predicted] = []
        for folder, home in homes:
            mapped = blinded(folder, host, nothing, rule)
            told += predictions_of(mapped, home.truth, home.name, host.knowledge_base)
        steps = [(p, prediction.true) for prediction in told for p in prediction.steps]
        found[rule] = calibration([p for p, _ in steps], [true for _, true in steps])
    return found


def table(result: dict[str, Any]) -> Iterator[str]:
    """Lines by question, the rules side by side."""
    for rule, found in result["saturation"].items():
        for what, values in found.items():
            yield f"{rule:9} {what:20} " + " ".join(f"{p:.3f}" for p in values)
    rooms = result["rooms"]
    if rooms:
        yield f"{rooms['rooms']} rooms with seats; with a table by seats: {rooms['share by seats']}"
        for rule in RULES:
            yield f"  {rule:9} {_said(rooms[rule])}"
    for rule, found in result["simulated"].items():
        for what, told in found.items():
            yield f"simulated {rule:9} {what:28} {_said(told)}"
    for rule, told in result["recordings"].items():
        yield f"recordings {rule:9} {_said(told)}"


def _said(told: Mapping[str, Any]) -> str:
    if not told:
        return "nothing"
    always = told["Brier, always the share"]
    return f"error {told['error']:.3f}, Brier {told['Brier']:.3f} (always the share {always:.3f})"
