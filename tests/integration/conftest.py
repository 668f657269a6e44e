"""What is made once for all integration tests: the demo's map, and a stranger's package."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from running import ROOT, run_afkb


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
