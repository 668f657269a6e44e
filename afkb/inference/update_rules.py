"""How a probability grows with repeated evidence: the paper's rule, and two that stay bounded.

The printed rule p ← p + 1/p (§II.D.ii) exceeds 1 at once for every p in (0, 1]; it is offered
clamped, as `literal`. Each rule is a function of the probability so far and of what one more
independent piece of evidence says.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from afkb.errors import PluginError

UpdateRule = Callable[[float, float], float]

CERTAIN = 0.97
"""No accumulation of evidence makes more certain than this: in homes, things get moved."""


def _log_odds(p: float) -> float:
    bounded = min(max(p, 1 - CERTAIN), CERTAIN)
    return math.log(bounded / (1 - bounded))


def log_odds(p: float, evidence: float) -> float:
    """Bayes with independent evidence and an even prior, clamped to [1 - CERTAIN, CERTAIN]."""
    total = _log_odds(p) + _log_odds(evidence)
    return min(max(1 / (1 + math.exp(-total)), 1 - CERTAIN), CERTAIN)


def noisy_or(p: float, evidence: float) -> float:
    """Either cause suffices: 1 - (1 - p)(1 - evidence)."""
    return min(1 - (1 - p) * (1 - evidence), 1.0)


def literal(p: float, evidence: float) -> float:
    """The paper's p + 1/p, clamped to 1; evidence of any strength counts the same."""
    return min(1.0, p + 1 / p) if p > 0 and evidence > 0 else p


RULES: dict[str, UpdateRule] = {"log-odds": log_odds, "noisy-or": noisy_or, "literal": literal}


def in_part(rule: str, evidence: float, share: float) -> float:
    """What a share (0..1) of a piece of evidence says by a rule: parts add up to the whole.

    What speaks for something never speaks against it, however weak it is.

    >>> half = in_part("noisy-or", 0.64, 0.5)
    >>> round(noisy_or(half, half), 6)
    0.64
    """
    if rule == "noisy-or":
        return float(1 - (1 - evidence) ** share)
    if rule == "literal":
        return evidence
    return 1 / (1 + math.exp(-max(_log_odds(evidence), 0.0) * share))


def update_rule(name: str) -> UpdateRule:
    """The rule of that name; `PluginError` names the known ones otherwise."""
    if name not in RULES:
        raise PluginError(f"no update rule named {name!r}; known: {', '.join(RULES)}")
    return RULES[name]


def against(p: float, likelihood_ratio: float) -> float:
    """Probability after evidence whose likelihood ratio (thing there : thing gone) is below 1."""
    odds = p / max(1 - p, 1e-9) * likelihood_ratio
    return odds / (1 + odds)
