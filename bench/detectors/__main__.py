"""How well the detectors see: one command, table and pictures.

    python -m bench.detectors [--homes DIR] [--mosd DIR] [--redkitchen DIR] [--only PART ...]
                              [--stride N] [--detector NAME ...] [--pictures OUT] [--json]

`--homes` is a folder of homes, each with `bag/` and `truth.json`, or one such home. Folders that
are not named are looked for in AFKB_DATA, else in shared/data beside the repository. Parts whose
data are missing say so in a line; the others run.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from bench.detectors.data import Asked, NoData, data_folder
from bench.detectors.parts import PARTS, part


def main(argv: Sequence[str] | None = None) -> int:
    """Run what is asked for; 1 where nothing could be measured."""
    args = _arguments(argv)
    asked = Asked(
        args.homes, args.mosd, args.redkitchen, args.stride, args.pictures, tuple(args.detector)
    )
    results: dict[str, Any] = {}
    for name in args.only or PARTS:
        try:
            asked.check(part(name).needs)
        except NoData as missing:
            sys.stderr.write(f"{name}: {missing}\n")
            continue
        results[name] = part(name).run(asked)
        if not args.json:
            sys.stdout.write("\n".join(_lines(name, results[name])) + "\n\n")
            sys.stdout.flush()
    if args.json:
        json.dump(results, sys.stdout, indent=1)
    return 0 if results else 1


def _lines(name: str, result: dict[str, Any]) -> Iterator[str]:
    yield f"== {name}"
    yield from part(name).table(result)


def _arguments(argv: Sequence[str] | None) -> argparse.Namespace:
    data = data_folder()
    parser = argparse.ArgumentParser(
        prog="python -m bench.detectors",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--homes", type=Path, default=data / "homes")
    parser.add_argument("--mosd", type=Path, default=data / "mosd")
    parser.add_argument("--redkitchen", type=Path, default=data / "redkitchen")
    parser.add_argument("--only", choices=PARTS, nargs="+", default=[], metavar="PART")
    parser.add_argument("--stride", type=int, default=1, help="look at every N-th view")
    parser.add_argument("--detector", action="append", default=[], help="instead of the default")
    parser.add_argument("--pictures", type=Path, help="folder to draw into")
    parser.add_argument("--json", action="store_true")
    return parser.parse_args(argv)


if __name__ == "__main__":
    raise SystemExit(main())
