"""Why something is held to exist: its steps folded again, and what other steps would have made."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from pyoxigraph import NamedNode

from afkb.explaining.chain import WhatIf, if_otherwise
from afkb.explaining.explanation import Life
from afkb.explaining.reading import changes_of
from afkb.flow import Change, ChangeKind
from afkb.inference.existence import (
    EMPTY_LIKELIHOOD_RATIO,
    OVERLOOKED_LIKELIHOOD_RATIO,
    after,
    folded,
)
from afkb.inference.update_rules import RULES, UpdateRule, log_odds
from afkb.store import StoredMap

WORDS = {
    ChangeKind.SIGHTED: "seen",
    ChangeKind.SEEN_THROUGH: "seen through",
    ChangeKind.OVERLOOKED: "in clear view and not detected",
    ChangeKind.SURROUNDED: "told by what is around it",
    ChangeKind.AGED: "time passed",
    ChangeKind.PREDICTED: "predicted",
    ChangeKind.PREDICTED_AGAIN: "predicted again",
    ChangeKind.WALLED_OFF: "a wall came to light between",
    ChangeKind.EVIDENCE_GONE: "what it follows from is gone",
    ChangeKind.CONFIRMED: "seen, and so confirmed",
}

_BEGIN = (
    ChangeKind.SIGHTED,
    ChangeKind.PREDICTED,
    ChangeKind.PREDICTED_AGAIN,
    ChangeKind.CONFIRMED,
)
_LOOKS = {
    ChangeKind.SEEN_THROUGH: EMPTY_LIKELIHOOD_RATIO,
    ChangeKind.OVERLOOKED: OVERLOOKED_LIKELIHOOD_RATIO,
}


def life_of(stored: StoredMap, node: NamedNode, past: bool = False) -> Life:
    """The life of a thing or of a prediction; a kept step tells where the kept ones begin.

    What is `past` has no existence any more: the map states what its last step led to.
    """
    changes, rule = changes_of(stored, node), rule_of(stored)
    known = stored.number(node, "afn:existence", 1.0)
    if past:
        known = changes[-1].after if changes else 0.0
    recomputed = folded(changes, rule)
    what_if = tuple(_otherwise(changes, rule))
    return Life(known, recomputed, tuple(changes), what_if)


def rule_of(stored: StoredMap) -> UpdateRule:
    """The rule by which the map's predictions grew."""
    name = stored.name(NamedNode(stored.base + "run"), "afn:rule")
    return RULES.get(name or "", log_odds)


def _otherwise(changes: Sequence[Change], rule: UpdateRule) -> Iterator[WhatIf]:
    """Without each of the steps, with the surest sighting once more, and with looks in vain."""
    now = folded(changes, rule)
    if now is None:
        return
    before = _existing(now)
    for left, change in enumerate(changes):
        what = f"without step {left + 1}: {WORDS[change.kind]}"
        yield if_otherwise(what, before, _existing(_without(changes, left, rule)))
    seen = [c for c in changes if c.kind is ChangeKind.SIGHTED]
    if seen:
        best = max(c.evidence for c in seen)
        p = after(ChangeKind.SIGHTED, best, now, rule)
        yield if_otherwise(f"if one more view saw it as surely ({best:.2f})", before, _existing(p))
    for kind, ratio in _LOOKS.items():
        what = f"if one more view found it {WORDS[kind].removeprefix('in clear view and ')}"
        yield if_otherwise(what, before, _existing(after(kind, ratio, now)))


def _without(changes: Sequence[Change], left: int, rule: UpdateRule) -> float:
    """The probability without one step; what nothing tells of any more is not there."""
    rest, start = [c for i, c in enumerate(changes) if i != left], changes[0].before
    if left == 0:
        if start is None:
            begins = (i for i, c in enumerate(rest) if c.kind in _BEGIN)
            rest = rest[next(begins, len(rest)) :]
        rest = [replace(c, before=start) for c in rest[:1]] + rest[1:]
    p = folded(rest, rule)
    return p if p is not None else start or 0.0


def _existing(p: float) -> dict[str, float]:
    return {"it is there": p, "it is not": 1.0 - p}
