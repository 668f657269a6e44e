"""What inference takes: posteriors of a thing and of a room, and the predictions of a full view.

    python -m bench.inference speed [--json]

CPU milliseconds, median and 95th percentile, of calls after the first ones; nothing is kept from
call to call, each looks at all the evidence. `pgmpy`, `pyAgrum`: variable elimination and lazy
propagation on the same tables, for a part of the network that they can hold; both must answer the
same (tests hold the closed forms to pgmpy's answers). pyAgrum comes with the extra `bench`.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Iterator, Mapping
from typing import Any

import numpy as np

from afkb.inference import Network, network_of
from afkb.inference.joint import SeenThing
from afkb.inference.pgm import COUNT_STATES, ROOM, contents_model, room_model
from afkb.inference.rooms import bin_of
from afkb.plugins.host import PluginHost
from afkb.testing import sample_detections
from bench.inference.pgm_peers import pgmpy_query, pyagrum_query

CALLS, WARM = 300, 20
CROWD = 20
"""Things in the view that predictors look at."""
SEEN = {"Chair": 4, "Table": 1, "Fridge": 1, "Stove": 1, "Sink": 1, "Cup": 3, "Microwave": 1}
"""What was recognised in the room."""
PEER_CALLS = 30


def milliseconds(call: Callable[[], object], calls: int = CALLS) -> dict[str, float]:
    """CPU time of a call."""
    taken = []
    for _ in range(calls + WARM):
        begun = time.thread_time()
        call()
        taken.append(1e3 * (time.thread_time() - begun))
    return {
        "median": float(np.median(taken[WARM:])),
        "p95": float(np.percentile(taken[WARM:], 95)),
    }


def measured(host: PluginHost) -> dict[str, dict[str, float]]:
    """By what is asked."""
    network: Network = network_of(host.knowledge_base)
    crowd = (sample_detections() * CROWD)[:CROWD]
    counts = dict.fromkeys(network.evidence_looked_for(("SupportAbility",)), 1)
    room, seen = network.room_posterior(counts, SEEN), dict(SEEN)
    things = [SeenThing({"SupportAbility": 0.9}, (1.2, 0.8, 0.7), 0.7)] + [
        SeenThing({"ContainAbility": 0.8}, (0.1, 0.1, 0.1), 0.8, on=0, stands="Support")
    ] * (CROWD - 1)
    found = {
        "category of a thing": milliseconds(
            lambda: network.category_posterior({"SupportAbility": 0.9}, (1.2, 0.8, 0.7), 0.7)
        ),
        f"categories of {CROWD} things together": milliseconds(
            lambda: network.joint.recognise(things, room)
        ),
        "purpose of a room": milliseconds(lambda: network.room_posterior(counts)),
        f"purpose of a room, {len(seen)} categories too": milliseconds(
            lambda: network.room_posterior(counts, seen)
        ),
        f"what else a room holds, all {len(network.contents_network.categories)}": milliseconds(
            lambda: network.contents(room, seen)
        ),
    }
    for predictor in host.predictors():
        found[f"{predictor.name}, {CROWD} things"] = milliseconds(
            lambda predictor=predictor: predictor.predict(crowd)
        )
    return found | by_others(network, counts)


def by_others(network: Network, counts: Mapping[str, int]) -> dict[str, dict[str, float]]:
    """The same questions, put to pgmpy and pyAgrum; `AssertionError` where answers differ."""
    evidence = {name: COUNT_STATES[bin_of(name, n)] for name, n in counts.items()}
    asked, *others = SEEN
    told = {f"{name}InRoom": "yes" for name in others}
    questions = {
        "purpose of a room": (room_model(network.rooms), ROOM, evidence),
        f"one category of {len(SEEN)}": (
            contents_model(network.contents_network.among(SEEN)),
            f"{asked}InRoom",
            told,
        ),
    }
    found = {}
    for what, (model, target, known) in questions.items():
        right = pgmpy_query(model, target, known)()
        for peer, question in (("pgmpy", pgmpy_query), ("pyAgrum", pyagrum_query)):
            try:
                ask = question(model, target, known)
            except ImportError:
                continue
            np.testing.assert_allclose(ask(), right, atol=1e-6)
            found[f"{what}, {peer}"] = milliseconds(ask, PEER_CALLS)
    return found


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """It takes no data."""


def run(args: argparse.Namespace) -> dict[str, dict[str, float]]:
    """Milliseconds by what is asked."""
    return measured(PluginHost())


def table(result: dict[str, Any]) -> Iterator[str]:
    """A line per question."""
    for what, ms in result.items():
        yield f"{what:46} median {ms['median']:.2f} ms, 95 % {ms['p95']:.2f} ms"
