"""One command for a benchmark of several parts, as tables or JSON.

A part is a module of the benchmark's package, imported when it is asked for. It has
`add_arguments(parser)` (its tables, maps or recordings), `run(args)` (a result that goes into JSON;
raises `NoData` where its data are missing) and `table(result)` (its lines).
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Iterable, Sequence
from importlib import import_module
from typing import Any, Protocol, cast

from bench.detectors.data import NoData


class Part(Protocol):
    """One question, measured."""

    def add_arguments(self, parser: argparse.ArgumentParser) -> None:
        """Add the options that name its data."""

    def run(self, args: argparse.Namespace) -> Any:
        """What was measured; raises `NoData` where its data are missing."""

    def table(self, result: Any) -> Iterable[str]:
        """The result as lines."""


def run_parts(
    package: str, parts: Sequence[str], doc: str | None, argv: Sequence[str] | None = None
) -> int:
    """Run the part that is asked for, or all; 1 where nothing could be measured.

    `package`: of the modules that `parts` names; `doc`: what its `--help` says.
    """

    def part(name: str) -> Part:
        return cast(Part, import_module(f"{package}.{name}"))

    def parsed(words: Sequence[str] | None) -> argparse.Namespace:
        parser = argparse.ArgumentParser(
            prog=f"python -m {package}",
            description=doc,
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        parser.add_argument("--json", action="store_true")
        named = parser.add_subparsers(dest="part", metavar="PART")
        for name in parts:
            own = named.add_parser(name, help=f"see `python -m {package} {name} --help`")
            own.add_argument("--json", action="store_true")
            part(name).add_arguments(own)
        return parser.parse_args(words)

    asked = parsed(argv)
    results: dict[str, Any] = {}
    for name in [asked.part] if asked.part else parts:
        args = asked if asked.part else parsed([name])
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
