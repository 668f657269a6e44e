"""Finds what a user means by the id of a node."""

from __future__ import annotations

from difflib import get_close_matches

from pyoxigraph import NamedNode

from afkb.errors import MapError
from afkb.store import StoredMap
from afkb.store.vocabulary import local_name

KINDS = (
    "ObservedEntity", "DualPrediction", "CoOccurrencePrediction", "PastPrediction", "RobotPlace",
    "Room", "Doorway", "Bound", "Edge", "LoopClosure", "LoopCorrection",
)  # fmt: skip
"""Classes of what can be explained; a node is of one of them."""
NEAR_ENOUGH = 0.6
"""Ids at least so alike (Ratcliff and Obershelp) are offered for one that is not there."""


def node_named(stored: StoredMap, id_: str) -> tuple[NamedNode, str]:
    """The node of that id, as `info` shows it or as an IRI, and its kind.

    `MapError` that names alike ones where there is none.
    """
    wanted = local_name(id_) if "://" in id_ else id_.removeprefix("scene:")
    known = {local_name(n.value): (n, kind) for kind in KINDS for n in stored.instances(kind)}
    if wanted in known:
        return known[wanted]
    by_lower = {name.lower(): name for name in known}
    lower = wanted.lower().replace("_", "-").replace(" ", "-")
    if lower in by_lower:
        return known[by_lower[lower]]
    near = get_close_matches(lower, by_lower, n=3, cutoff=NEAR_ENOUGH)
    hint = (
        f"did you mean {' or '.join(by_lower[n] for n in near)}?"
        if near
        else "there is none like it"
    )
    raise MapError(
        f"{stored.folder}: no node {id_!r}; {hint}; `afkb info {stored.folder}` lists them all"
    )
