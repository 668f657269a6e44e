"""What a thing's surroundings say of what it is: its room, what carries it, what it carries."""

from __future__ import annotations

import numpy as np

from afkb.explaining.chain import Array, Row
from afkb.explaining.source import Source, of_statement
from afkb.flow import Entity
from afkb.inference import Network
from afkb.inference.recognition import Together
from afkb.knowledge import AfNet
from afkb.knowledge.stated_figures import ObjectOnSupport

TOLD = 3
"""Of so many neighbours the statements are told, by id."""


def surrounding_rows(network: Network, together: Together, at: int) -> list[Row]:
    """The rows by which the joint network differs from a thing by itself.

    Room: how much likelier a category is in such a room than anywhere, which is exact where nothing
    stands on the thing nor carries it. Neighbours: all that is left, from whatever stands on each
    other, the room that it tells of included.
    """
    prior, placement = network.objects.prior, network.joint.placement
    belief = np.array([together.room[name] for name in placement.rooms])
    in_room = placement.in_room @ belief / np.maximum(prior, np.finfo(float).tiny)
    rows = [_room_row(network.knowledge_base, together, in_room)]
    if len(together.entities) > 1:
        shares = network.joint.recognise(together.things, together.room).shares[at]
        own = network.joint.evidence(together.things[at]) * prior * in_room
        told = np.divide(shares, own, out=np.zeros_like(shares), where=own > 0)
        rows.append(_neighbours_row(network.knowledge_base, together, at, told / told.max()))
    return rows


def _room_row(kb: AfNet, together: Together, in_room: Array) -> Row:
    likeliest = max(sorted(together.room), key=lambda name: together.room[name])
    room = together.entities[0].room or "no room"
    figures = {f.category: f for f in kb.objects_in_rooms if f.room == likeliest}

    def sources(category: str) -> tuple[Source, ...]:
        figure = next((figures[kind] for kind in kb.kinds_of(category) if kind in figures), None)
        if figure is None:
            says = f"no figure of {category} in a {likeliest}"
            return (of_statement(kb.categories[category], says),)
        says = f"{likeliest} holds {figure.mean_number:g} of {figure.category}"
        return (of_statement(figure, says),)

    seen = f"{room}, by what else is in it {likeliest} {together.room[likeliest]:.2f}"
    return Row("Room", seen, in_room, sources)


def _neighbours_row(kb: AfNet, together: Together, at: int, told: Array) -> Row:
    below, above = _neighbours(together, at)
    words = [f"on {e.id} ({_likeliest(e)})" for e in below]
    words += [f"under {e.id} ({_likeliest(e)})" for e in above[:TOLD]]
    words += [f"and {len(above) - TOLD} more"] if len(above) > TOLD else []

    def sources(category: str) -> tuple[Source, ...]:
        pairs = [(category, _likeliest(e)) for e in below]
        pairs += [(_likeliest(e), category) for e in above[:TOLD]]
        found = dict.fromkeys(f for thing, on in pairs if (f := _put(kb, thing, on)))
        if not found:
            says = f"no figure of {category} with these; what others stand on, as far as it is told"
            return (of_statement(kb.categories[category], says),)
        return tuple(
            of_statement(f, f"{f.probability:.0%} of {f.given} are on {f.category}") for f in found
        )

    seen = ", ".join(words) or "what stands on the same thing"
    return Row("Neighbours", seen, told, sources)


def _put(kb: AfNet, thing: str, on: str) -> ObjectOnSupport | None:
    """The closest figure of such things being put on such supports."""
    figures = {(f.given, f.category): f for f in kb.objects_on_supports}
    pairs = ((a, b) for a in kb.kinds_of(thing) for b in kb.kinds_of(on))
    return next((figures[pair] for pair in pairs if pair in figures), None)


def _neighbours(together: Together, at: int) -> tuple[list[Entity], list[Entity]]:
    on = together.things[at].on
    above = [e for e, t in zip(together.entities, together.things, strict=True) if t.on == at]
    return ([] if on is None else [together.entities[on]]), above


def _likeliest(entity: Entity) -> str:
    return max(sorted(entity.category_belief), key=lambda name: entity.category_belief[name])
