"""`afkb batch` over maps that stand, killed at random moments, with all its processes' parent."""

from __future__ import annotations

import argparse
import tempfile
from importlib import resources
from pathlib import Path
from typing import Any

from bench.endurance.folders import killed_often, table
from bench.endurance.killing import WORLD, add_times, afkb, run_to_end

__all__ = ["add_arguments", "run", "table"]

add_arguments = add_times


def run(args: argparse.Namespace) -> dict[str, Any]:
    """What was found after each kill, of two recordings that are mapped at once."""
    with tempfile.TemporaryDirectory() as scratch:
        old, out = Path(scratch, "kept"), Path(scratch, "maps")
        run_to_end("batch", f"a={WORLD}", "--out", old, "--stop", "2")
        run_to_end("map", WORLD, "--start", "6", "--stop", "8", "--out", old / "b")
        command = afkb("batch", f"a={WORLD}", "--out", out, "--stop", "3")
        command += [f"b={_same_world(scratch)}", "--workers", "2"]
        kept = {out / name: old / name for name in ("a", "b")}
        return killed_often(command, kept, args.times, args.seed)


def _same_world(scratch: str) -> Path:
    """The bundled home under another name: a batch maps no recording twice."""
    bundled = resources.files("afkb_simulation") / "worlds" / "paper_home.world.yaml"
    copy = Path(scratch) / "home.world.yaml"
    copy.write_bytes(bundled.read_bytes())
    return copy
