"""Runs the command line as a user would."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]


def run_afkb(*arguments: str, cwd: Path, extra_path: Path | None = None) -> str:
    """What `afkb` prints; fails with its stderr where it exits with anything but 0."""
    done = subprocess.run(
        [Path(sys.executable).parent / "afkb", *arguments],
        cwd=cwd,
        env=os.environ | ({"PYTHONPATH": str(extra_path)} if extra_path else {}),
        capture_output=True,
        text=True,
        timeout=900,  # kernels compile on first use, which a busy machine drags out
        check=False,
    )
    assert done.returncode == 0, f"afkb {' '.join(arguments)}: {done.stderr}"
    return done.stdout
