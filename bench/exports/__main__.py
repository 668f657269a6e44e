"""What maps weigh and how fast they are read: one command, part by part, as tables or JSON.

    python -m bench.exports [--json]                  all parts, on the data that are at hand
    python -m bench.exports PART [--help] [...]       one part, on maps of your own

Without maps the bundled home is mapped, and the recorded homes in AFKB_DATA, else in shared/data
beside the repository, where they are there.
"""

from __future__ import annotations

from bench.part_by_part import run_parts

PARTS = ("formats", "peers")


if __name__ == "__main__":
    raise SystemExit(run_parts("bench.exports", PARTS, __doc__))
