"""The benchmark that kills: what it takes for dead, for old and for new."""

import sys

import numpy as np

from bench.endurance.folders import _told, _worst
from bench.endurance.killing import Moment, Phase, Timing, digest, kill_at
from store_samples import Names, sample_map


def test_moments_are_spread_over_the_run_its_writing_and_putting_in_place():
    moments = Timing(10.0, 8.0).moments(25, np.random.default_rng(0))
    by_phase = {p: [m.after_s for m in moments if m.phase is p] for p in Phase}
    assert [len(found) for found in by_phase.values()] == [13, 6, 6]
    assert max(by_phase[Phase.START]) <= 10 and max(by_phase[Phase.WRITING]) <= 2


STARTS_ANOTHER = """
import subprocess, sys, time
child = subprocess.Popen([sys.executable, "-c", "import sys; sys.stdin.read()"], stdin=-1)
print(flush=True)
time.sleep(60)
"""


def test_a_kill_takes_what_was_started_with_it():
    kill = kill_at([sys.executable, "-c", STARTS_ANOTHER], Moment(0.5), [])
    assert not kill.had_ended and not kill.was_writing
    assert kill.gone_after_s is not None and kill.gone_after_s < 10
    assert kill_at([sys.executable, "-c", ""], Moment(20), []).had_ended


def test_a_folder_is_the_old_map_the_new_one_or_told_of(tmp_path):
    from afkb.store import write_map

    folder = write_map(tmp_path / "map", sample_map(), {}, [], Names())
    old = digest(folder)
    (folder / "run.json").write_text("{}")
    assert _told(digest(folder), old, "new one's") == "old"
    (folder / "scene.ttl").write_bytes((folder / "scene.ttl").read_bytes()[:-40])
    assert digest(folder).startswith("broken: ")
    assert _worst({"old", digest(folder)}).startswith("broken: ")
    assert _worst({"old", "new"}) == "both" and _worst({"new"}) == "new"
    assert digest(tmp_path / "none") == "nothing"
