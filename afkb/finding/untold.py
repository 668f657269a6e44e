"""What a thing may be beside the categories that the map names: it keeps the likeliest only."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from afkb.errors import EvidenceError
from afkb.inference import network_of

if TYPE_CHECKING:
    from afkb.finding.surroundings import Node
    from afkb.knowledge import AfNet


def share_of(node: Node, kinds: Iterable[str], kb: AfNet) -> float:
    """P(a node is of one of the kinds): as the map says, and their part of what it leaves untold.

    What the named categories leave is shared by the others as the network has them, by the node's
    affordances, size and height; none of them is likelier than the least that is named.
    """
    told = node.belief
    rest = 1.0 - sum(told.values())
    share = sum(told.get(kind, 0.0) for kind in kinds)
    untold = [kind for kind in kinds if kind not in told]
    if not told or rest <= 0.0 or not untold:
        return share
    network = network_of(kb)
    try:
        posterior = network.category_posterior(
            network.known(node.affords), node.size, node.bottom_top[1]
        )
    except EvidenceError:
        return share
    others = sum(p for name, p in posterior.items() if name not in told)
    least = min(told.values())
    if not others > 0:
        return share
    return share + sum(min(rest * posterior.get(kind, 0.0) / others, least) for kind in untold)
