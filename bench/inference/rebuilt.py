"""Maps built anew from what their folders remember, so that today's inference is judged on them."""

from __future__ import annotations

from pathlib import Path

from afkb.flow import TopologicalMap
from afkb.inference import network_of
from afkb.plugins.host import PluginHost
from afkb_mapping.crew import Crew
from afkb_mapping.memory.recollection import Recollection
from afkb_mapping.memory.storing import memory_of
from afkb_mapping.perception import Perception
from afkb_mapping.run_record import Stages


def rebuilt(folder: Path, host: PluginHost) -> TopologicalMap:
    """The map that this code makes of what a map folder remembers of its views.

    Detections and hypotheses are those that were remembered; what follows from them is new.
    """
    memory, stages = memory_of(folder), Stages()
    visit = memory.visits[-1]
    factory = host.mapper_factory(str(visit.parameters["mapper"]))
    crew = Crew(
        Perception([], stages),
        [],
        lambda: factory(str(visit.parameters["rule"])),
        stages,
        memory,
        Recollection(),
        network_of(host.knowledge_base),
    )
    return crew.finish(visit.T_map_source)
