"""How recordings are read: one command, part by part, as tables or JSON.

    python -m bench.sources [--json]                  all parts, on the data that are at hand
    python -m bench.sources PART [--help] [...]       one part, on data of your own

Data that are not named are looked for in AFKB_DATA, else in shared/data beside the repository.
"""

from __future__ import annotations

from bench.part_by_part import run_parts

PARTS = ("reading", "agreement")


if __name__ == "__main__":
    raise SystemExit(run_parts("bench.sources", PARTS, __doc__))
