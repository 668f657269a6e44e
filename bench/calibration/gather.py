"""Labelled scores from whatever recordings there are."""

from __future__ import annotations

from bench.calibration.homes import HomeLabels
from bench.calibration.kitchen import KitchenLabels
from bench.calibration.samples import Sample, samples_of
from bench.detectors.data import Asked, NoData


def gathered(asked: Asked) -> list[Sample]:
    """Samples of all homes and, where they are, of the kitchen; raises `NoData` without homes."""
    knowledge_base = asked.host.knowledge_base
    samples: list[Sample] = []
    for home in asked.homes:
        samples += samples_of(home.seen, HomeLabels(home, knowledge_base))
    try:
        asked.check(("redkitchen",))
        samples += samples_of(asked.kitchen.seen, KitchenLabels(asked.kitchen))
    except NoData:
        pass
    return samples
