"""Recorded homes with their maps: those that are named, else made once for all parts of a run."""

from __future__ import annotations

import argparse
import tempfile
from functools import cache
from pathlib import Path

from afkb.plugins.host import PluginHost
from afkb_mapping.run import make_map
from afkb_mapping.run_record import Settings
from bench.detectors.data import Home, data_folder, homes_in


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Where the homes are, and which maps of them there are already."""
    parser.add_argument("--homes", type=Path, default=data_folder() / "homes")
    parser.add_argument("--map", type=Path, action="append", default=[], help="map of a --home")
    parser.add_argument("--home", type=Path, action="append", default=[])
    parser.add_argument("--stride", type=int, default=1, help="map every N-th view")


def home_maps(args: argparse.Namespace, host: PluginHost) -> list[tuple[Path, Home]]:
    """Map folders, each with its home; `NoData` where there is no home.

    Maps that are not named are made, as `afkb map` makes them, and kept until the program ends.
    """
    if len(args.map) != len(args.home):
        raise SystemExit("error: name one --home for each --map")
    if args.map:
        return [
            (folder, homes_in(at, host)[0]) for folder, at in zip(args.map, args.home, strict=True)
        ]
    return [(_made(h.folder, args.stride), h) for h in homes_in(args.homes, host)]


@cache
def _made(home: Path, stride: int) -> Path:
    out = Path(_scratch().name) / f"{home.name}-{stride}"
    make_map(PluginHost(), Settings(uri=str(home / "bag"), out=out, stride=stride))
    return out


@cache
def _scratch() -> tempfile.TemporaryDirectory[str]:
    return tempfile.TemporaryDirectory()
