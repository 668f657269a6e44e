"""What the detectors make of one placed view: coarse before fine, one detection a thing."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from afkb.errors import BadFrame, PluginError
from afkb.flow import Detection, View
from afkb.plugins.protocols import Detector
from afkb_mapping.one_per_thing import one_per_thing
from afkb_mapping.run_record import Stages


class Perception:
    """The detectors of a run, stage by stage (paper §II.D: the search goes from coarse to fine)."""

    def __init__(self, detectors: Sequence[Detector], stages: Stages) -> None:
        self._detectors = detectors
        self._stages = stages

    def detections(self, view: View) -> list[Detection]:
        """All detections of a view; what several detectors said of one thing is joined.

        Raises `PluginError` where a detector fails, with its name.
        """
        found: list[Detection] = []
        for stage in sorted({d.stage for d in self._detectors}):
            earlier = tuple(found)
            for detector in (d for d in self._detectors if d.stage == stage):
                name = detector.name
                with self._stages.timed(f"detect {name}"), blamed("detector", name):
                    found += detector.detect(view, earlier)
        with blamed("detector", ", ".join(d.name for d in self._detectors)):
            return one_per_thing(found)


@contextmanager
def blamed(what: str, name: str) -> Iterator[None]:
    """Say whose fault it is when a plugin fails, whatever it fails with."""
    try:
        yield
    except BadFrame:
        raise
    except Exception as error:
        raise PluginError(
            f"{what} {name!r} failed with {type(error).__name__}: {error}; "
            "mend it, or leave it out by naming the others"
        ) from error
