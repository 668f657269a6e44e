"""Map folders under kill -9: whether each is the old map, the new one, or something else."""

from __future__ import annotations

import shutil
import sys
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np

from bench.endurance.killing import Killed, digest, kill_at, timed


def killed_often(
    command: Sequence[str], old: dict[Path, Path], times: int, seed: int
) -> dict[str, Any]:
    """Kill a command at random moments; each time the folders begin as copies of old ones.

    `old`: folder that the command writes to where its old map is. Afterwards the command runs to
    its end over what the last kill left.
    """
    folders = list(old)
    before = {folder: digest(copy) for folder, copy in old.items()}
    _restore(old)
    timing = timed(command, folders)
    after = {folder: digest(folder) for folder in folders}
    if any(before[f] == after[f] for f in folders):
        raise SystemExit("the new map is the old one: nothing can be told apart")
    kills = []
    for moment in timing.moments(times, np.random.default_rng(seed)):
        _restore(old)
        kill = kill_at(command, moment, folders)
        found = {_told(digest(f), before[f], after[f]) for f in folders}
        kills.append(replace(kill, found=_worst(found)))
        sys.stderr.write(f"{len(kills)}/{times}: {kills[-1].found}\n")
    timed(command, folders)
    return {
        "whole_s": round(timing.whole_s, 2),
        "writing_s": round(timing.whole_s - timing.writes_from_s, 2),
        "new_in_the_end": all(digest(f) == after[f] for f in folders),
        "left_over": sum(len(list(f.parent.glob(f".{f.name}.*"))) for f in folders),
        **summary(kills),
    }


def _restore(old: dict[Path, Path]) -> None:
    for folder, copy in old.items():
        shutil.rmtree(folder, ignore_errors=True)
        shutil.copytree(copy, folder)


def _told(found: str, before: str, after: str) -> str:
    return "old" if found == before else "new" if found == after else found


def _worst(found: set[str]) -> str:
    strange = found - {"old", "new"}
    return sorted(strange)[0] if strange else "both" if len(found) > 1 else found.pop()


def summary(kills: Sequence[Killed]) -> dict[str, Any]:
    """What was found after the kills, and how long started processes lived on."""
    lived_on = [k.gone_after_s for k in kills]
    told = [seconds for seconds in lived_on if seconds is not None]
    return {
        "kills": len(kills),
        "too_late": sum(k.had_ended for k in kills),
        "while_writing": sum(k.was_writing for k in kills),
        "found": dict(Counter(k.found for k in kills)),
        "never_gone": len(lived_on) - len(told),
        "gone_after_s": round(max(told, default=0.0), 2),
        "each": [asdict(k) for k in kills],
    }


def table(result: dict[str, Any]) -> Iterable[str]:
    """The result as lines."""
    yield f"a run takes {result['whole_s']} s, the last {result['writing_s']} s of it to write"
    yield (
        f"killed {result['kills']} times, {result['while_writing']} while it wrote, "
        f"{result['too_late']} after its end"
    )
    for found, n in sorted(result["found"].items()):
        yield f"  afterwards {found}: {n}"
    yield f"processes that outlived it: {result['never_gone']} for good, the others "
    yield f"  {result['gone_after_s']} s at most"
    yield f"run again: the new map {result['new_in_the_end']}, left over {result['left_over']}"
