"""Why a thing is held for what it is: the chain of the network's rows, and what else would say."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np

from afkb.explaining.chain import (
    Array,
    Chain,
    Row,
    WhatIf,
    as_belief,
    if_otherwise,
    left_out,
    normalised,
)
from afkb.explaining.rows import own_rows
from afkb.explaining.source import of_prior
from afkb.explaining.surroundings import surrounding_rows
from afkb.flow import Entity
from afkb.inference import Network
from afkb.inference.joint import SeenThing
from afkb.inference.recognition import standing_together

Counts = Mapping[str, Mapping[str, int]]
"""Room to what was counted in it."""


def recognition(
    network: Network, entity: Entity, entities: Sequence[Entity], counts: Counts
) -> Chain:
    """The chain from the shares of categories in a home to what a seen thing is held for.

    `entities`: all of the map, of which some carry others; `counts`: of its rooms.
    """
    groups = standing_together(entities, lambda room: counts.get(room or "", {}), network)
    together = next(t for t in groups if any(e.id == entity.id for e in t.entities))
    at = next(i for i, e in enumerate(together.entities) if e.id == entity.id)
    rows = [
        *own_rows(network, together.things[at]),
        *surrounding_rows(network, together, at),
    ]
    return _chain(network, rows, together.things[at], entity)


def expectation(network: Network, entity: Entity, relation: str) -> Chain:
    """The same of a prediction: by what it would afford, and how high and large it would be.

    How far what is below or on its anchors reaches is unobserved.
    """
    width, depth, _ = entity.size_xyz
    size = (width, depth, 0.0) if relation == "near" else (0.0, 0.0, 0.0)
    thing = SeenThing(network.known(entity.affordances), size, entity.position_xyz[2])
    return _chain(network, own_rows(network, thing), thing, entity)


def _chain(network: Network, rows: Sequence[Row], thing: SeenThing, entity: Entity) -> Chain:
    kb, objects = network.knowledge_base, network.objects
    chain = Chain(
        states=objects.categories,
        prior=objects.prior,
        prior_sources=lambda category: (of_prior(kb, category),),
        rows=tuple(rows),
        stored=entity.category_belief,
    )
    return replace(chain, what_if=(*left_out(chain), *_if_looked_for(network, chain, thing)))


def _if_looked_for(network: Network, chain: Chain, thing: SeenThing) -> Iterator[WhatIf]:
    """What a look for each further feature would change, seen or missed, were it certain."""
    posterior = chain.posterior
    now = np.array([posterior[state] for state in chain.states])
    observed = thing.affordances
    implied = {b for f, p in observed.items() if p > 0.5 for b in network.objects.implied[f]}
    for name, reported in network.objects.features.items():
        if name in observed or name in implied or not network.known({name: 1.0}):
            continue
        narrower = _without(chain, network.objects.implied[name])
        for what, likelihood, base in (
            (f"if {name} were seen", reported, narrower),
            (f"if {name} were looked for and missing", 1.0 - reported, now),
        ):
            after = as_belief(chain.states, normalised(base * likelihood))
            yield if_otherwise(what, posterior, after, float(now @ likelihood))


def _without(chain: Chain, names: frozenset[str]) -> Array:
    """The belief without rows that a narrower feature, once seen, makes none of their own."""
    weights = chain.prior
    for row in chain.rows:
        if row.name not in names:
            weights = weights * row.likelihood
    return normalised(weights)
