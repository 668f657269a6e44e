"""What is known of a thing by its affordances alone: the kind of thing that it is."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from afkb.knowledge import AfNet, Category

AFFORDS_FROM = 0.5
"""A category affords a feature whose afbit is at least so strong."""
HEIGHTS_M = (0.28, 0.58, 0.84, 1.08, 1.6, 2.2)
"""Where heights of tops part, above the floor, m: below a seat, seats and beds, tables, counters,
what one reaches, what hangs high, ceilings; the first four are limits of the evidence classes."""
ON_THINGS = "put on things"


@dataclass(frozen=True, slots=True)
class Kind:
    """Things that nothing but their names tells apart: same affordances, scale, height of the top.

    `features`: structural affordances, and those of the material, by name. `height`: between which
    heights its top is, or that it is put on things.
    """

    features: tuple[str, ...]
    scale: str
    height: str

    @property
    def name(self) -> str:
        """A name for it, the same for the same kind."""
        return f"{self.scale} {self.height}: {' '.join(self.features) or 'affords nothing listed'}"


@dataclass(frozen=True)
class Kinds:
    """The kind of every category, by what a knowledge base states (paper §II.A)."""

    knowledge_base: AfNet
    with_material: bool = True

    @cached_property
    def of(self) -> dict[str, str]:
        """Category to the name of its kind."""
        categories = self.knowledge_base.categories
        return {name: self.kind(category).name for name, category in categories.items()}

    def kind(self, category: Category) -> Kind:
        """Which affordances, what size and what height are known of such a thing."""
        told = ("structural", "material") if self.with_material else ("structural",)
        features = self.knowledge_base.features
        afforded = sorted(
            name
            for name, strength in category.afbits.items()
            if strength >= AFFORDS_FROM and features[name].kind in told
        )
        return Kind(tuple(afforded), category.scale, _height(category))


def _height(category: Category) -> str:
    if category.top_height_m is None:
        return ON_THINGS
    top = sum(category.top_height_m) / 2
    below = [limit for limit in HEIGHTS_M if limit <= top]
    above = [limit for limit in HEIGHTS_M if limit > top]
    if not above:
        return f"above {below[-1]:g} m"
    return f"{below[-1] if below else 0:g} to {above[0]:g} m"
