"""Order 2: the same affordance at a larger scale nearby (paper §II.D.iii)."""

from __future__ import annotations

from collections.abc import Sequence

from afkb.flow import Detection, Hypothesis, Relation
from afkb.inference import Network, network_of
from afkb.knowledge import AfNet, CoOccurrence, EvidenceClass
from afkb_filtrations.localizer import Localizer
from afkb_filtrations.space import distance_to_box, distance_xy, groups_of, top_height


class CoOccurrencePredictor:
    """A seen thing predicts a larger one with the same affordance: a chair, a table near it.

    The rules, their features, sizes, distances and strengths are the ontology's. A rule is silent
    where a larger thing of the predicted kind is seen near enough in the same view.
    """

    name = "co-occurrence"
    order = 2

    def __init__(self, knowledge_base: AfNet) -> None:
        self._knowledge_base = knowledge_base
        self._localizer = Localizer(knowledge_base)

    def predict(self, detections: Sequence[Detection]) -> list[Hypothesis]:
        """One hypothesis per rule and group of things that may stand about the same larger one."""
        network = network_of(self._knowledge_base)
        return [
            hypothesis
            for rule in self._knowledge_base.co_occurrences
            if rule.is_rule
            for hypothesis in self._of_rule(network, rule, detections)
        ]

    def _of_rule(
        self, network: Network, rule: CoOccurrence, detections: Sequence[Detection]
    ) -> list[Hypothesis]:
        faintest = self._knowledge_base.parameters["FaintestHypothesis"]
        probability = {}
        for index in self._localizer.coarse_first(detections):
            detection = detections[index]
            if self._applies(network, rule, detection) and not any(
                self._is_it(rule, detection, other) for other in detections
            ):
                p = _probability(network, rule, detection)
                if p >= faintest:
                    probability[index] = p
        reach = 2 * rule.distance_m[0]
        groups = groups_of(
            list(probability), lambda a, b: distance_xy(detections[a], detections[b]) <= reach
        )
        return [
            self._hypothesis(network, rule, group, max(probability[i] for i in group))
            for group in groups
        ]

    def _applies(self, network: Network, rule: CoOccurrence, detection: Detection) -> bool:
        if not detection.affords(rule.feature):
            return False
        scales = list(self._knowledge_base.scales)
        scale = self._knowledge_base.scale_of(_surface(detection))
        top = top_height(detection, rule.feature)
        classes = network.evidence_of(
            network.known(detection.affordances), detection.box.size_xyz, top
        )
        larger = scales.index(rule.predicted_scale) > scales.index(scale)
        return larger and rule.evidence_class in classes

    def _is_it(self, rule: CoOccurrence, anchor: Detection, other: Detection) -> bool:
        """Whether the other is the larger thing: same affordance, its height, near enough."""
        low, high = self._predicted_class(rule).top_height_m
        return (
            other is not anchor
            and other.affords(rule.feature)
            and low <= top_height(other, rule.feature) < high
            and max(other.box.size_xyz[:2]) > max(anchor.box.size_xyz[:2])
            and distance_to_box(anchor, other) <= rule.distance_m[0] + 2 * rule.distance_m[1]
        )

    def _hypothesis(
        self, network: Network, rule: CoOccurrence, anchors: tuple[int, ...], probability: float
    ) -> Hypothesis:
        heights = self._predicted_class(rule).top_height_m
        return Hypothesis(
            predictor=self.name,
            order=self.order,
            relation=Relation.NEAR,
            anchors=tuple(sorted(anchors)),
            affordances={rule.feature: 1.0},
            scale=rule.predicted_scale,
            probability=probability,
            axiom=rule.iri,
            distance_m=rule.distance_m,
            size_xy_m=rule.size_xy_m,
            top_height_m=heights,
        )

    def _predicted_class(self, rule: CoOccurrence) -> EvidenceClass:
        return self._knowledge_base.evidence_classes[str(rule.predicted_class)]


def _probability(network: Network, rule: CoOccurrence, detection: Detection) -> float:
    """By the rule, over what the detection may be."""
    category = network.category_posterior(
        network.known(detection.affordances),
        detection.box.size_xyz,
        top_height(detection, rule.feature),
        detection.seen_whole,
    )
    return network.relations.co_occurrence(rule.name, category)


def _surface(detection: Detection) -> tuple[float, float, float]:
    """Size of the upper surface alone: what was seen, whatever is assumed below it, m."""
    return (*detection.box.size_xyz[:2], 0.0)
