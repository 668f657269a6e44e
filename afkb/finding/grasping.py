"""How things of some kind can be grasped: the 33 grasps of the GRASP taxonomy (Feix et al. 2016).

A grasp fits a thing if its kind, or a part of it, affords it (an afbit of the ontology), or if it
was measured on the thing itself; if the box that was measured fits the grasp's fuzzy ranges; and if
a hand has room beside the neighbours, above, and over the support.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from afkb.finding.clearance import Clearance, Room
from afkb.finding.regions import Region
from afkb.finding.surroundings import Node, Surroundings

if TYPE_CHECKING:
    from afkb.knowledge import AfNet
    from afkb.knowledge.model import Afbit, Category, Feature, Trapezoid

WORTH_A_GRASP = 0.01
"""What is less likely such a thing isn't reached for."""
CLEAR = 0.5
"""From this probability on a hand has room: more likely than not."""
Extents = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Grasp:
    """One way to take one thing; m and rad, map frame.

    - `is_one`: P(it exists and is such a thing); `fits`: P(the grasp holds it | it is);
      `clear`: P(a hand has room); `probability`: their product.
    - `approach`: `above` or `side`; `bearing`: the way a hand from the side moves; `closing`: the
      direction along which fingers close. `width`: what they close round, None of a part.
    """

    node: Node
    grasp: str
    part: str | None
    approach: str
    bearing: float | None
    closing: float | None
    width: float | None
    is_one: float
    fits: float
    clear: float
    reason: str

    @property
    def probability(self) -> float:
        """That it is such a thing and that the grasp holds it, with room for the hand."""
        return self.is_one * self.fits * self.clear


@dataclass(frozen=True, slots=True)
class Held:
    """That a kind, or a part of it, affords a grasp: how surely, and whether its box tells."""

    strength: float
    part: str | None
    by_box: bool
    why: str


def grasps(category: str, found: list[Region], around: Surroundings, kb: AfNet) -> list[Grasp]:
    """Ways to grasp what was seen and may be such a thing, the likeliest first.

    Those without room for the hand are among them, with `clear` below `CLEAR`.
    """
    kinds = [name for name in kb.categories if category in kb.kinds_of(name)]
    afbits = [
        (afbit, kb.features[afbit.feature])
        for afbit in kb.afbits
        if afbit.category in kinds and kb.features[afbit.feature].kind == "grasp"
    ]
    ways: list[Grasp] = []
    for region in found:
        if region.how == "thing" and region.seen and region.probability >= WORTH_A_GRASP:
            node = around.nodes[region.node]
            room = Clearance(node, around)
            for name, held in _held(node, kinds, afbits, kb):
                way = _way(node, region.probability, kb.features[name], held, room)
                if way is not None:
                    ways.append(way)
    return sorted(ways, key=lambda w: (-w.probability, -w.fits, w.node.id, w.grasp, w.part or ""))


def is_graspable(category: str, kb: AfNet) -> bool:
    """Whether a kind of the category affords any grasp."""
    return any(
        category in kb.kinds_of(afbit.category) and kb.features[afbit.feature].kind == "grasp"
        for afbit in kb.afbits
    )


def _held(
    node: Node, kinds: list[str], afbits: list[tuple[Afbit, Feature]], kb: AfNet
) -> Iterator[tuple[str, Held]]:
    """Grasps with how surely the thing affords them, if it is one of the kinds, part by part."""
    belief = {kind: node.belief[kind] for kind in kinds if node.belief.get(kind, 0.0) > 0}
    whole = sum(belief.values())
    found: dict[tuple[str, str | None, bool], float] = {}
    for afbit, feature in afbits:
        if afbit.category in belief:
            by_box = afbit.part is None and _typical(feature, kb.categories[afbit.category])
            key = (afbit.feature, afbit.part, by_box)
            share = belief[afbit.category] / whole
            found[key] = found.get(key, 0.0) + share * afbit.strength
    for name, p in node.affords.items():
        if name in kb.features and kb.features[name].kind == "grasp":
            found[name, None, True] = max(p, found.get((name, None, True), 0.0))
    for (name, part, by_box), strength in found.items():
        seen = node.affords.get(name, 0.0)
        why = f"measured with {seen:.2f}" if by_box and seen >= strength else "its kind affords it"
        yield name, Held(min(strength, 1.0), part, by_box, why)


def _typical(feature: Feature, category: Category) -> bool:
    """Whether the whole thing is what is held: else it is an edge, as of a bowl, or a knob."""
    sizes = (category.length_m, category.width_m, category.height_m)
    return fit(feature, [sum(ends) / 2 for ends in sizes]) > 0


def fit(feature: Feature, size: list[float] | Extents) -> float:
    """Membership of a box of that size, m, in a grasp's ranges: the least of all that it tells."""
    low, middle, high = sorted(max(extent, 1e-3) for extent in size)
    told: Mapping[str, float] = {
        "min_extent_m": low,
        "middle_extent_m": middle,
        "max_extent_m": high,
        "elongation": high / middle,
        "thickness_over_extent": low / high,
    }
    ranges = feature.parameters.items()
    return min((range_(told[name]) for name, range_ in ranges if name in told), default=0.0)


def _way(node: Node, is_one: float, grasp: Feature, held: Held, clear: Clearance) -> Grasp | None:
    """The way of the best room, of all axes that the grasp can close along; None if none fits."""
    fits = held.strength * (fit(grasp, node.size) if held.by_box else 1.0)
    if not fits > 0:
        return None
    takes = _apertures(grasp) if held.by_box else []
    ways = [
        way
        for way in clear.ways
        if (not takes and way.axis < 2) or any(range_(node.size[way.axis]) > 0 for range_ in takes)
    ]
    if not ways:
        return None
    way = max(ways, key=lambda w: w.room.probability)
    closing = node.yaw + way.axis * math.pi / 2 if way.axis < 2 and held.by_box else None
    bearing = None
    if way.approach == "side" and way.axis < 2:
        bearing = node.yaw + (1 - way.axis) * math.pi / 2 + (math.pi if way.side > 0 else 0.0)
    held_at = held.part or ("whole" if held.by_box else "edge")
    reason = f"{held_at}: {held.why}; {_told(fits, way.room)}"
    return Grasp(
        node,
        grasp.name,
        held.part or (None if held.by_box else "edge"),
        way.approach,
        _turned(bearing),
        _turned(closing),
        node.size[way.axis] if held.by_box else None,
        is_one,
        fits,
        way.room.probability,
        reason,
    )


def _apertures(grasp: Feature) -> list[Trapezoid]:
    """What the hand closes round: the shortest extent that the grasp names.

    Where fingers go round the thing, and so need room at its sides, also the middle one.
    """
    names = ("min_extent_m", "middle_extent_m", "max_extent_m")
    named = [grasp.parameters[name] for name in names if name in grasp.parameters]
    return named[: 2 if "clearance_side_m" in grasp.parameters else 1]


def _told(fits: float, room: Room) -> str:
    if room.hindered_by is None or room.probability > 0.99:
        return f"fits with {fits:.2f}, free all round"
    what = "clear" if room.probability >= CLEAR else "no clearance"
    gap = f" at {100 * room.gap_m:.1f} cm" if math.isfinite(room.gap_m) else ""
    return f"fits with {fits:.2f}, {what} ({room.probability:.2f}): {room.hindered_by}{gap}"


def _turned(angle: float | None) -> float | None:
    """Into -π to π."""
    return None if angle is None else math.atan2(math.sin(angle), math.cos(angle))
