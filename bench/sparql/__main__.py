"""How fast mapped scenes answer SPARQL: one command, part by part, as tables or JSON.

    python -m bench.sparql [--json]                  all parts
    python -m bench.sparql PART [--help] [MAP...]    one part, on maps of your own

`peers` asks the same questions of the same statements in four engines; `library` asks every query
of the library; `startup` runs `afkb query` as a whole command. Without maps the bundled home is
mapped.
"""

from __future__ import annotations

from bench.part_by_part import run_parts

PARTS = ("peers", "library", "startup")


if __name__ == "__main__":
    raise SystemExit(run_parts("bench.sparql", PARTS, __doc__))
