"""How well maps serve: one command, part by part, as tables or JSON.

    python -m bench.mapping [--json]                  all parts, on the data that are at hand
    python -m bench.mapping PART [--help] [...]       one part, on data of your own

Data that are not named are looked for in AFKB_DATA, else in shared/data beside the repository.
Parts whose data are missing say so in a line; the others run.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from typing import Any

from bench.detectors.data import NoData
from bench.mapping.parts import PARTS, part


def main(argv: Sequence[str] | None = None) -> int:
    """Run what is asked for; 1 where nothing could be measured."""
    asked = _parser().parse_args(argv)
    results: dict[str, Any] = {}
    for name in [asked.part] if asked.part else PARTS:
        args = asked if asked.part else _parser().parse_args([name])
        try:
            results[name] = part(name).run(args)
        except NoData as missing:
            sys.stderr.write(f"{name}: {missing}\n")
            continue
        if not asked.json:
            lines = [f"== {name}", *part(name).table(results[name])]
            sys.stdout.write("\n".join(lines) + "\n\n")
            sys.stdout.flush()
    if asked.json:
        json.dump(results, sys.stdout, indent=1)
    return 0 if results else 1


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="python -m bench.mapping",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--json", action="store_true")
    parts = parser.add_subparsers(dest="part", metavar="PART")
    for name in PARTS:
        own = parts.add_parser(name, help=f"see `python -m bench.mapping {name} --help`")
        own.add_argument("--json", action="store_true")
        part(name).add_arguments(own)
    return parser


if __name__ == "__main__":
    raise SystemExit(main())
