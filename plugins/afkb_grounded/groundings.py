"""The groundings that the ontology states, ready to be held against measures."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from afkb.knowledge import AfNet
from afkb.ontology.names import BY_MEASURES, BY_PRIOR, BY_WEAK_MEASURES
from afkb_mapping.trapezoids import Limits, membership, parameters


@dataclass(frozen=True, slots=True)
class Grounding:
    """What a feature asks of the measures of a thing of one of these kinds."""

    feature: str
    kinds: frozenset[str]
    strength: float
    limits: Mapping[str, Limits]
    is_weak: bool

    def probability(self, measures: Mapping[str, float]) -> float:
        """Strength times how well the worst measure fits; 0 where one of them is unknown.

        The least membership (Zadeh's intersection), not the product: measures hang together, as
        length, width and area do, and one defect must not count three times; nor does a grounding
        become less probable by naming one more measure that fits.
        """
        p = self.strength
        for name, limits in self.limits.items():
            value = measures.get(name)
            if value is None:
                return 0.0
            p = min(p, self.strength * membership(value, limits))
            if p <= 0:
                return 0.0
        return float(p)


def groundings_of(knowledge_base: AfNet) -> list[Grounding]:
    """Every feature that is grounded by measures, weak ones included, in order of name."""
    by_measures = {BY_MEASURES, BY_WEAK_MEASURES}
    return [
        Grounding(
            feature=feature.name,
            kinds=frozenset(feature.grounded_on),
            strength=feature.grounding_strength,
            limits=parameters(knowledge_base, feature.name),
            is_weak=feature.is_weak,
        )
        for feature in knowledge_base.features.values()
        if by_measures & set(feature.grounded_by) and feature.parameters
    ]


def priors_of(knowledge_base: AfNet) -> dict[str, float]:
    """Features that follow from what a thing probably is, to the strength of saying so."""
    return {
        feature.name: feature.grounding_strength
        for feature in knowledge_base.features.values()
        if BY_PRIOR in feature.grounded_by
    }


def by_kind(groundings: Iterable[Grounding]) -> dict[str, list[Grounding]]:
    """What each kind of thing may afford."""
    found: dict[str, list[Grounding]] = {}
    for grounding in groundings:
        for kind in sorted(grounding.kinds):
            found.setdefault(kind, []).append(grounding)
    return found


def afforded(groundings: Iterable[Grounding], measures: Mapping[str, float]) -> dict[str, float]:
    """Feature to probability, of a thing with these measures; none that are 0."""
    found = ((grounding.feature, grounding.probability(measures)) for grounding in groundings)
    return {feature: p for feature, p in found if p > 0}
