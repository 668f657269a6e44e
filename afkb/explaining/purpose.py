"""Why a room is held for what it is: what was counted in it, and what each thing counts for."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from afkb.explaining.chain import Array, Belief, Chain, Row, WhatIf, if_otherwise
from afkb.explaining.source import Source, of_count, of_room_prior
from afkb.flow import Entity
from afkb.inference import Network
from afkb.inference.recognition import evidence_of

Counts = Mapping[str, int]
FAINTEST = 1e-12
"""A belief below this is taken as this where the belief that it became is compared with it."""


def purpose(network: Network, counts: Counts, stored: Belief, things: Sequence[Entity]) -> Chain:
    """The chain from the rooms of a home to what the room is for.

    How much of a room was seen is hidden in the network, so that each row is the likelihood of a
    count given those above it. `things`: that are in the room.
    """
    kb = network.knowledge_base
    states = tuple(network.room_posterior({}))
    before = _shares(network, {}, states)
    prior, rows = before, []
    for number, name in enumerate(sorted(counts), start=1):
        told = dict(sorted(counts.items())[:number])
        after = _shares(network, told, states)
        rows.append(_row(network, name, counts[name], after / np.maximum(before, FAINTEST)))
        before = after
    chain = Chain(states, prior, lambda room: (of_room_prior(kb, room),), tuple(rows), stored)
    what_if = tuple(_otherwise(network, counts, things))
    return Chain(states, prior, chain.prior_sources, chain.rows, stored, what_if)


def _shares(network: Network, counts: Counts, states: Sequence[str]) -> Array:
    posterior = network.room_posterior(counts)
    return np.array([posterior[state] for state in states])


def _row(network: Network, name: str, count: int, likelihood: Array) -> Row:
    kb = network.knowledge_base

    def sources(room: str) -> tuple[Source, ...]:
        found = of_count(kb, room, name)
        return () if found is None else (found,)

    observed = str(count) if count else "none, looked for"
    return Row(name, observed, likelihood / likelihood.max(), sources)


def _otherwise(network: Network, counts: Counts, things: Sequence[Entity]) -> Iterator[WhatIf]:
    """Without each thing, with one more of each class, and with each class not looked for."""
    before = network.room_posterior(counts)
    for thing in things:
        for_classes = evidence_of(thing, network)
        fewer = {n: c - (n in for_classes) for n, c in counts.items()}
        if fewer != dict(counts) and all(c >= 0 for c in fewer.values()):
            what = f"without {thing.id}, which counts as {' and '.join(for_classes)}"
            yield if_otherwise(what, before, network.room_posterior(fewer))
    for name in network.rooms.counts:
        more = {**counts, name: counts.get(name, 0) + 1}
        yield if_otherwise(f"with one more {name}", before, network.room_posterior(more))
        if name in counts:
            rest = {n: c for n, c in counts.items() if n != name}
            what = f"without any word of {name}"
            yield if_otherwise(what, before, network.room_posterior(rest))
