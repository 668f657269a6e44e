"""Each query of the library, on the bundled home: its answer beside what plain Python makes of it.

The truths are worked out from the scene's own values, so that they hold for any map.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from pathlib import Path

import pytest

from afkb.knowledge import AfNet
from afkb.store import Dataset, load
from afkb.store.named import named_queries
from afkb.store.shapes import rooms_json
from afkb.store.vocabulary import local_name
from told_home import Home

Truth = Callable[["Home"], object]


@pytest.fixture(scope="module")
def home(demo_folder: Path) -> Home:
    stored = load(demo_folder / "demo-map")
    kb = AfNet()
    return Home(stored, Dataset.load([stored], kb.files), kb)


def _carried(home: Home) -> set[str]:
    return {thing["supported_by"] for thing in home.things if thing["supported_by"]}


def _free(home: Home) -> set[str]:
    return home.ids(
        lambda t: (
            "SupportAbility" in t["affords"]
            and t["id"] not in _carried(home) | home.dynamic
            and 0.4 <= t["z"] <= 1.2
            and min(t["size"][:2]) >= 0.3
            and home.told(t, "afn:extentKnown") == ["true"]
        )
    )


def _reachable(home: Home) -> set[str]:
    doors = [home.stored.names(d, "afn:connects") for d in home.stored.instances("Doorway")]
    found, edge = {home.kitchen}, [home.kitchen]
    while edge:
        here = edge.pop()
        new = {room for door in doors if here in door for room in door} - found
        found |= new
        edge += new
    return found - {home.kitchen}


def _near(home: Home) -> set[str]:
    here = home.by_id["surface-15"]

    def is_near(t: dict) -> bool:  # type: ignore[type-arg]
        return (t["x"] - here["x"]) ** 2 + (t["y"] - here["y"]) ** 2 <= 1.5**2

    return home.ids(is_near) - {"surface-15"}


def _detectors(home: Home) -> Counter[str]:
    counted: Counter[str] = Counter()
    for sighting in home.stored.instances("Sighting"):
        by = home.stored.names(sighting, "prov:wasGeneratedBy")
        counted.update(name.removeprefix("by-") for name in by)
    return counted


def _in_vain(home: Home) -> Counter[str]:
    looks: Counter[str] = Counter()
    for node in home.stored.instances("PastPrediction"):
        for change in home.stored.names(node, "afn:change"):
            kind = home.stored.name(home.node(change), "afn:changeKind")
            looks[local_name(node.value)] += kind in ("SeenThrough", "Overlooked")
    return +looks


def _expected(home: Home) -> dict[str, float]:
    sums: Counter[str] = Counter()
    for thing in home.things:
        for category, p in thing["category"].items():
            sums[category] += p * thing["existence"]
    return {category: round(value, 6) for category, value in sums.items()}


def _missing(home: Home) -> set[tuple[str, str]]:
    """Furniture that rooms of that purpose usually have: here nothing may be such a thing."""
    return {
        (room, category)
        for room, _, category, _ in home.ask("missing-in-room")
        if any(
            t["room"] == room and any(home.is_one({"category": {c: p}}, category) and p > 0.1
                                      for c, p in t["category"].items())
            for t in home.things
        )
    }  # fmt: skip


SUPPORT = "surface-15"
TRUTHS: dict[str, tuple[Callable[[Home], object], Truth]] = {
    "containers-on-supports": (
        lambda h: {(r[0], r[5]) for r in h.ask("containers-on-supports")},
        lambda h: {
            (t["id"], t["supported_by"])
            for t in h.things
            if "ContainAbility" in t["affords"] and t["supported_by"]
        },
    ),
    "containers-on-tables": (
        lambda h: set(h.column("containers-on-tables")),
        lambda h: h.ids(
            lambda t: "ContainAbility" in t["affords"]
            and t["supported_by"]
            and h.is_one(h.by_id[t["supported_by"]], "Table", "Desk") > 0.5
        ),
    ),
    "on-support": (
        lambda h: set(h.column("on-support")),
        lambda h: h.ids(lambda t: t["supported_by"] == SUPPORT),
    ),
    "supports-by-height": (
        lambda h: [float(z) for z in h.column("supports-by-height", 1)],
        lambda h: sorted(t["z"] for t in h.things if "SupportAbility" in t["affords"]),
    ),
    "where-to-put-down": (lambda h: set(h.column("where-to-put-down")), _free),
    "seats": (
        lambda h: all(0.3 < float(z) < 0.7 for z in h.column("seats", 1)),
        lambda h: bool(h.ask("seats")),
    ),
    "stacked-things": (
        lambda h: set(h.column("stacked-things")),
        lambda h: h.ids(
            lambda t: t["supported_by"] and h.by_id[t["supported_by"]]["supported_by"]
        ),
    ),
    "unexplained-things": (
        lambda h: set(h.column("unexplained-things")),
        lambda h: h.ids(
            lambda t: h.told(t, "afn:scale") == ["Small"]
            and not t["supported_by"]
            and not h.told(t, "afn:partOf")
        ),
    ),
    "room-purposes": (
        lambda h: {r[0]: r[1] for r in h.ask("room-purposes")},
        lambda h: h.purpose,
    ),
    "rooms-by-purpose": (
        lambda h: h.column("rooms-by-purpose", purpose="Bedroom")[0],
        lambda h: next(room for room, purpose in h.purpose.items() if purpose == "Bedroom"),
    ),
    "room-beliefs": (
        lambda h: {(r[0], r[1]): float(r[2]) for r in h.ask("room-beliefs")},
        lambda h: {(r["id"], c): p for r in rooms_json(h.stored) for c, p in r["belief"].items()},
    ),
    "room-second-opinion": (
        lambda h: {(r[0], r[1]) for r in h.ask("room-second-opinion")},
        lambda h: set(h.purpose.items()),
    ),
    "room-evidence": (
        lambda h: all(float(n) > 0 for n in h.column("room-evidence", 2)),
        lambda h: set(h.column("room-evidence")) <= set(h.purpose) and bool(h.ask("room-evidence")),
    ),
    "what-is-in-room": (
        lambda h: {(r[1], r[2]) for r in h.ask("what-is-in-room", purpose="Kitchen")},
        lambda h: {(t["id"], h.likely(t)) for t in h.things if t["room"] == h.kitchen},
    ),
    "missing-in-room": (_missing, lambda h: set()),
    "out-of-place": (
        lambda h: all(
            h.likely(h.by_id[r[0]]) and h.purpose[r[3]] == r[4] and float(r[5]) < 0.1
            for r in h.ask("out-of-place")
        ),
        lambda h: True,
    ),
    "reachable-rooms": (lambda h: set(h.column("reachable-rooms", 1)), _reachable),
    "doorways": (
        lambda h: [float(w) for w in h.column("doorways", 3)],
        lambda h: sorted(
            h.stored.number(d, "afn:width")
            for d in h.stored.instances("Doorway")
            if len(h.stored.names(d, "afn:connects")) == 2
        ),
    ),
    "ways-between-places": (
        lambda h: len(h.ask("ways-between-places")),
        lambda h: h.of("Edge", "afn:edgeKind").count("path"),
    ),
    "places-in-order": (
        lambda h: [(r[0], int(r[5])) for r in h.ask("places-in-order")],
        lambda h: [
            (local_name(p.value), sum(local_name(p.value) in h.told(t, "afn:seenFrom")
                                      for t in h.things))
            for p in sorted(h.stored.instances("RobotPlace"),
                            key=lambda p: h.stored.number(p, "afn:firstSeen"))
        ],
    ),
    "things-by-category": (
        lambda h: {r[0]: round(float(r[1]), 6) for r in h.ask("things-by-category")},
        lambda h: {
            t["id"]: round(h.is_one(t, "Table"), 6) for t in h.things if h.is_one(t, "Table")
        },
    ),
    "counts-by-category": (
        lambda h: {r[0]: round(float(r[1]), 6) for r in h.ask("counts-by-category")},
        _expected,
    ),
    "things-per-room": (
        lambda h: {r[0]: (int(r[1]), int(r[2])) for r in h.ask("things-per-room")},
        lambda h: {
            room: (
                len(h.ids(lambda t, room=room: t["room"] == room)),  # type: ignore[misc]
                len(h.ids(lambda t, room=room: t["room"] == room) & h.dynamic),  # type: ignore[misc]
            )
            for room in h.purpose
        },
    ),
    "doubtful-things": (
        lambda h: set(h.column("doubtful-things", below="0.9")),
        lambda h: h.ids(lambda t: t["existence"] < 0.9),
    ),
    "doubtful-categories": (
        lambda h: set(h.column("doubtful-categories", below="0.3")),
        lambda h: h.ids(lambda t: max(t["category"].values()) < 0.3),
    ),
    "dynamic-things": (
        lambda h: {(r[0], r[1]) for r in h.ask("dynamic-things")},
        lambda h: {(name, h.likely(h.by_id[name])) for name in h.dynamic},
    ),
    "seen-last": (
        lambda h: [float(s) for s in h.column("seen-last", 1)],
        lambda h: sorted(h.value(t, "afn:lastSeen") for t in h.things),
    ),
    "new-since": (
        lambda h: set(h.column("new-since", since="20")),
        lambda h: h.ids(lambda t: h.value(t, "afn:firstSeen") >= 20),
    ),
    "predicted-unseen": (
        lambda h: set(h.column("predicted-unseen")),
        lambda h: {
            local_name(n.value)
            for kind in ("DualPrediction", "CoOccurrencePrediction")
            for n in h.stored.instances(kind)
        },
    ),
    "predicted-never-looked-at": (
        lambda h: set(h.column("predicted-never-looked-at")),
        lambda h: {
            local_name(n.value)
            for kind in ("DualPrediction", "CoOccurrencePrediction", "PastPrediction")
            for n in h.stored.instances(kind)
            if not h.stored.names(n, "afn:confirmedBy")
            and not _in_vain(h)[local_name(n.value)]
        },
    ),
    "looked-at-in-vain": (
        lambda h: {r[0]: int(r[2]) for r in h.ask("looked-at-in-vain")},
        _in_vain,
    ),
    "past-predictions": (
        lambda h: Counter(h.column("past-predictions", 2)),
        lambda h: Counter(h.of("PastPrediction", "afn:predictionState")),
    ),
    "confirmed-predictions": (
        lambda h: sorted(h.column("confirmed-predictions")),
        lambda h: sorted(h.of("LoopClosure", "afn:confirms")),
    ),
    "why-predicted": (
        lambda h: {r[0] for r in h.ask("why-predicted")} <= {
            local_name(n.value) for n in h.stored.instances("PastPrediction")
        } | set(h.by_id),
        lambda h: bool(h.ask("why-predicted")),
    ),
    "rules-record": (
        lambda h: sum(int(r[2]) for r in h.ask("rules-record")),
        lambda h: h.of("PastPrediction", "afn:predictionState").count("Confirmed"),
    ),
    "provenance": (
        lambda h: {r[1] for r in h.ask("provenance") if r[0] == "wasGeneratedBy"},
        lambda h: set(h.told(h.by_id[SUPPORT], "prov:wasGeneratedBy")),
    ),
    "sightings": (
        lambda h: set(h.column("sightings")),
        lambda h: set(h.told(h.by_id[SUPPORT], "afn:sighting")),
    ),
    "beliefs-over-time": (
        lambda h: float(h.ask("beliefs-over-time")[-1][3]),
        lambda h: h.by_id[SUPPORT]["existence"],
    ),
    "detectors-share": (
        lambda h: {r[0]: int(r[2]) for r in h.ask("detectors-share")},
        _detectors,
    ),
    "grasp-candidates": (
        lambda h: {r[0] for r in h.ask("grasp-candidates")} <= h.dynamic,
        lambda h: {r[3] for r in h.ask("grasp-candidates")} <= {
            name for name, feature in h.kb.features.items() if feature.kind == "grasp"
        } and bool(h.ask("grasp-candidates")),
    ),
    "near-by": (lambda h: set(h.column("near-by")), _near),
    "overlapping-rooms": (
        lambda h: {r[0]: r[1] for r in h.ask("overlapping-rooms")},
        lambda h: {n: h.by_id[n]["room"] for n in set(h.column("overlapping-rooms"))},
    ),
    "compare-maps": (
        lambda h: h.ask("compare-maps")[0][1:],
        lambda h: (
            str(len(h.things)),
            str(len(h.purpose)),
            str(len(h.stored.instances("RobotPlace"))),
        ),
    ),
    "made-with": (
        lambda h: {r[1]: int(r[2]) for r in h.ask("made-with") if r[0] == "count"},
        lambda h: h.stored.counts,
    ),
}  # fmt: skip


def test_every_query_of_the_library_has_its_answer_told() -> None:
    assert {known.name for known in named_queries()} == set(TRUTHS)


@pytest.mark.parametrize("name", sorted(TRUTHS))
def test_the_answer_is_right(home: Home, name: str) -> None:
    asked, truth = TRUTHS[name]
    assert asked(home) == truth(home)
