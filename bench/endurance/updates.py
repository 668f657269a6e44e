"""`afkb map --update`, a later visit, killed at random moments."""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path
from typing import Any

from bench.endurance.folders import killed_often, table
from bench.endurance.killing import WORLD, add_times, afkb, run_to_end

__all__ = ["add_arguments", "run", "table"]

add_arguments = add_times
FRAMES = "4"


def run(args: argparse.Namespace) -> dict[str, Any]:
    """What was found after each kill; the later visit is to the same place, a day after."""
    with tempfile.TemporaryDirectory() as scratch:
        old, folder = Path(scratch, "kept", "map"), Path(scratch, "map")
        run_to_end("map", WORLD, "--stop", FRAMES, "--out", old)
        later = ("map", WORLD, "--stop", FRAMES, "--hours-later", "24", "--update", folder)
        return killed_often(afkb(*later), {folder: old}, args.times, args.seed)
