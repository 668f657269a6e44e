"""What else is there, given what was seen: duals and co-occurrences as conditional tables."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from afkb.errors import EvidenceError
from afkb.inference.bands import Array
from afkb.knowledge import COUNTED, AfNet, CoOccurrence


@dataclass(frozen=True, slots=True, eq=False)
class RelationshipNetwork:
    """Seen → predicted, one conditional table per statement of the ontology.

    - `duals`: dual to P(predicted is there | its evidence is there) (paper §II.D.ii).
    - `rules`: co-occurrence rule to (C,) P(predicted is there | category of the seen thing): the
      rule's strength, or that of the strongest listed pair of the same feature whose predicted
      category is of the rule's predicted class, for the category or else the nearest broader one
      that has one (paper §II.D.iii).
    """

    categories: tuple[str, ...]
    duals: Mapping[str, float]
    rules: Mapping[str, Array]

    @classmethod
    def compile(cls, kb: AfNet) -> RelationshipNetwork:
        """The tables of the duals and co-occurrences that the ontology states."""
        names = tuple(kb.categories)
        rules: dict[str, Array] = {}
        for rule in (c for c in kb.co_occurrences if c.is_rule):
            listed: dict[str | None, float] = {}
            for pair in kb.co_occurrences:
                if _modulates(pair, rule, kb):
                    strongest = max(pair.strength, listed.get(pair.evidence_category, 0.0))
                    listed[pair.evidence_category] = strongest
            strengths = [
                next((listed[k] for k in kb.kinds_of(name) if k in listed), rule.strength)
                for name in names
            ]
            rules[rule.name] = np.array(strengths)
        return cls(names, {d.name: d.strength for d in kb.duals}, rules)

    def dual(self, name: str) -> float:
        """P(the predicted thing is there) by one dual, its evidence seen, however often."""
        if name not in self.duals:
            raise EvidenceError(
                f"{name!r} is no dual of the ontology; there are: {_list(self.duals)}"
            )
        return self.duals[name]

    def co_occurrence(self, name: str, category: Mapping[str, float]) -> float:
        """P(the predicted thing is there) by a rule, given the seen thing's category posterior."""
        if name not in self.rules:
            raise EvidenceError(
                f"{name!r} is no co-occurrence rule of the ontology; there are: {_list(self.rules)}"
            )
        weights = np.array([category.get(c, 0.0) for c in self.categories])
        total = float(weights.sum())
        if not total > 0:
            raise EvidenceError("the category posterior of the seen thing is empty")
        return float(self.rules[name] @ weights / total)


def _modulates(pair: CoOccurrence, rule: CoOccurrence, kb: AfNet) -> bool:
    """Whether a listed pair speaks of what a rule predicts: a typical one is of its class.

    A pair counted in homes doesn't: it says what a room holds, the rule what is near.
    """
    if pair.is_rule or pair.feature != rule.feature or pair.status == COUNTED:
        return False
    category = kb.categories[pair.predicted_category or ""]
    if category.top_height_m is None:
        return False
    length, width, height, top = (
        sum(ends) / 2
        for ends in (category.length_m, category.width_m, category.height_m, category.top_height_m)
    )
    return kb.evidence_classes[rule.predicted_class or ""].holds((length, width, height), top)


def _list(names: Mapping[str, object]) -> str:
    return ", ".join(names) or "none"
