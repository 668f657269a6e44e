"""Order 0: what supports and what contains, coarse before fine (paper §II.D.i)."""

from __future__ import annotations

from collections.abc import Sequence

from afkb.flow import Detection
from afkb.knowledge import AfNet

LOCALIZERS = ("SupportAbility", "ContainAbility")
"""The paper's primal filtration; narrower features of the ontology are theirs, too."""


class Localizer:
    """Finds, among what was detected, the entities that the higher orders start from.

    It predicts nothing: supports and containers are seen. It says in which order they matter: the
    search for obstacles goes from coarse scales to fine ones (§II.D), and so what follows from a
    table is expected before what follows from a cup.
    """

    order = 0

    def __init__(self, knowledge_base: AfNet) -> None:
        self._knowledge_base = knowledge_base
        self._ranks = {name: rank for rank, name in enumerate(reversed(knowledge_base.scales))}

    def localized(self, detections: Sequence[Detection]) -> list[int]:
        """Indexes of the detections that support or contain, coarse before fine."""
        found = [i for i, d in enumerate(detections) if self._is_localized(d)]
        return sorted(found, key=lambda i: (self._rank_of(detections[i]), i))

    def coarse_first(self, detections: Sequence[Detection]) -> list[int]:
        """Indexes of all detections: what is localized, coarse before fine, then all else."""
        first = dict.fromkeys(self.localized(detections))
        return [*first, *(i for i in range(len(detections)) if i not in first)]

    def rank(self, scale: str) -> int:
        """0 of the coarsest scale, rising; of a scale that the ontology lacks, the last."""
        return self._ranks.get(scale, len(self._ranks))

    def _is_localized(self, detection: Detection) -> bool:
        kb = self._knowledge_base
        return any(
            detection.affords(name) and self._is_kind_of_localizer(name)
            for name in detection.affordances
            if name in kb.features
        )

    def _is_kind_of_localizer(self, name: str | None) -> bool:
        features = self._knowledge_base.features
        while name is not None:
            if name in LOCALIZERS:
                return True
            name = features[name].broader if name in features else None
        return False

    def _rank_of(self, detection: Detection) -> int:
        return self.rank(self._knowledge_base.scale_of(detection.box.size_xyz))
