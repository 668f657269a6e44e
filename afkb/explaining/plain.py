"""Why places, doorways, bounds, edges and closures are in a map: short, as they follow from few."""

from __future__ import annotations

from collections.abc import Callable

from pyoxigraph import NamedNode

from afkb.explaining.explanation import Explanation, Ground, Life
from afkb.store import StoredMap
from afkb.store.vocabulary import local_name

Facts = dict[str, str]


def explain_plain(stored: StoredMap, node: NamedNode, kind: str) -> Explanation:
    """What is told of a node that no network infers."""
    told, facts, grounds = _TOLD[kind](stored, node)
    by = [n.removeprefix("by-") for n in stored.names(node, "prov:wasGeneratedBy") if n != "run"]
    if by:
        facts["told of by"] = ", ".join(by)
    existence = stored.name(node, "afn:existence")
    life = Life(float(existence), None, ()) if existence is not None else None
    views = int(stored.number(node, "afn:observations"))
    at = (local_name(node.value), kind, told, facts)
    return Explanation(*at, views=views, life=life, grounds=tuple(grounds))


def metres(stored: StoredMap, node: NamedNode, predicate: str) -> str:
    """A length as text."""
    return f"{stored.number(node, predicate):.2f} m"


def _place(stored: StoredMap, node: NamedNode) -> tuple[str, Facts, list[Ground]]:
    view = int(stored.number(node, "afn:viewIndex"))
    seen = stored.names(node, "afn:connectedTo")
    told = f"the robot stood here when it took view {view}"
    facts = {
        "taken": f"{stored.number(node, 'afn:firstSeen'):.1f} s",
        "room": stored.name(node, "afn:inRoom") or "none",
        "linked to": f"{len(seen)} nodes",
    }
    return told, facts, [Ground(n, "another place that one gets to") for n in seen if "place" in n]


def _doorway(stored: StoredMap, node: NamedNode) -> tuple[str, Facts, list[Ground]]:
    rooms = stored.names(node, "afn:connects")
    told = f"a passage {metres(stored, node, 'afn:width')} wide"
    return told, {}, [Ground(room, "is entered through it") for room in rooms]


def _bound(stored: StoredMap, node: NamedNode) -> tuple[str, Facts, list[Ground]]:
    told = f"a straight piece of wall, {metres(stored, node, 'afn:length')} long"
    facts = {
        "seen": f"{stored.number(node, 'afn:firstSeen'):.1f} to "
        f"{stored.number(node, 'afn:lastSeen'):.1f} s",
    }
    if stored.name(node, "afn:offsetSigma") is not None:
        facts["its line is known to"] = metres(stored, node, "afn:offsetSigma")
    room = stored.name(node, "afn:inRoom")
    return told, facts, [Ground(room, "is bounded by it")] if room else []


def _edge(stored: StoredMap, node: NamedNode) -> tuple[str, Facts, list[Ground]]:
    kind = stored.name(node, "afn:edgeKind") or "?"
    told = f"an edge of the graph ({kind}), {metres(stored, node, 'afn:distance')} long"
    ends = (("afn:from", "it begins there"), ("afn:to", "it ends there"))
    found = [Ground(name, how) for p, how in ends if (name := stored.name(node, p))]
    return told, {"bearing": f"{stored.number(node, 'afn:bearing'):.2f} rad"}, found


def _closure(stored: StoredMap, node: NamedNode) -> tuple[str, Facts, list[Ground]]:
    p = stored.number(node, "afn:probability")
    kind = stored.name(node, "afn:predictedAs") or "?"
    told = f"something that was predicted ({kind}, p = {p:.2f}) was then seen"
    facts = {"off by": metres(stored, node, "afn:displacement")}
    what, where = stored.name(node, "afn:confirms"), stored.name(node, "afn:seenFrom")
    grounds = [Ground(what, "is what was seen")] if what else []
    return told, facts, [*grounds, *([Ground(where, "from where it was seen")] if where else [])]


def _correction(stored: StoredMap, node: NamedNode) -> tuple[str, Facts, list[Ground]]:
    told = f"a place that was seen again, told by {stored.name(node, 'afn:recognisedBy')}"
    facts = {"corrected by": metres(stored, node, "afn:correction")}
    ends = (("afn:seenFrom", "the later place"), ("afn:earlierPlace", "the earlier place"))
    return told, facts, [Ground(name, how) for p, how in ends if (name := stored.name(node, p))]


_TOLD: dict[str, Callable[[StoredMap, NamedNode], tuple[str, Facts, list[Ground]]]] = {
    "RobotPlace": _place,
    "Doorway": _doorway,
    "Bound": _bound,
    "Edge": _edge,
    "LoopClosure": _closure,
    "LoopCorrection": _correction,
}
