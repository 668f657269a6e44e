"""The Bayesian network, compiled from the knowledge base and from nothing else."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache
from pathlib import Path

import numpy as np

from afkb.errors import EvidenceError
from afkb.inference.contents import ContentsNetwork
from afkb.inference.holdings import Stated
from afkb.inference.joint import JointNetwork
from afkb.inference.objects import ObjectNetwork
from afkb.inference.relations import RelationshipNetwork
from afkb.inference.rooms import RoomNetwork
from afkb.knowledge import SOMETHING_ELSE, AfNet, EvidenceClass

SIZE_AND_PLACE = ("dimensions", "clearance", "proximity", "orientation")
"""Primitives of measures that the network observes by itself, or that tell of no kind of thing."""


@dataclass(frozen=True, eq=False)
class Network:
    """Posteriors over what things are, what else is there, and what rooms are for.

    Exact: closed forms of the networks that `afkb.inference.pgm` writes out for pgmpy; its variable
    elimination is the tests' oracle. Those of what rooms hold and of what stands together are
    compiled when they are first asked.
    """

    knowledge_base: AfNet
    objects: ObjectNetwork
    rooms: RoomNetwork
    relations: RelationshipNetwork

    @classmethod
    def compile(cls, kb: AfNet) -> Network:
        """Compile the network of a knowledge base; the same base gives the same network."""
        return cls(
            kb, ObjectNetwork.compile(kb), RoomNetwork.compile(kb), RelationshipNetwork.compile(kb)
        )

    def known(self, affordances: Mapping[str, float]) -> dict[str, float]:
        """Those affordances that tell what a thing is, beside its size and height.

        A stranger's detector may report what the ontology doesn't have. A feature that is but
        hinted at follows from what the thing may be, or is too faint: it is no evidence of that.
        What size, height and clearance alone decide, as a seat, is none of its own beside them.
        """
        return {
            name: p
            for name, p in affordances.items()
            if name in self.knowledge_base.features
            and name not in self._told_by_size
            and not self.knowledge_base.features[name].is_weak
        }

    @cached_property
    def _told_by_size(self) -> frozenset[str]:
        """Features that measures of size and place decide."""
        measures = self.knowledge_base.measures
        return frozenset(
            feature.name
            for feature in self.knowledge_base.features.values()
            if feature.by_measures_alone
            and feature.parameters
            and all(
                name in measures and measures[name].primitive in SIZE_AND_PLACE
                for name in feature.parameters
            )
        )

    @cached_property
    def joint(self) -> JointNetwork:
        """The network of all things of a room together, with the room and what carries them."""
        return JointNetwork.compile(self.knowledge_base, self.objects)

    def category_posterior(
        self,
        affordances: Mapping[str, float],
        size_xyz: tuple[float, float, float],
        top_height_m: float,
        whole: bool = True,
    ) -> dict[str, float]:
        """P(object category | affordances, size, height of its top), summing to 1.

        `affordances`: feature to probability; those not named are unobserved, those near 0 were
        looked for and not found. `size_xyz`: m, of what isn't seen `whole` at least that long and
        wide. `SomethingElse` is among the keys.
        Raises `EvidenceError` for unknown features and values out of range.
        """
        return self.objects.posterior(affordances, size_xyz, top_height_m, whole)

    def movability(self, posterior: Mapping[str, float]) -> tuple[str, float]:
        """`Static` or `Dynamic`, whichever is more probable, and the mean weight of that kind.

        Dynamic things weigh about 0.3 when maps are matched (paper §II.D.i).
        """
        share = {"Static": 0.0, "Dynamic": 0.0}
        weight = {"Static": 0.0, "Dynamic": 0.0}
        for name, p in posterior.items():
            category = self.knowledge_base.categories.get(name)
            if category is None:
                raise EvidenceError(f"{name!r} is no object category of the ontology")
            if name != SOMETHING_ELSE or len(posterior) == 1:
                share[category.movability] += p
                weight[category.movability] += p * category.matching_weight
        kind = "Dynamic" if share["Dynamic"] > share["Static"] else "Static"
        if not share[kind] > 0:
            other = self.knowledge_base.categories[SOMETHING_ELSE]
            return other.movability, other.matching_weight
        return kind, weight[kind] / share[kind]

    def evidence_of(
        self,
        affordances: Mapping[str, float],
        size_xyz: tuple[float, float, float],
        top_height_m: float,
    ) -> tuple[str, ...]:
        """Names of the evidence classes that such a thing counts for, in order of name.

        It counts once for each feature that it affords, for the class that asks for the largest
        surface; and by its narrowest features that are counted: a closed package, which is also a
        container, counts as closed.
        """
        self.objects.check(affordances, size_xyz, top_height_m)
        counted = {evidence.feature for evidence in self.knowledge_base.evidence_classes.values()}
        found: dict[str, EvidenceClass] = {}
        for evidence in self.knowledge_base.evidence_classes.values():
            if evidence.holds(size_xyz, top_height_m):
                other = found.setdefault(evidence.feature, evidence)
                if evidence.least_area_m2 > other.least_area_m2:
                    found[evidence.feature] = evidence
        afforded = self.objects.afforded({f: p for f, p in affordances.items() if f in counted})
        return tuple(sorted(found[feature].name for feature in afforded if feature in found))

    def evidence_looked_for(self, features: Iterable[str]) -> tuple[str, ...]:
        """The counted evidence classes that detectors of these features can report, by name.

        Where the robot stood in a room, count those 0 rather than leave them unobserved: how much
        of the room it saw is a hidden variable of the network. Name only features whose detectors
        overlook little, as of supports.
        """
        classes = self.knowledge_base.evidence_classes
        looked = set(features)
        return tuple(name for name in self.rooms.counts if classes[name].feature in looked)

    def room_posterior(
        self, counts: Mapping[str, int], categories: Mapping[str, int] | None = None
    ) -> dict[str, float]:
        """P(room category | counts of evidence classes), summing to 1 (paper §II.F).

        Classes absent from `counts` are unobserved; 0 says that they were looked for in vain.
        `categories`: how many things of each object category were recognised; of those not named
        nothing is said, 0 says that they were looked for in vain. A thing that counts here should
        not be counted again by its class. `UnknownRoom` is among the keys.
        Raises `EvidenceError` for unknown names, bad numbers, and what no room can hold.
        """
        if categories is None:
            return self.rooms.posterior(counts)
        joint = self.rooms.likelihood(counts) * self.rooms.joint_prior
        found = self.contents_network.among(categories).likelihood(categories)
        weights = (joint * found).sum(axis=1)
        total = float(weights.sum())
        if not total > 0:
            raise EvidenceError(f"no room can hold {dict(counts)} with {dict(categories)}")
        return dict(zip(self.rooms.rooms, (weights / total).tolist(), strict=True))

    def contents(
        self, room: Mapping[str, float], seen: Mapping[str, int] | None = None
    ) -> dict[str, float]:
        """P(a room holds one more thing of a category, seen or not), for every object category.

        `room`: belief over room categories, all evidence in it. `seen`: recognised things by
        category: what is met together with them is likelier, and how much was found tells how much
        there is to find. Raises `EvidenceError` for unknown names and bad numbers.
        """
        network = self.contents_network
        belief = np.array([room.get(name, 0.0) for name in network.rooms])
        if set(room) - set(network.rooms) or not belief.sum() > 0:
            raise EvidenceError(f"{dict(room)} is no belief over the rooms of the ontology")
        seen = {name: number for name, number in (seen or {}).items() if number}
        found = network.among(seen).likelihood(seen)
        # What was seen is in the belief already: it tells of the share alone.
        weights = (belief / belief.sum())[:, None] / found.sum(axis=1, keepdims=True)
        return network.beside(seen, np.asarray(np.broadcast_to(weights, found.shape)))

    @cached_property
    def contents_network(self) -> ContentsNetwork:
        """What rooms hold, by the figures and co-occurrences that the ontology states."""
        return ContentsNetwork.compile(Stated.of(self.knowledge_base))

    def write_bif(self, path: Path) -> None:
        """Write the networks, as one without edges between them, in BIF."""
        from afkb.inference.pgm import write_bif

        write_bif(self, path)


@lru_cache(maxsize=8)
def network_of(kb: AfNet) -> Network:
    """The network of a knowledge base, compiled once per base."""
    return Network.compile(kb)
