"""Runs the command line as a user would."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from documents import ROOT, blocks


def run_document(document: str, folder: Path, extra_path: Path | None = None) -> list[str]:
    """Run a document's `bash` blocks in a folder; what each of them printed."""
    (folder / "examples").symlink_to(ROOT / "examples")
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    extra = {"PYTHONPATH": str(extra_path)} if extra_path else {}
    printed = []
    for block in (b for b in blocks("bash") if b.document == document):
        done = subprocess.run(
            ["bash", "-euo", "pipefail", "-c", block.text],
            cwd=folder,
            env=os.environ | {"PATH": path, "COLUMNS": "200"} | extra,
            capture_output=True,
            text=True,
            timeout=900,
            check=False,
        )
        assert done.returncode == 0, f"{block.id}\n{done.stderr}"
        printed.append(done.stdout)
    return printed


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
