"""Kill -9 at random moments, and see what is left: one command, part by part, as tables or JSON.

    python -m bench.endurance [--json]                  all parts
    python -m bench.endurance PART [--times N] [...]    one part

`maps`, `updates`, `batches` and `uploads` are killed 25 times each unless `--times` says
otherwise: half of the moments are spread over the whole run, a quarter over the writing of its
files, a quarter over putting them in place. `writing` is that alone, 200 times. Everything is made
in a scratch folder, of the bundled home; no data are needed. `uploads` needs the Oxigraph server
(`pip install oxigraph`).
"""

from __future__ import annotations

from bench.part_by_part import run_parts

PARTS = ("writing", "maps", "updates", "batches", "uploads")


if __name__ == "__main__":
    raise SystemExit(run_parts("bench.endurance", PARTS, __doc__))
