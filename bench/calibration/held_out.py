"""Probabilities of recordings that had no part in the fit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from bench.calibration.fitting import curves_of
from bench.calibration.samples import Sample


def held_out(samples: Sequence[Sample]) -> list[Sample]:
    """Each sample with the `p` that curves of all other buildings give it.

    Scores of what no other building has an example of are left out.
    """
    found: list[Sample] = []
    for building in sorted({s.building for s in samples}):
        others = [s for s in samples if s.building != building]
        for detector in sorted({s.detector for s in samples}):
            curves = curves_of([s for s in others if s.detector == detector])
            for s in samples:
                curve = curves.get(s.feature)
                if s.building == building and s.detector == detector and curve:
                    found.append(replace(s, p=s.by(curve)))
    return found
