"""Things on the plan: those seen and predicted, and predictions that have come to their end."""

from __future__ import annotations

from collections.abc import Iterator

from afkb.drawing import svg as d
from afkb.drawing.words import describe, role
from afkb.flow import Entity, NodeKind, TopologicalMap

# Lower than this lies the floor, whose outline must not tint all that stands on it.
_GROUND_M = 0.05


def things(m: TopologicalMap, radius: float) -> Iterator[str]:
    """Large ones first, so that what stands on a table can be pointed at."""
    order = sorted(m.entities, key=lambda e: (-e.size_xyz[0] * e.size_xyz[1], e.id))
    for entity in order:
        yield _outline(entity)
    for entity in order:
        x, y, _ = entity.position_xyz
        size = radius if role(entity) == "support" else 0.7 * radius
        yield d.circle(f"node {_classes(entity)}", x, y, size, describe(entity), entity.id)


def _classes(entity: Entity) -> str:
    seen = "seen" if entity.kind is NodeKind.OBSERVED else "predicted"
    order = {NodeKind.DUAL: " dual", NodeKind.CO_OCCURRENCE: " co-occurrence"}
    moves = " dynamic" if entity.movability == "Dynamic" else ""
    return f"{role(entity)} {seen}{order.get(entity.kind, '')}{moves}"


def _outline(entity: Entity) -> str:
    x, y, z = entity.position_xyz
    kind = f"outline {_classes(entity)}"
    kind += "" if entity.extent_known else " extent-unknown"
    kind += " ground" if z < _GROUND_M else ""
    title = describe(entity)
    if entity.polygon_xy is not None and len(entity.polygon_xy) > 2:
        return d.path(kind, entity.polygon_xy, True, title, entity.id)
    return d.box(kind, (x, y, entity.yaw), entity.size_xyz[:2], title, entity.id)


def past(m: TopologicalMap, radius: float) -> Iterator[str]:
    """Predictions that were confirmed, refuted or expired, where they were made."""
    for prediction in m.past_predictions:
        x, y, _ = prediction.position_xyz
        afforded = prediction.affordances
        role_ = "support" if afforded.get("SupportAbility", 0.0) else "thing"
        became = f", seen as {prediction.seen_as}" if prediction.seen_as else ""
        title = f"{prediction.id}: was predicted, {prediction.state.value.lower()}{became}"
        yield d.circle(f"node {role_} predicted ended", x, y, radius, title, prediction.id)


def ids(m: TopologicalMap, radius: float) -> Iterator[str]:
    """The ids of things as labels."""
    for entity in m.entities:
        x, y, _ = entity.position_xyz
        yield d.text("label", x, y + 1.3 * radius, entity.id, entity.id)
