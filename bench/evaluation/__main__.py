"""All measurements, and the document that tells them.

    python -m bench.evaluation run [NAME ...] [--again]   measure what is missing, or those named
    python -m bench.evaluation write                      write docs/evaluation.md from the results
    python -m bench.evaluation list                       name them, and when each was measured

Results are kept in `bench/results`, a file each, so that a run that was stopped goes on where it
was. Run it on a machine with nothing else to do; all of it takes some hours.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence

from bench.evaluation.chapters import MEASUREMENTS
from bench.evaluation.measuring import NotMeasured, measured
from bench.evaluation.results import Result
from bench.evaluation.writing import PAGE, page


def main(argv: Sequence[str] | None = None) -> int:
    """Do what is asked for; 1 where a measurement failed."""
    parser = argparse.ArgumentParser(
        prog="python -m bench.evaluation",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("what", choices=["run", "write", "list"])
    parser.add_argument("names", nargs="*", metavar="NAME")
    parser.add_argument("--again", action="store_true", help="measure what has a result as well")
    args = parser.parse_args(argv)
    unknown = [name for name in args.names if name not in MEASUREMENTS]
    if unknown:
        parser.error(f"no measurement is called {unknown[0]}; see `list`")
    if args.what == "write":
        PAGE.write_text(page(), encoding="utf-8")
        return 0
    if args.what == "list":
        for name in MEASUREMENTS:
            found = Result.load(name)
            sys.stdout.write(f"{name:24} {found.date if found else 'not measured'}\n")
        return 0
    return _run(args.names, args.again)


def _run(names: Sequence[str], again: bool) -> int:
    failed = 0
    for name in names or MEASUREMENTS:
        if not (names or again) and Result.load(name) is not None:
            continue
        try:
            result = measured(MEASUREMENTS[name])
        except NotMeasured as error:
            sys.stderr.write(f"{name}: not measured: {error}\n")
            failed += 1
            continue
        sys.stdout.write(f"{name}: {result.seconds} s, {result.save(name).name}\n")
        sys.stdout.flush()
    return 1 if failed else 0


if __name__ == "__main__":
    raise SystemExit(main())
