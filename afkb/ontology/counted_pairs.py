"""Co-occurrences that were counted in homes: the same affordance at a larger scale, in one room."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING

from afkb.csv_rows import Row
from afkb.ontology.afbits import DrawnAfbit
from afkb.ontology.subjects import measures_of

if TYPE_CHECKING:
    from afkb.figures import Figures, Together

LEAST_P, LEAST_LIFT, LEAST_TRIALS = 0.5, 2.0, 20
"""A pair is listed where it is likelier than not, twice as likely as anywhere, in enough rooms."""
_SCALES = ("Small", "Medium", "Large")
_FEATURES = ("SupportAbility", "ContainAbility", "DisplayAbility")
"""Affordances by which things of two scales are compared; the first shared one is named."""
_GAP_M = 0.2
"""Typical gap between the two, m; proposed."""


def counted_pairs(
    figures: Figures, categories: Mapping[str, Row], afbits: Iterable[DrawnAfbit], taken: set[str]
) -> Iterator[Row]:
    """Rows of co-occurrences (paper §II.D.iii), by name; `taken`: names that tables have already.

    The strength is the smoothed share of rooms; the distance is not counted: it is the sum of
    both half widths and a gap, and the source says that it is proposed.
    """
    affords: dict[str, set[str]] = {}
    for afbit in afbits:
        affords.setdefault(afbit.key[0], set()).add(afbit.key[2])
    for pair in figures.together(1):
        larger, smaller = categories.get(pair.category), categories.get(pair.given)
        if larger is None or smaller is None or not _scaled_up(smaller, larger):
            continue
        figure, name = pair.figure, f"{pair.given}Suggests{pair.category}"
        shared = affords.get(pair.category, set()) & affords.get(pair.given, set())
        feature = next((f for f in _FEATURES if f in shared), None)
        telling = figure.p >= max(LEAST_P, LEAST_LIFT * figures.base_rate(pair.category))
        if feature and telling and figure.trials >= LEAST_TRIALS and name not in taken:
            yield _row(name, feature, pair, smaller, larger)


def _scaled_up(smaller: Row, larger: Row) -> bool:
    for row in (smaller, larger):
        if row["scale"] not in _SCALES:
            raise row.error(f"scale {row['scale']!r} is none of: {', '.join(_SCALES)}; mend it")
    return _SCALES.index(smaller["scale"]) < _SCALES.index(larger["scale"])


def _row(name: str, feature: str, pair: Together, smaller: Row, larger: Row) -> Row:
    near, far = measures_of(smaller), measures_of(larger)
    distance = (near["width_m"] + far["width_m"]) / 2 + _GAP_M
    figure = pair.figure
    said, seen = smaller["label"], larger["label"]
    cells = {
        "name": name,
        "label": f"a {said} suggests a {seen}",
        "definition": f"A room with a {said} has a {seen}, a thing of larger scale, as well.",
        "example": f"a {said} in the doorway lets one expect a {seen} inside",
        "feature": feature,
        "evidence_category": pair.given,
        "predicted_category": pair.category,
        "strength": f"{figure.p:.3g}",
        "distance_mean_m": f"{distance:.2g}",
        "distance_sd_m": f"{distance / 2:.2g}",
        "size_x_typical_m": f"{far['length_m']:.2g}",
        "size_y_typical_m": f"{far['width_m']:.2g}",
        "predicted_scale": larger["scale"],
        "data_successes": f"{figure.successes:.4g}",
        "data_trials": f"{figure.trials:.4g}",
        "status": "taken from data",
        "source": f"counted in {figure.source}, {figure.buildings} buildings; distance proposed",
    }
    return Row("counts/pairs.csv", 0, cells)
