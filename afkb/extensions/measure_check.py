"""Checks what fuzzy ranges are of: measures that there are, of what the feature is grounded on."""

from __future__ import annotations

from afkb.extensions.problems import Problems, nearest
from afkb.extensions.statements import Statements
from afkb.extensions.terms import Terms
from afkb.ontology.names import fragment


def check_measures(statements: Statements, known: Terms, problems: Problems) -> None:
    """Note fuzzy ranges of what nothing measures, or of what their feature's things don't have.

    An ontology without measures of its own, as an older one, is not held to any.
    """
    if not known.measures:
        return
    for trapezoid in statements.of_type("Trapezoid"):
        measure = statements.one(trapezoid, "parameterName")
        feature = statements.one(trapezoid, "ofFeature")
        place = statements.place(trapezoid)
        if measure not in known.measures:
            problems.add(
                place,
                f"{fragment(feature)}: nothing measures {measure}; "
                f"{nearest(measure, known.measures)}, or add it under `measures:`",
            )
            continue
        has = known.measures[measure]
        for subject in statements.many(feature, "groundedOn"):
            if subject not in has:
                problems.add(
                    place,
                    f"{fragment(feature)}: {measure} is no measure of a {subject}, only of: "
                    f"{', '.join(has)}; take another measure, or ground the feature on those",
                )
