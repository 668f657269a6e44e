"""Every feature that the ontology grounds, held against the measures of what was seen."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property

from afkb.flow import Detection, View
from afkb.inference import network_of
from afkb.knowledge import AfNet
from afkb.ontology.names import BY_DETECTOR
from afkb_grounded.bodies import body_measures
from afkb_grounded.clearance import add_clearances
from afkb_grounded.groundings import Grounding, afforded, by_kind, groundings_of, priors_of
from afkb_grounded.openings import (
    gap_measures,
    opening_measures,
    surface_measures,
    upright_measures,
)
from afkb_grounded.priors import CategoryPriors
from afkb_grounded.seen import BODY, GAP, OPENING, PART, SURFACE, Seen, things_of
from afkb_grounded.uprights import parts_of

LEAST_CLAIM = 0.1
"""Nothing is said of what is less probable: not to be found is no evidence for a hint."""
CUT = 0.8
"""How often a surface that isn't seen whole, as most seats at a table, is of the size it looks
(judged)."""

NO_HOLLOW = {"depth_m": 0.0, "depth_over_opening": 0.0}
"""Of a body in which no hollow was seen."""


class GroundedDetector:
    """Says what else the things of a view afford, by the groundings of the ontology.

    It knows no feature by name: the ontology's `groundedOn`, its fuzzy ranges and strengths decide,
    those of extensions among them. It adds to earlier detections (`about`).
    """

    name = "grounded"
    stage = 3

    def __init__(self, knowledge_base: AfNet) -> None:
        self._knowledge_base = knowledge_base

    @cached_property
    def _groundings(self) -> list[Grounding]:
        return groundings_of(self._knowledge_base)

    @cached_property
    def _by_kind(self) -> dict[str, list[Grounding]]:
        return by_kind(self._groundings)

    @cached_property
    def _told_by(self) -> dict[str, str]:
        features = self._knowledge_base.features.values()
        return {
            feature.name: feature.grounded_on[0]
            for feature in features
            if BY_DETECTOR in feature.grounded_by and feature.grounded_on
        }

    @cached_property
    def _weak(self) -> frozenset[str]:
        features = self._knowledge_base.features.values()
        return frozenset(feature.name for feature in features if feature.is_weak)

    @cached_property
    def _priors(self) -> CategoryPriors:
        base = self._knowledge_base
        return CategoryPriors(network_of(base), priors_of(base))

    @cached_property
    def affordances(self) -> tuple[str, ...]:
        """Names of the features that are grounded by measures or by what things are."""
        by_measures = (grounding.feature for grounding in self._groundings)
        return tuple(sorted({*by_measures, *priors_of(self._knowledge_base)}))

    def detect(self, view: View, earlier: Sequence[Detection]) -> list[Detection]:
        """What each thing affords besides; weak hints apart, with the measure `weak`."""
        things = things_of(earlier, self._told_by)
        things += parts_of(things, view)
        measures = [measures_of(thing, view) if self._may(thing) else {} for thing in things]
        add_clearances(things, measures, view)
        solid = [i for i, thing in enumerate(things) if {BODY, SURFACE} & set(thing.kinds)]
        priors = self._priors.afforded([things[i] for i in solid])
        by_thing = dict(zip(solid, priors, strict=True))
        found = []
        for i, thing in enumerate(things):
            if not measures[i]:
                continue
            found += self._told(thing, measures[i], by_thing.get(i, {}))
        return found

    def _may(self, thing: Seen) -> list[Grounding]:
        """What a thing may afford."""
        found = {g.feature: g for kind in thing.kinds for g in self._by_kind.get(kind, ())}
        return list(found.values())

    def _told(
        self, thing: Seen, measures: Mapping[str, float], prior: Mapping[str, float]
    ) -> list[Detection]:
        first = thing.first
        certain = sureness(thing)
        says = {f: certain * p for f, p in
                afforded(self._may(thing), measures).items()}  # fmt: skip
        for feature, p in prior.items():
            says[feature] = max(certain * p, says.get(feature, 0.0))
        says = {f: p for f, p in sorted(says.items()) if p >= LEAST_CLAIM}
        firm = {f: p for f, p in says.items() if f not in self._weak}
        weak = {f: p for f, p in says.items() if f in self._weak}
        found = []
        for affordances, more in ((firm, {}), (weak, {"weak": 1.0})):
            if affordances:
                found.append(
                    replace(
                        first,
                        detector=self.name,
                        affordances=affordances,
                        measures={**measures, **more},
                        about=thing.index,
                        pixels=None,
                        primitive=None,
                    )
                )
        return found


def sureness(thing: Seen) -> float:
    """Probability that there is a thing of these measures at all.

    A body or surface affords nothing more surely than it is one; what isn't seen whole may be
    larger, which the detector of bodies has counted already.
    """
    if PART in thing.kinds:
        return 1.0
    there = max(thing.affordances.values(), default=1.0)
    return there if BODY in thing.kinds or thing.first.seen_whole else there * CUT


def measures_of(thing: Seen, view: View) -> dict[str, float]:
    """Every measure of a thing by itself; those that a detector of the vocabulary's words gave."""
    own = dict(thing.measures)
    if PART in thing.kinds:
        return own
    first = thing.first
    if first.segment_xy is not None:
        return own | upright_measures(first)
    if SURFACE in thing.kinds:
        return own | surface_measures(first)
    if GAP in thing.kinds:
        return own | gap_measures(first)
    found = own | body_measures(first, view)
    hollow = opening_measures(thing) if OPENING in thing.kinds else NO_HOLLOW
    return found | hollow
