"""Reads from a map's RDF what its beliefs rest on."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from pyoxigraph import NamedNode

from afkb.flow import Change, ChangeKind, Sighting
from afkb.store import StoredMap
from afkb.store.vocabulary import local_name

AFFORDS_FROM = 0.5


@dataclass(frozen=True, slots=True)
class StoredThing:
    """A thing as the map states it: what the networks take in, m; ids of support and room."""

    id: str
    affordances: Mapping[str, float]
    size_xyz: tuple[float, float, float]
    top_m: float
    whole: bool
    existence: float
    categories: Mapping[str, float]
    supported_by: str | None
    room: str | None

    @classmethod
    def read(cls, stored: StoredMap, node: NamedNode) -> StoredThing:
        """The thing at a node."""
        length, width, height = (stored.number(node, f"afn:size{axis}") for axis in "XYZ")
        affordances = stored.belief(node, "affordance", "affordance")
        z = stored.number(node, "afn:z")
        supports = affordances.get("SupportAbility", 0.0) >= AFFORDS_FROM
        return cls(
            id=local_name(node.value),
            affordances=affordances,
            size_xyz=(length, width, height),
            top_m=stored.number(node, "afn:topHeight", z if supports else z + height / 2),
            whole=stored.name(node, "afn:extentKnown") != "false",
            existence=stored.number(node, "afn:existence", 1.0),
            categories=stored.belief(node, "category", "category"),
            supported_by=stored.name(node, "afn:supportedBy"),
            room=stored.name(node, "afn:inRoom"),
        )


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
        detectors=tuple(n.removeprefix("by-") for n in stored.names(node, "prov:wasGeneratedBy")),
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
