"""How sure it is that something exists, and by which steps that came about."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass, field

from afkb.flow import Change, ChangeKind
from afkb.inference.existence import after
from afkb.inference.update_rules import UpdateRule, log_odds

KEPT_CHANGES = 12
"""So many steps are kept, the last ones: what a thing went through in a visit, mostly. The first
of them tells where it starts."""


@dataclass(slots=True, eq=False)
class Existence:
    """A probability and the last steps that led to it, oldest first.

    `rule`: by which repeated predictions add up.
    """

    probability: float = 0.5
    history: deque[Change] = field(default_factory=lambda: deque(maxlen=KEPT_CHANGES))
    rule: UpdateRule = log_odds

    def take(
        self,
        kind: ChangeKind,
        evidence: float,
        stamp: float,
        view: int | None = None,
        by: Iterable[str] = (),
    ) -> None:
        """Take in one piece of evidence; a step that changes nothing is not kept.

        `by`: ids of the things it comes from.
        """
        before = self.probability if self.history else None
        self.probability = after(kind, evidence, before, self.rule)
        if before != self.probability:
            change = Change(kind, evidence, before, self.probability, stamp, view, tuple(by))
            self.history.append(change)
