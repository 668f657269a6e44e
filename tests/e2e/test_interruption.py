"""A signal ends a run with a valid map of what was seen until then."""

import json
import signal
import subprocess
import sys
import time

import pytest

from afkb.store import load

RUN = "from afkb.cli.app import main; main()"


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_leaves_a_valid_map(tmp_path, number):
    out = tmp_path / "map"
    process = subprocess.Popen(
        [sys.executable, "-c", RUN, "map", "world:paper_home", "--out", out],
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        # The first line of progress comes when frames are being mapped.
        assert "frames" in process.stderr.readline()
        time.sleep(0.3)
        process.send_signal(number)
        _, rest = process.communicate(timeout=120)
    finally:
        process.kill()
    assert process.returncode == 128 + number, rest
    assert "Traceback" not in rest
    run = json.loads((out / "run.json").read_text())
    assert run["interrupted_by"] == number.name
    assert 0 < run["frames"]["used"] < 82
    assert load(out) is not None
    assert not list(tmp_path.glob(".map*"))
