"""What a thing's own looks say of what it is: a row per feature and measure, with its sources."""

from __future__ import annotations

import numpy as np

from afkb.explaining.chain import Row
from afkb.explaining.source import Source, of_feature, of_measure, of_name
from afkb.inference import Network
from afkb.inference.bands import SIZE_EDGES_M, TOP_EDGES_M
from afkb.inference.joint import SeenThing
from afkb.inference.object_tables import LENGTH, TOP, WIDTH


def own_rows(network: Network, thing: SeenThing) -> list[Row]:
    """P(what was seen of the thing itself | category), factor by factor."""
    measured = (thing.affordances, thing.size_xyz, thing.top_height_m)
    features, bands = network.objects.observed(*measured)
    rows = [_feature_row(network, name, p) for name, p in features.items()]
    rows += [_measure_row(network, thing, name, band) for name, band in bands.items()]
    if thing.stands is not None:
        rows.append(_standing_row(network, thing.stands))
    if thing.boarded:
        rows.append(_boards_row(network))
    return rows


def some(source: Source | None) -> tuple[Source, ...]:
    """The source, if there is one."""
    return () if source is None else (source,)


def _feature_row(network: Network, name: str, p: float) -> Row:
    kb, reported = network.knowledge_base, network.objects.features[name]
    return Row(
        name=name,
        observed=f"{p:.2f}",
        likelihood=p * reported + (1.0 - p) * (1.0 - reported),
        sources=lambda category: some(of_feature(kb, category, name)),
    )


def _measure_row(network: Network, thing: SeenThing, name: str, band: int) -> Row:
    kb = network.knowledge_base
    at_least = name in (LENGTH, WIDTH) and not thing.whole
    larger = slice(band, None if at_least else band + 1)
    return Row(
        name=name,
        observed=_between(name, band, at_least),
        likelihood=np.asarray(network.objects.measures[name][larger].sum(axis=0)),
        sources=lambda category: (of_measure(kb, category, name),),
    )


def _standing_row(network: Network, stands: str) -> Row:
    kb = network.knowledge_base
    where = {"Floor": "on the floor", "Support": "on a support"}

    def sources(category: str) -> tuple[Source, ...]:
        typical = kb.categories[category].stands_on or "anything"
        says = f"{category} stands on: {typical}; as that typically is, and as often as it is seen"
        found = (of_name(kb, name, says) for name in ("StandsAsTypical", "SupportSeen"))
        return tuple(s for s in found if s is not None)

    seen = where.get(stands, "on nothing, looked for")
    return Row("Standing", seen, network.joint.placement.standing[stands], sources)


def _boards_row(network: Network) -> Row:
    kb = network.knowledge_base

    def sources(category: str) -> tuple[Source, ...]:
        has = "has" if "Boards" in kb.categories[category].traits else "has not"
        return some(of_name(kb, category, f"{category} {has} boards over each other"))

    return Row("Boards", "surfaces of one outline", network.joint.boards, sources)


def _between(name: str, band: int, at_least: bool) -> str:
    edges = TOP_EDGES_M if name == TOP else SIZE_EDGES_M
    if band == 0:
        return f"under {edges[0]:.2f} m"
    if at_least or band == len(edges):
        return f"{edges[band - 1]:.2f} m or more"
    return f"{edges[band - 1]:.2f} to {edges[band]:.2f} m"
