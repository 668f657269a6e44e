"""`afkb serve` under attack and at work: one command, part by part, as tables or JSON.

    python -m bench.serving [--json]                  all parts, on the bundled home
    python -m bench.serving PART --map MAP            one part, on a map of your own

The server is started as users start it, with its usual limits, and asked over HTTP. Memory is that
of all its processes together (PSS: what they share counts once), looked at every 50 ms.
"""

from __future__ import annotations

from bench.part_by_part import run_parts

PARTS = ("attacks", "crowd", "everyday")


if __name__ == "__main__":
    raise SystemExit(run_parts("bench.serving", PARTS, __doc__))
