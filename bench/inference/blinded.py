"""Maps of recordings in which some supports were never detected, so that they must be predicted."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from afkb.flow import Detection, TopologicalMap
from afkb.plugins.host import PluginHost
from afkb_mapping.memory.storing import memory_of

SUPPORT = "SupportAbility"


def blinded(
    folder: Path, host: PluginHost, hides: Callable[[Detection], bool], rule: str = "log-odds"
) -> TopologicalMap:
    """The map of what a map folder remembers, without the detections that `hides` says.

    What follows from the rest is predicted anew. What hid depth still hides it, so a hidden thing
    isn't seen to be absent.
    """
    memory = memory_of(folder)
    visit = memory.visits[-1]
    mapper = host.mapper_factory(str(visit.parameters["mapper"]))(rule)
    predictors = host.predictors()
    for seen in memory.settled_views:
        kept = tuple(_unaware(d) for d in seen.detections if not hides(d))
        hypotheses = [h for predictor in predictors for h in predictor.predict(kept)]
        mapper.add(seen.view, kept, hypotheses)
    return replace(mapper.finish(visit.T_map_source), trajectory=memory.trajectory)


def nothing(detection: Detection) -> bool:
    """Hides nothing."""
    return False


def tops_of_tables(detection: Detection) -> bool:
    """Hides whatever supports from 0.58 m to 1.08 m: side tables, tables and counters."""
    return detection.affords(SUPPORT) and 0.58 <= float(detection.position_xyz[2]) < 1.08


def _unaware(detection: Detection) -> Detection:
    """The same detection without what it tells of the support that it stands on."""
    measures = {k: v for k, v in detection.measures.items() if k != "support_height"}
    return replace(detection, measures=measures)
