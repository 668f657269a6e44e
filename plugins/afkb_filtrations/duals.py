"""Order 1: affordance duals fill holes of the map (paper §II.D.ii)."""

from __future__ import annotations

from collections.abc import Sequence

from afkb.flow import Detection, Hypothesis, Relation
from afkb.inference import Network, network_of
from afkb.knowledge import AfNet, Dual
from afkb_filtrations.localizer import Localizer
from afkb_filtrations.space import (
    SAME_LEVEL_M,
    distance_to_box,
    distance_xy,
    groups_of,
    top_height,
)

_BESIDE_M = 0.10
"""How far beyond the seen border of a support a thing may stand that it carries, m."""


class DualPredictor:
    """What is seen predicts the other half of its dual: containers, the support below them.

    Every dual of the ontology that is strong enough is used; nothing is known here of any feature.
    Things that may share what they predict (level bottoms, within its typical extent) give one
    hypothesis with all of them as anchors; its probability is the dual's, however many they are.
    What is seen in the same view is not predicted.
    """

    name = "duals"
    order = 1

    def __init__(self, knowledge_base: AfNet) -> None:
        self._knowledge_base = knowledge_base
        self._localizer = Localizer(knowledge_base)

    def predict(self, detections: Sequence[Detection]) -> list[Hypothesis]:
        """One hypothesis per group of anchors and predicted feature.

        Coarse before fine, by the scale of what is predicted; then in the ontology's order.
        """
        network = network_of(self._knowledge_base)
        faintest = self._knowledge_base.parameters["FaintestHypothesis"]
        telling = {dual.evidence for dual in self._knowledge_base.duals}
        afforded = [
            set(
                network.objects.afforded(
                    {f: d.affordances[f] for f in telling & set(d.affordances)}
                )
            )
            for d in detections
        ]
        seen = set().union(*afforded)
        duals = [
            dual
            for dual in self._knowledge_base.duals
            if dual.evidence in seen and network.relations.dual(dual.name) >= faintest
        ]
        found = [
            self._hypothesis(network, detections, group, anchors)
            for predicted, relation in dict.fromkeys((d.predicted, d.relation) for d in duals)
            for group, anchors in self._groups(
                detections,
                afforded,
                [d for d in duals if (d.predicted, d.relation) == (predicted, relation)],
            )
        ]
        return sorted(found, key=lambda hypothesis: self._localizer.rank(hypothesis.scale))

    def _groups(
        self, detections: Sequence[Detection], afforded: Sequence[set[str]], duals: list[Dual]
    ) -> list[tuple[dict[int, Dual], tuple[int, ...]]]:
        """The dual of every anchor, and which of the anchors share what they predict."""
        dual_of = {}
        for index, detection in enumerate(detections):
            dual = _applying(detection, afforded[index], duals)
            if dual and not any(_is_it(detection, other, dual) for other in detections):
                dual_of[index] = dual

        def share(a: int, b: int) -> bool:
            dual = dual_of[a]
            reach = max(dual.size_xy_m) if dual.relation == "below" else 2 * dual.distance_m[0]
            near = distance_xy(detections[a], detections[b]) <= reach
            level = abs(detections[a].box.bottom - detections[b].box.bottom) <= SAME_LEVEL_M
            return near and (level or dual.relation != "below")

        by_level = sorted(dual_of, key=lambda i: (detections[i].box.bottom, i))
        return [(dual_of, group) for group in groups_of(by_level, share)]

    def _hypothesis(
        self,
        network: Network,
        detections: Sequence[Detection],
        dual_of: dict[int, Dual],
        anchors: tuple[int, ...],
    ) -> Hypothesis:
        dual = max(
            (dual_of[i] for i in anchors),
            key=lambda d: (network.relations.dual(d.name), d.name),
        )
        return Hypothesis(
            predictor=self.name,
            order=self.order,
            relation=Relation(dual.relation),
            anchors=tuple(sorted(anchors)),
            affordances={dual.predicted: 1.0},
            scale=dual.predicted_scale,
            probability=network.relations.dual(dual.name),
            axiom=dual.iri,
            distance_m=dual.distance_m,
            size_xy_m=dual.size_xy_m,
        )


def _applying(detection: Detection, afforded: set[str], duals: list[Dual]) -> Dual | None:
    """The dual whose evidence the detection affords; of several, that of the narrowest feature."""
    fitting = [
        d
        for d in duals
        if d.evidence in afforded and detection.box.bottom >= d.evidence_bottom_min_m
    ]
    return max(fitting, key=lambda d: (d.strength, d.name), default=None)


def _is_it(anchor: Detection, other: Detection, dual: Dual) -> bool:
    """Whether the other detection is what the anchor would predict."""
    if other is anchor or not other.affords(dual.predicted):
        return False
    if dual.relation == "below":
        level = abs(top_height(other, dual.predicted) - anchor.box.bottom) <= SAME_LEVEL_M
        return level and distance_to_box(anchor, other) <= _BESIDE_M
    if dual.relation == "on":
        level = abs(other.box.bottom - top_height(anchor, dual.evidence)) <= SAME_LEVEL_M
        return level and distance_to_box(other, anchor) <= _BESIDE_M
    return distance_to_box(anchor, other) <= dual.distance_m[0] + 2 * dual.distance_m[1]
