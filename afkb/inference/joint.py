"""The joint network of a room's things: what each is, told by what it affords and where it is."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from afkb.errors import EvidenceError
from afkb.inference.bands import Array
from afkb.inference.object_tables import boards
from afkb.inference.objects import ObjectNetwork
from afkb.inference.placement import PlacementNetwork
from afkb.inference.scene import Recognised, recognise
from afkb.knowledge import AfNet


@dataclass(frozen=True, slots=True)
class SeenThing:
    """A thing as the network takes it in.

    - `affordances`: feature to probability; those not named are unobserved, those near 0 were
      looked for and not found.
    - `size_xyz`: m; of what isn't seen `whole` at least that long and wide.
    - `on`: index of the thing that carries it, None where none was seen.
    - `stands`: on the `Floor`, on a `Support`, `Nowhere` where nothing carries it though it was
      looked for; None where nobody could tell.
    - `boarded`: whether it is a surface over or under another of the same outline.
    """

    affordances: Mapping[str, float]
    size_xyz: tuple[float, float, float]
    top_height_m: float
    whole: bool = True
    on: int | None = None
    stands: str | None = None
    boarded: bool = False


@dataclass(frozen=True, slots=True, eq=False)
class JointNetwork:
    """Room → category → features and measures; category ↔ category of what carries it.

    `boards`: (C,) P(a board of it is seen with another | category).
    """

    objects: ObjectNetwork
    placement: PlacementNetwork
    boards: Array

    @classmethod
    def compile(cls, kb: AfNet, objects: ObjectNetwork) -> JointNetwork:
        """The network of the figures that the ontology states of rooms and supports."""
        return cls(objects, PlacementNetwork.compile(kb, objects.prior), boards(kb))

    def recognise(
        self, things: Sequence[SeenThing], room: Mapping[str, float] | None = None
    ) -> Recognised:
        """Posteriors of things that are in one room; without `room` it is any one.

        `room`: belief over purposes from what else is in the room: these things' own affordances
        would count twice. Raises `EvidenceError` for unknown names and values out of range.
        """
        belief = self._of_room(room)
        if not things:
            return Recognised(np.zeros((0, len(self.objects.prior))), belief, np.zeros(0))
        evidence = np.array([self.evidence(thing) for thing in things])
        on = [thing.on for thing in things]
        told = recognise(self.placement, self.objects.prior, evidence, on, belief)
        return replace(told, context=told.context * self._standing(things, evidence))

    def _standing(self, things: Sequence[SeenThing], evidence: Array) -> Array:
        """(N,) how many times likelier a thing stands as seen than what is none does.

        What a detector took for a thing by mistake stands on anything alike.
        """
        prior, alike = self.objects.prior, 1.0 / len(self.placement.standing)
        ratios = np.ones(len(things))
        for i, thing in enumerate(things):
            if thing.stands is not None:
                anywhere = self.evidence(replace(thing, stands=None)) @ prior
                ratios[i] = evidence[i] @ prior / (anywhere * alike)
        return ratios

    def evidence(self, thing: SeenThing) -> Array:
        """P(what was seen of a thing | category), (C,), but for a factor that all share."""
        of = (thing.affordances, thing.size_xyz, thing.top_height_m, thing.whole)
        likelihood = self.objects.likelihood(*of)
        if thing.stands is not None:
            if thing.stands not in self.placement.standing:
                known = ", ".join(self.placement.standing)
                raise EvidenceError(f"a thing stands on {thing.stands!r}; expected one of {known}")
            likelihood = likelihood * self.placement.standing[thing.stands]
        return likelihood * self.boards if thing.boarded else likelihood

    def _of_room(self, room: Mapping[str, float] | None) -> Array:
        rooms = self.placement.rooms
        if room is None:
            return np.full(len(rooms), 1.0 / len(rooms))
        unknown = sorted(set(room) - set(rooms))
        if unknown:
            raise EvidenceError(
                f"{unknown[0]!r} is no room category; there are: {', '.join(rooms)}"
            )
        weights = np.array([room.get(name, 0.0) for name in rooms])
        if not (weights >= 0).all() or not weights.sum() > 0:
            raise EvidenceError("the belief about the room is no distribution over room categories")
        return np.asarray(weights / weights.sum())
