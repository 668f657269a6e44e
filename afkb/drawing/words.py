"""How things of the map are named and described to people."""

from __future__ import annotations

from collections.abc import Mapping

from afkb.flow import Entity, NodeKind

_AT_LEAST = 0.5
_KINDS = {
    NodeKind.OBSERVED: "seen",
    NodeKind.DUAL: "predicted by duality, not seen yet",
    NodeKind.CO_OCCURRENCE: "predicted by co-occurrence, not seen yet",
}


def best(belief: Mapping[str, float], count: int) -> list[tuple[str, float]]:
    """The likeliest names with their probabilities."""
    return sorted(belief.items(), key=lambda item: (-item[1], item[0]))[:count]


def affords(entity: Entity) -> list[str]:
    """What it affords more likely than not, the surest first; else the likeliest, as in RDF."""
    ranked = best(entity.affordances, len(entity.affordances))
    return [name for name, p in ranked if p >= _AT_LEAST] or [name for name, _ in ranked[:1]]


def role(entity: Entity) -> str:
    """What the plan draws it as: `support`, `container` or `thing`."""
    afforded = affords(entity)
    if "SupportAbility" in afforded:
        return "support"
    return "container" if any("ContainAbility" in name for name in afforded) else "thing"


def describe(entity: Entity) -> str:
    """The tooltip: what it affords, what it may be, how sure, and where it came from."""
    afforded = ", ".join(f"{name} {p:.2f}" for name, p in best(entity.affordances, 4))
    maybe = ", ".join(f"{name} {p:.2f}" for name, p in best(entity.category_belief, 3))
    size = " x ".join(f"{s:.2f}" for s in entity.size_xyz)
    lines = [
        f"{entity.id}: {_KINDS[entity.kind]}; exists {entity.existence:.2f}",
        f"affords {afforded}",
        f"may be {maybe}" if maybe else "",
        f"height {entity.position_xyz[2]:.2f} m, size {size} m"
        + ("" if entity.extent_known else " (its extent is not known)"),
        f"{entity.movability.lower()}, seen {entity.observations} times"
        if entity.kind is NodeKind.OBSERVED
        else f"follows from {', '.join(entity.predicted_from)}",
        f"first predicted as {entity.predicted_first.value}" if entity.predicted_first else "",
        f"stands on {entity.supported_by}" if entity.supported_by else "",
    ]
    return "\n".join(text for text in lines if text)
