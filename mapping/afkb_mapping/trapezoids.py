"""Trapezoids: the fuzzy limits by which the ontology's features are stated."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from afkb.knowledge import AfNet

Limits = tuple[float, float, float, float]
"""Trapezoid (z1, n1, n2, z2): impossible outside z1..z2, fully so between n1 and n2."""


def parameters(knowledge_base: AfNet, feature: str) -> Mapping[str, Limits]:
    """Trapezoids that a feature states in the ontology, by name; empty for an unknown feature."""
    found = knowledge_base.features.get(feature)
    if found is None:
        return {}
    return {name: (t.z1, t.n1, t.n2, t.z2) for name, t in found.parameters.items()}


def membership(value: float, limits: Limits) -> float:
    """Degree, 0 to 1, to which a value lies within a trapezoid.

    >>> membership(0.75, (0.5, 1.0, 2.0, 3.0))
    0.5
    """
    z1, n1, n2, z2 = limits
    if value <= z1 or value >= z2:
        return 1.0 if n1 <= value <= n2 else 0.0
    if value < n1:
        return (value - z1) / (n1 - z1)
    return 1.0 if value <= n2 else (z2 - value) / (z2 - n2)


def ramp(value: float, limits: tuple[float, float]) -> float:
    """0 up to the first limit, 1 from the second on, straight in between.

    >>> ramp(0.5, (0.0, 2.0))
    0.25
    """
    return min(max((value - limits[0]) / (limits[1] - limits[0]), 0.0), 1.0)
