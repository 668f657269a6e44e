"""What inference takes: posteriors of a thing and of a room, and the predictions of a full view.

    python -m bench.inference speed [--json]

CPU milliseconds, median and 95th percentile, of calls after the first ones.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from afkb.inference import Network, network_of
from afkb.plugins.host import PluginHost
from afkb.testing import sample_detections

CALLS, WARM = 300, 20
CROWD = 20
"""Things in the view that predictors look at."""


def milliseconds(call: Callable[[], object]) -> dict[str, float]:
    """CPU time of a call."""
    taken = []
    for _ in range(CALLS + WARM):
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
    found = {
        "category of a thing": milliseconds(
            lambda: network.category_posterior({"SupportAbility": 0.9}, (1.2, 0.8, 0.7), 0.7)
        ),
        "purpose of a room": milliseconds(lambda: network.room_posterior(counts)),
    }
    for predictor in host.predictors():
        found[f"{predictor.name}, {CROWD} things"] = milliseconds(
            lambda predictor=predictor: predictor.predict(crowd)
        )
    return found


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """It takes no data."""


def run(args: argparse.Namespace) -> dict[str, dict[str, float]]:
    """Milliseconds by what is asked."""
    return measured(PluginHost())


def table(result: dict[str, Any]) -> Iterator[str]:
    """A line per question."""
    for what, ms in result.items():
        yield f"{what:28} median {ms['median']:.2f} ms, 95 % {ms['p95']:.2f} ms"
