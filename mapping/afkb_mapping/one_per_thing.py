"""One detection a thing: what detectors of several stages said of it, joined."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from afkb.flow import Detection


def one_per_thing(detections: Sequence[Detection]) -> list[Detection]:
    """A view's detections with what is `about` the same thing joined, in order of first mention.

    The first mention gives place, box, footprint and pixels. Of a feature that several speak of the
    last word counts: a later stage has looked closer. A joined detection keeps its `parts`.

    Raises `ValueError` where one is about itself or about what comes later.
    """
    return [_joined(told) for told in told_of_each(detections).values()]


def told_of_each(detections: Sequence[Detection]) -> dict[int, list[Detection]]:
    """What a view's detections say of each thing, by the index of what first told of it.

    Raises `ValueError` where one is about itself or about what comes later.
    """
    roots: list[int] = []
    told: dict[int, list[Detection]] = {}
    for index, detection in enumerate(detections):
        if detection.about is not None and not 0 <= detection.about < index:
            raise ValueError(
                f"{detection.detector}: detection {index} is about detection {detection.about}; "
                "it can be about an earlier one only"
            )
        root = index if detection.about is None else roots[detection.about]
        roots.append(root)
        told.setdefault(root, []).append(detection)
    return told


def _joined(told: Sequence[Detection]) -> Detection:
    first = told[0]
    if len(told) == 1:
        return first
    affordances = {name: p for d in told for name, p in d.affordances.items()}
    measures = {name: value for d in told for name, value in d.measures.items()}
    return replace(first, affordances=affordances, measures=measures, parts=tuple(told))
