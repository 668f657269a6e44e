"""What of a batch is done already."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import replace

from afkb.errors import MapError
from afkb.store.stored import RUN_FILE, SCENE_FILE
from afkb_mapping.batch.job import Job

_NOT_ASKED = ("resume", "update", "hours_later")


def to_do(job: Job, ontology: Sequence[dict[str, str]]) -> Job | None:
    """The job as it is to be done now; None where its map is there.

    A map is there if it was made of the same recording with the same parameters and ontology, and
    to its end; where it was interrupted, it is gone on with. `MapError` where a map of another
    recording is there, or of this one with other parameters.
    """
    folder = job.settings.out
    if not (folder / SCENE_FILE).is_file():
        return job
    try:
        run = json.loads((folder / RUN_FILE).read_text(encoding="utf-8"))
        before, source = dict(run["parameters"]), run["source"]
    except (OSError, ValueError, KeyError, TypeError):
        return job
    if source != job.settings.uri:
        raise MapError(f"{folder}: is a map of {source}; call this one otherwise (NAME=SOURCE)")
    for name, was in before.items():
        wanted = getattr(job.settings, name, None)
        wanted = list(wanted) if isinstance(wanted, tuple) else wanted
        if name not in _NOT_ASKED and was != wanted:
            raise MapError(
                f"{folder}: was made with {name} {was}, not {wanted}; resume as it was begun, or "
                "map again without --resume"
            )
    if [entry["sha256"] for entry in run.get("ontology", [])] != [o["sha256"] for o in ontology]:
        return job
    if run.get("interrupted_by"):
        return replace(job, settings=replace(job.settings, resume=True))
    return None
