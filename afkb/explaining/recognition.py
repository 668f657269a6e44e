"""Why a thing is held for what it is: what it affords and measures, row by row of the network."""

from __future__ import annotations

from collections.abc import Iterator

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
from afkb.explaining.reading import StoredThing
from afkb.explaining.source import Source, of_feature, of_measure, of_prior
from afkb.inference import Network
from afkb.inference.bands import SIZE_EDGES_M, TOP_EDGES_M
from afkb.inference.object_tables import LENGTH, TOP, WIDTH
from afkb.knowledge import AfNet


def recognition(network: Network, thing: StoredThing) -> Chain:
    """The chain from the shares of categories in a home to what the thing is held for."""
    kb, objects = network.knowledge_base, network.objects
    known = network.known(thing.affordances)
    features, bands = objects.observed(known, thing.size_xyz, thing.top_m)
    rows = [_feature_row(network, name, p) for name, p in features.items()]
    rows += [_measure_row(network, thing, name, band) for name, band in bands.items()]
    chain = Chain(
        states=objects.categories,
        prior=objects.prior,
        prior_sources=lambda category: (of_prior(kb, category),),
        rows=tuple(rows),
        stored=thing.categories,
    )
    what_if = (*left_out(chain), *_if_looked_for(network, chain, features))
    return Chain(chain.states, chain.prior, chain.prior_sources, chain.rows, chain.stored, what_if)


def _feature_row(network: Network, name: str, p: float) -> Row:
    kb = network.knowledge_base
    reported = network.objects.features[name]
    return Row(
        name=name,
        observed=f"{p:.2f}",
        likelihood=p * reported + (1.0 - p) * (1.0 - reported),
        sources=lambda category: _some(of_feature(kb, category, name)),
    )


def _measure_row(network: Network, thing: StoredThing, name: str, band: int) -> Row:
    kb: AfNet = network.knowledge_base
    at_least = name in (LENGTH, WIDTH) and not thing.whole
    larger = slice(band, None if at_least else band + 1)
    return Row(
        name=name,
        observed=_between(name, band, at_least),
        likelihood=np.asarray(network.objects.measures[name][larger].sum(axis=0)),
        sources=lambda category: (of_measure(kb, category, name),),
    )


def _between(name: str, band: int, at_least: bool) -> str:
    edges = TOP_EDGES_M if name == TOP else SIZE_EDGES_M
    if band == 0:
        return f"under {edges[0]:.2f} m"
    if at_least or band == len(edges):
        return f"{edges[band - 1]:.2f} m or more"
    return f"{edges[band - 1]:.2f} to {edges[band]:.2f} m"


def _some(source: Source | None) -> tuple[Source, ...]:
    return () if source is None else (source,)


def _if_looked_for(network: Network, chain: Chain, observed: dict[str, float]) -> Iterator[WhatIf]:
    """What a look for each further feature would change, seen or missed, were it certain."""
    posterior = chain.posterior
    now = np.array([posterior[state] for state in chain.states])
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
