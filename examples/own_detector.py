"""A detector of one's own, in a map made from Python: shelves that are within a child's reach.

usage: python examples/own_detector.py SOURCE MAP
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import replace

from afkb.flow import Detection, View
from afkb_mapping.api import map_recording

REACH_M = 0.9
"""A child of three reaches about this high."""


class WithinReach:
    """Says of every support below `REACH_M` that one can climb on it."""

    name = "within-reach"
    affordances = ("StepAbility",)
    stage = 1

    def detect(self, view: View, earlier: Sequence[Detection]) -> Sequence[Detection]:
        """One detection about each low support among those of stage 0."""
        return [
            replace(found, detector=self.name, affordances={"StepAbility": 0.9}, about=index)
            for index, found in enumerate(earlier)
            if found.affords("SupportAbility") and 0.1 < found.position_xyz[2] < REACH_M
        ]


def main(source: str, folder: str) -> None:
    """Map a recording with the detector beside those that are installed, and list what it found."""
    home = map_recording(source, folder, add=[WithinReach()])
    for node in home.nodes("ObservedEntity"):
        if "StepAbility" in node["affords"]:
            print(f"{node['id']}: {node['z']:.2f} m high, in {node['room']}")


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2])
