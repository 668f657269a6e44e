"""How well maps serve: one command, part by part, as tables or JSON.

    python -m bench.mapping [--json]                  all parts, on the data that are at hand
    python -m bench.mapping PART [--help] [...]       one part, on data of your own

Data that are not named are looked for in AFKB_DATA, else in shared/data beside the repository.
Parts whose data are missing say so in a line; the others run.
"""

from __future__ import annotations

from bench.part_by_part import run_parts

PARTS = (
    "locate",
    "diff",
    "growth",
    "floorplans",
    "trajectory",
    "faults",
    "vacuum",
    "loops",
    "relations",
    "lightness",
    "paper",
    "deceived_hall",
)


if __name__ == "__main__":
    raise SystemExit(run_parts("bench.mapping", PARTS, __doc__))
