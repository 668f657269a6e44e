"""Labelled scores from whatever recordings there are."""

from __future__ import annotations

from collections.abc import Iterator

from bench.calibration.homes import HomeLabels
from bench.calibration.kitchen import KitchenLabels
from bench.calibration.mosd import CloudLabels
from bench.calibration.samples import Sample, samples_of
from bench.detectors.data import Asked, NoData
from bench.detectors.mosd_clouds import clouds_in
from bench.detectors.seen import run_detectors


def gathered(asked: Asked) -> list[Sample]:
    """Samples of every home, table-top and kitchen that is there; `NoData` where none is."""
    sources = {"homes": _of_homes, "mosd": _of_clouds, "redkitchen": _of_kitchen}
    samples: list[Sample] = []
    for name, source in sources.items():
        try:
            asked.check((name,))
        except NoData:
            continue
        samples += source(asked)
    if not samples:
        raise NoData("no labelled recording; name --homes, --mosd or --redkitchen")
    return samples


def _of_homes(asked: Asked) -> Iterator[Sample]:
    for home in asked.homes:
        yield from samples_of(home.seen, HomeLabels(home, asked.host.knowledge_base))


def _of_clouds(asked: Asked) -> Iterator[Sample]:
    clouds = list(clouds_in(asked.mosd))
    seen = run_detectors((c.view for c in clouds), asked.host.detectors(asked.detectors))
    yield from samples_of(seen, CloudLabels(clouds))


def _of_kitchen(asked: Asked) -> Iterator[Sample]:
    yield from samples_of(asked.kitchen.seen, KitchenLabels(asked.kitchen))
