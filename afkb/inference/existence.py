"""How one more look changes the probability that something exists (paper §II.D, Algorithm 1)."""

from __future__ import annotations

from collections.abc import Iterable

from afkb.flow import Change, ChangeKind
from afkb.inference.update_rules import UpdateRule, against, log_odds

EMPTY_LIKELIHOOD_RATIO = 0.03
"""P(seen through | still there) over P(seen through | gone): most of a thing's surface, in clear
view, is seen through by mistake only where the pose is off or the thing is see-through."""
OVERLOOKED_LIKELIHOOD_RATIO = 0.55
"""P(not detected | there) over P(not detected | a false cue): detectors find about half of the
things they have in clear view, and repeat few of their errors from elsewhere."""

MULTIPLYING = frozenset((
    ChangeKind.SEEN_THROUGH,
    ChangeKind.OVERLOOKED,
    ChangeKind.WALLED_OFF,
    ChangeKind.SURROUNDED,
))  # fmt: skip
"""Steps that multiply the odds by a likelihood ratio."""


def after(
    kind: ChangeKind, evidence: float, before: float | None, rule: UpdateRule = log_odds
) -> float:
    """Probability after one step; `rule` is the one by which repeated predictions grow.

    A first sighting or prediction, `before` which nothing is known, is believed as it is. A look
    multiplies the odds by its likelihood ratio, as does a wall that comes to light; time, and that
    evidence is gone, the probability by the share that they leave. What confirms a prediction says
    how probable it is now.
    """
    if before is None:
        return evidence
    if kind is ChangeKind.SIGHTED:
        return log_odds(before, evidence)
    if kind in MULTIPLYING:
        return against(before, evidence)
    if kind in (ChangeKind.AGED, ChangeKind.EVIDENCE_GONE):
        return before * evidence
    if kind is ChangeKind.CONFIRMED:
        return evidence
    return rule(before, evidence)


def folded(changes: Iterable[Change], rule: UpdateRule = log_odds) -> float | None:
    """The probability that steps lead to, one after the other; None of none.

    >>> seen = [Change(ChangeKind.SIGHTED, 0.8, None, 0.8, 0.0)]
    >>> round(folded([*seen, Change(ChangeKind.OVERLOOKED, 0.5, 0.8, 0.0, 1.0)]), 3)
    0.667
    """
    p: float | None = None
    for number, change in enumerate(changes):
        p = after(change.kind, change.evidence, p if number else change.before, rule)
    return p
