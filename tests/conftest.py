"""What all tests share."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]


@pytest.fixture(scope="session")
def data_dir() -> Path:
    """The folder of recordings: AFKB_DATA, else shared/data beside the repository."""
    folder = Path(os.environ.get("AFKB_DATA", ROOT.parent / "shared" / "data"))
    if not folder.is_dir():
        pytest.skip(f"no recordings at {folder}; set AFKB_DATA to a folder that has them")
    return folder
