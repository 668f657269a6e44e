"""What is to be told of how views were placed: where the robot was lost, blind, found; gaps."""

from __future__ import annotations

import logging
from dataclasses import dataclass, field

from afkb_mapping.placing.frame_gaps import FrameGaps

LOG = logging.getLogger("afkb_mapping")


@dataclass(slots=True)
class PlacingRecord:
    """Counts, and a line for each time that the robot was found again; told when they happen."""

    lost: int = 0
    blind: int = 0
    first_lost: int | None = None
    is_lost: bool = False
    found_again: list[str] = field(default_factory=list)
    gaps: FrameGaps = field(default_factory=FrameGaps)

    def lose(self, index: int) -> None:
        """A view that was not taken where odometry says, and fits nowhere for sure."""
        if not self.is_lost:
            LOG.warning("frame %d: lost; views are skipped until they fit the map", index)
        self.first_lost = index if self.first_lost is None else self.first_lost
        self.is_lost = True
        self.lost += 1

    def withdraw(self, views: int) -> None:
        """So many views before were not taken where they were placed, as it turns out."""
        self.lost += views

    def find(self, index: int, metres: float, degrees: float) -> None:
        """The robot is known to be somewhere again, so far from where odometry had it."""
        self.is_lost = False
        line = f"found again at frame {index}, {metres:.2f} m and {degrees:.0f}° from odometry"
        LOG.warning("%s", line)
        self.found_again.append(line)

    def end(self) -> None:
        """The recording is over: frames that never came are told of."""
        if self.gaps.note:
            LOG.warning("%s", self.gaps.note)

    @property
    def counts(self) -> dict[str, int]:
        """What run.json counts."""
        found = {"lost_views": self.lost, "found_again": len(self.found_again)}
        return found | {"blind_views": self.blind, "lost_frames": self.gaps.lost}

    @property
    def notes(self) -> tuple[str, ...]:
        """Lines for run.json and the user; none where nothing went wrong."""
        notes = [self.gaps.note] if self.gaps.note else []
        if self.lost:
            notes.append(
                f"lost from frame {self.first_lost} on: {self.lost} views look through what is "
                "mapped where odometry has them, or came just before such, and were skipped "
                "(odometry jumped, the robot was carried, or another place's recording follows)"
            )
        notes += self.found_again
        if self.blind:
            notes.append(
                f"{self.blind} views show too little to be placed by: they are where odometry "
                "has them"
            )
        return tuple(notes)
