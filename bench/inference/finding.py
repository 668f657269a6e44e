"""Where small things are: rank and probability of the true place of each, seen and hidden.

    python -m bench.inference finding [--home FOLDER --map MAP]... [--json]

`homes/*` has `bag/` and `truth.json`; homes without a `--map` are mapped first. Asked twice:

- as it stands: the map with all that was seen in it;
- hidden: the nodes of everything of the category left out, and no support looked at: where would
  one be, from the rooms and the supports alone?

A thing's place is its own node, else what it stands on, else its room. Each category is asked for
in every home, whether one is there or not. Beside it, for the rank: no order at all, and the
largest support first; for Brier's score: the share of true regions, always.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from afkb.finding import Region, Surroundings, regions, somewhere
from afkb.plugins.host import PluginHost
from bench.inference.grasp_truth import compared
from bench.inference.home_maps import add_arguments, home_maps
from bench.inference.true_places import ASKED, TruePlaces

__all__ = ["add_arguments", "run", "table"]

HOWS = ("thing", "support", "room")
LISTED = 0.001
EDGES = (0.0, 0.01, 0.03, 0.1, 0.2, 0.4, 0.6, 1.0)
TOP = (1, 3, 5)
WAYS = {"as it stands": HOWS, "hidden": ("support", "room")}
"""How it is asked, and over which regions calibration is: of what is hidden, the unseen ones."""


@dataclass(frozen=True, slots=True)
class Asked:
    """A category asked for in a home: regions, whether each holds one, rank and p of each thing."""

    category: str
    found: list[Region]
    true: list[bool]
    ranks: list[int]
    ranks_by_size: list[float]

    @classmethod
    def of(cls, category: str, around: Surroundings, places: TruePlaces, kb: Any) -> Asked:
        """Ask, and compare with the truth."""
        found = regions(category, around, kb)
        at = [places.region_of(thing, around) for thing in places.things(category)]
        keys = [(region.node, region.how) for region in found]
        area = [float(np.prod(_size(around, region)[:2])) for region in found]
        by_size = np.argsort(np.argsort(-np.array(area), kind="stable"), kind="stable")
        told = [keys.index(key) if key in keys else len(keys) for key in at]
        return cls(
            category,
            found,
            [key in at for key in keys],
            [i + 1 for i in told],
            [float(by_size[i]) + 1 if i < len(keys) else len(keys) + 1.0 for i in told],
        )


def _size(around: Surroundings, region: Region) -> tuple[float, float, float]:
    node = around.nodes.get(region.node)
    return node.size if node and region.how == "support" else (0.0, 0.0, 0.0)


def hidden(category: str, around: Surroundings, places: TruePlaces) -> Surroundings:
    """The map without the nodes of what is asked for, and as if nobody had looked for them."""
    own = {places.node_of(thing, around) for thing in places.things(category)}
    return replace(
        around,
        nodes={k: replace(n, viewpoints=0) for k, n in around.nodes.items() if k not in own},
    )


def scores(answers: Sequence[Asked], hows: Sequence[str] = HOWS) -> dict[str, Any]:
    """Ranks of the true places, calibration over regions of a kind, and what is expected in all.

    Calibration is over what `afkb find` lists: regions with a probability of at least `LISTED`.
    """
    ranks = np.array([rank for a in answers for rank in a.ranks])
    by_size = np.array([rank for a in answers for rank in a.ranks_by_size])
    number = np.array([len(a.found) for a in answers for _ in a.ranks])
    p_true = [_probability(a, rank) for a in answers for rank in a.ranks]
    told = [
        (region.probability, true)
        for a in answers
        for region, true in zip(a.found, a.true, strict=True)
        if region.how in hows
    ]
    p, true = np.array([(p, float(t)) for p, t in told if p >= LISTED]).T
    return {
        "things": len(ranks),
        "regions": round(float(number.mean()), 1),
        "rank": _ranks(ranks),
        "rank, no order": _ranks((number + 1) / 2),
        "rank, largest first": _ranks(by_size),
        "probability of the true place": round(float(np.mean(p_true)), 4),
        "listed": len(p),
        "expected": round(float(p.sum()), 1),
        "true": int(true.sum()),
        "Brier": round(float(np.mean((p - true) ** 2)), 5),
        "Brier, always the share": round(float(np.mean((true.mean() - true) ** 2)), 5),
        "calibration error": round(_calibration_error(p, true), 4),
        "bins": _bins(p, true),
        "somewhere": round(float(np.mean([somewhere(a.found) for a in answers])), 3),
        "somewhere, true": round(float(np.mean([bool(a.ranks) for a in answers])), 3),
    }


def _probability(asked: Asked, rank: int) -> float:
    return asked.found[rank - 1].probability if rank <= len(asked.found) else 0.0


def _ranks(ranks: Any) -> dict[str, float]:
    shares = {f"top {n}": round(float(np.mean(ranks <= n)), 3) for n in TOP}
    return {**shares, "median": float(np.median(ranks)), "mean": round(float(np.mean(ranks)), 1)}


def _bins(p: Any, true: Any) -> list[dict[str, float]]:
    which = np.clip(np.digitize(p, EDGES) - 1, 0, len(EDGES) - 2)
    return [
        {
            "from": EDGES[i],
            "to": EDGES[i + 1],
            "regions": int((which == i).sum()),
            "told": round(float(p[which == i].mean()), 3),
            "true": round(float(true[which == i].mean()), 3),
        }
        for i in range(len(EDGES) - 1)
        if (which == i).any()
    ]


def _calibration_error(p: Any, true: Any) -> float:
    bins = _bins(p, true)
    return sum(b["regions"] * abs(b["told"] - b["true"]) for b in bins) / len(p)


def run(args: argparse.Namespace) -> dict[str, Any]:
    """By home, and of all homes together, as it stands and hidden."""
    host, kb = PluginHost(), PluginHost().knowledge_base
    asked: dict[str, dict[str, list[Asked]]] = {}
    seen: list[TruePlaces] = []
    for folder, home in home_maps(args, host):
        places = TruePlaces.of(home.folder, folder)
        seen.append(places)
        asked[home.name] = {
            "as it stands": [Asked.of(c, places.around, places, kb) for c in ASKED],
            "hidden": [Asked.of(c, hidden(c, places.around, places), places, kb) for c in ASKED],
        }
    every = {way: [a for home in asked.values() for a in home[way]] for way in WAYS}
    found: dict[str, Any] = {
        name: {way: scores(home[way], hows) for way, hows in WAYS.items()}
        for name, home in {"all": every, **asked}.items()
    }
    return {**found, "grasps": compared(seen, kb)}


def table(result: dict[str, Any]) -> Iterator[str]:
    """Some lines per home and way of asking, then the bins of all."""
    for home, ways in result.items():
        if home == "grasps":
            continue
        for way, found in ways.items():
            yield f"{home}, {way}: {found['things']} things among {found['regions']} regions"
            yield from _lines(found)
    for way, found in result["all"].items():
        for b in found["bins"]:
            yield (
                f"  {way}, {b['from']:g} to {b['to']:g}: {b['regions']} regions, "
                f"told {b['told']:.3f}, true {b['true']:.3f}"
            )
    for name, value in result["grasps"].items():
        yield f"grasps, {name}: {value}"


def _lines(found: dict[str, Any]) -> Iterator[str]:
    for name in ("rank", "rank, no order", "rank, largest first"):
        yield f"  {name}: " + ", ".join(f"{k} {v:g}" for k, v in found[name].items())
    yield f"  p of the true place {found['probability of the true place']:.3f}"
    listed = f"of {found['listed']} listed regions with one"
    yield f"  {listed}: expected {found['expected']}, true {found['true']}"
    yield f"  Brier {found['Brier']:.4f}; {found['Brier, always the share']:.4f} always the share"
    yield f"  calibration error {found['calibration error']:.4f}"
    yield f"  somewhere: told {found['somewhere']:.2f}, true {found['somewhere, true']:.2f}"
