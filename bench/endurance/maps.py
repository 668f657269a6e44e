"""`afkb map` over a map that stands, killed at random moments."""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path
from typing import Any

from bench.endurance.folders import killed_often, table
from bench.endurance.killing import WORLD, add_times, afkb, run_to_end

__all__ = ["add_arguments", "run", "table"]

add_arguments = add_times


def run(args: argparse.Namespace) -> dict[str, Any]:
    """What was found after each kill."""
    with tempfile.TemporaryDirectory() as scratch:
        old, folder = Path(scratch, "kept", "map"), Path(scratch, "map")
        run_to_end("map", WORLD, "--stop", "2", "--out", old)
        command = afkb("map", WORLD, "--stop", "3", "--out", folder)
        return killed_often(command, {folder: old}, args.times, args.seed)
