"""Reads from a map's RDF what its beliefs rest on."""

from __future__ import annotations

from pyoxigraph import NamedNode

from afkb.flow import Change, ChangeKind, Entity, NodeKind, Sighting
from afkb.store import StoredMap
from afkb.store.vocabulary import local_name

AFFORDS_FROM = 0.5


def entities_of(stored: StoredMap) -> dict[str, Entity]:
    """Id to what the map states of each thing, seen or predicted."""
    kinds = (NodeKind.OBSERVED, NodeKind.DUAL, NodeKind.CO_OCCURRENCE)
    found = (entity_at(stored, n, kind) for kind in kinds for n in stored.instances(kind.value))
    return {entity.id: entity for entity in found}


def entity_at(stored: StoredMap, node: NamedNode, kind: NodeKind) -> Entity:
    """A thing as the map states it; of its position the height is what its top leaves."""
    width, depth, height = (stored.number(node, f"afn:size{axis}") for axis in "XYZ")
    affordances = stored.belief(node, "affordance", "affordance")
    z = stored.number(node, "afn:z")
    if affordances.get("SupportAbility", 0.0) < AFFORDS_FROM:
        z = stored.number(node, "afn:topHeight", z + height / 2) - height / 2
    return Entity(
        id=local_name(node.value),
        kind=kind,
        position_xyz=(stored.number(node, "afn:x"), stored.number(node, "afn:y"), z),
        size_xyz=(width, depth, height),
        yaw=stored.number(node, "afn:yaw"),
        affordances=affordances,
        existence=stored.number(node, "afn:existence", 1.0),
        category_belief=stored.belief(node, "category", "category"),
        movability=stored.name(node, "afn:movability") or "Static",
        matching_weight=stored.number(node, "afn:matchingWeight", 1.0),
        observations=int(stored.number(node, "afn:observations")),
        first_seen=stored.number(node, "afn:firstSeen"),
        last_seen=stored.number(node, "afn:lastSeen"),
        seen_from=tuple(stored.names(node, "afn:seenFrom")),
        generated_by=tuple(_makers(stored, node)),
        supported_by=stored.name(node, "afn:supportedBy"),
        part_of=stored.name(node, "afn:partOf"),
        room=stored.name(node, "afn:inRoom"),
        extent_known=stored.name(node, "afn:extentKnown") != "false",
    )


def counts_by_room(stored: StoredMap) -> dict[str, dict[str, int]]:
    """Room to what the map counted in it."""
    return {local_name(n.value): counts_of(stored, n) for n in stored.instances("Room")}


def sightings_of(stored: StoredMap, node: NamedNode) -> list[Sighting]:
    """The views that showed most of a thing, in the order in which they were taken."""
    found = [_sighting(stored, n) for n in _numbered(stored, node, "afn:sighting")]
    return sorted(found, key=lambda s: (s.view, s.image_box or ()))


def changes_of(stored: StoredMap, node: NamedNode) -> list[Change]:
    """The last steps of something's existence, oldest first."""
    return [_change(stored, n) for n in _numbered(stored, node, "afn:change")]


def counts_of(stored: StoredMap, node: NamedNode) -> dict[str, int]:
    """Evidence class to how many things of it the map counted in a room."""
    counted = (n for n in stored.values(node, "afn:counted") if isinstance(n, NamedNode))
    return {
        name: int(stored.number(n, "rdf:value"))
        for n in sorted(counted, key=lambda n: n.value)
        if (name := stored.name(n, "afn:ofEvidenceClass")) is not None
    }


def _numbered(stored: StoredMap, node: NamedNode, predicate: str) -> list[NamedNode]:
    found = [n for n in stored.values(node, predicate) if isinstance(n, NamedNode)]
    return sorted(found, key=lambda n: int(n.value.rsplit("-", 1)[1]))


def _sighting(stored: StoredMap, node: NamedNode) -> Sighting:
    box = tuple(int(v) for v in (stored.name(node, "afn:imageBox") or "").split())
    told = (stored.name(node, "afn:told") or "").split(", ")
    return Sighting(
        view=int(stored.number(node, "afn:viewIndex")),
        stamp=stored.number(node, "afn:stamp"),
        detectors=tuple(_makers(stored, node)),
        n_pixels=int(stored.number(node, "afn:pixels")),
        range_m=stored.number(node, "afn:range"),
        image_box=(box[0], box[1], box[2], box[3]) if len(box) == 4 else None,
        affordances={n: float(p) for n, _, p in (t.rpartition(" ") for t in told if t)},
    )


def _change(stored: StoredMap, node: NamedNode) -> Change:
    before = list(stored.values(node, "afn:before"))
    view = list(stored.values(node, "afn:viewIndex"))
    return Change(
        kind=ChangeKind(stored.name(node, "afn:changeKind") or ""),
        evidence=stored.number(node, "afn:weighed"),
        before=float(before[0].value) if before else None,
        after=stored.number(node, "afn:probability"),
        stamp=stored.number(node, "afn:stamp"),
        view=int(view[0].value) if view else None,
        by=tuple(stored.names(node, "afn:byEntity")),
    )


def _makers(stored: StoredMap, node: NamedNode) -> list[str]:
    """The detectors or predictors that something was made by."""
    names = stored.names(node, "prov:wasGeneratedBy")
    return [name.removeprefix("by-") for name in names if name.startswith("by-")]
