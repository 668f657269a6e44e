"""How well the network infers: one command, part by part, as tables or JSON.

    python -m bench.inference [--json]                  all parts, on the data that are at hand
    python -m bench.inference PART [--help] [...]       one part, on data of your own

Data that are not named are looked for in AFKB_DATA, else in shared/data beside the repository.
Parts whose data are missing say so in a line; the others run.
"""

from __future__ import annotations

from bench.part_by_part import run_parts

PARTS = (
    "rooms",
    "contents",
    "homes",
    "learning",
    "things",
    "context",
    "predicted",
    "rules",
    "finding",
    "hardships",
    "speed",
)


if __name__ == "__main__":
    raise SystemExit(run_parts("bench.inference", PARTS, __doc__))
