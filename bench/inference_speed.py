"""What inference takes: posteriors of a thing and of a room, and the predictions of a full view.

    python -m bench.inference_speed [--json]

CPU milliseconds, median and 95th percentile, of calls after the first ones.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections.abc import Callable

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


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--json", action="store_true")
    result = measured(PluginHost())
    if parser.parse_args().json:
        json.dump(result, sys.stdout, indent=1)
        return 0
    for what, ms in result.items():
        sys.stdout.write(f"{what:28} median {ms['median']:.2f} ms, 95 % {ms['p95']:.2f} ms\n")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
