"""A predicted thing that is seen: the paper's own loop closing (§II.D.ii)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from afkb.flow import Closure, LoopKind
from afkb_mapping.loops.candidates import checked
from afkb_mapping.loops.proposals import Proposal
from afkb_mapping.loops.survey import Survey


def predictions_seen(survey: Survey, predicted: Sequence[Closure]) -> Iterator[Proposal]:
    """For each prediction that came true: the view that sees the thing, and who expected it.

    Where a thing was expected is known to half its size only; so the prediction says that both are
    of one place, and walls and free space have to say how they lie. One that came true before the
    robot had been away closes no loop.
    """
    stamps = np.array([s.stamp for s in survey.stations])
    for closure in predicted:
        if not np.isfinite(closure.predicted_stamp):
            continue
        earlier = int(np.argmin(np.abs(stamps - closure.predicted_stamp)))
        later = int(np.argmin(np.abs(stamps - closure.stamp)))
        if earlier < later and survey.is_away(earlier, later):
            yield checked(
                survey,
                LoopKind.PREDICTION,
                earlier,
                later,
                survey.expected(earlier, later),
                closure.predicted_probability,
            )
