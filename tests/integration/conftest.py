"""What is made once for all integration tests: the demo's map, and a stranger's package."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


def run_afkb(*arguments: str, cwd: Path, extra_path: Path | None = None) -> str:
    """What `afkb` prints; fails with its stderr where it exits with anything but 0."""
    done = subprocess.run(
        [Path(sys.executable).parent / "afkb", *arguments],
        cwd=cwd,
        env=os.environ | ({"PYTHONPATH": str(extra_path)} if extra_path else {}),
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert done.returncode == 0, f"afkb {' '.join(arguments)}: {done.stderr}"
    return done.stdout


@pytest.fixture(scope="session")
def demo_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder in which `afkb demo --out demo-map` has run."""
    folder = tmp_path_factory.mktemp("demo")
    run_afkb("demo", "--out", "demo-map", cwd=folder)
    return folder


@pytest.fixture(scope="session")
def third_party(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder for PYTHONPATH into which the sample package is installed."""
    target = tmp_path_factory.mktemp("third-party")
    install = ["-m", "pip", "install", "--quiet", "--no-deps", "--no-build-isolation"]
    package = ROOT / "examples" / "third_party"
    subprocess.run(
        [sys.executable, *install, "--no-index", "--target", target, package], check=True
    )
    return target
