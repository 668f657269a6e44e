"""Fit the tables that turn detectors' scores into probabilities, from labelled recordings.

    python -m bench.calibration fit [--homes DIR] [--redkitchen DIR] [--stride N]
                                    [--detector NAME ...] [--dry]

Runs the detectors, labels what they say, fits a curve to each detector and feature, and writes
`calibration.csv` into the folder of each detector's plugin (`--dry`: only prints). How well it
holds on buildings that had no part in the fit: `python -m bench.detectors --only calibration`.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from bench.calibration.gather import gathered
from bench.calibration.report import report, table
from bench.calibration.tables import write_tables
from bench.detectors.data import Asked, data_folder


def main(argv: Sequence[str] | None = None) -> int:
    data = data_folder()
    parser = argparse.ArgumentParser(
        prog="python -m bench.calibration",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("what", choices=["fit"])
    parser.add_argument("--homes", type=Path, default=data / "homes")
    parser.add_argument("--mosd", type=Path, default=data / "mosd")
    parser.add_argument("--redkitchen", type=Path, default=data / "redkitchen")
    parser.add_argument("--stride", type=int, default=1)
    parser.add_argument("--detector", action="append", default=[])
    parser.add_argument("--dry", action="store_true")
    args = parser.parse_args(argv)
    asked = Asked(args.homes, args.mosd, args.redkitchen, args.stride, None, tuple(args.detector))
    samples = gathered(asked)
    sys.stdout.write("\n".join(table(report(samples))) + "\n")
    if not args.dry:
        moved = write_tables(asked.host.detectors(asked.detectors), samples)
        for path, by in moved.items():
            sys.stdout.write(f"{path}: probabilities moved by up to {by:.3f}\n")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
