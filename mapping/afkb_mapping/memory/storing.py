"""The memory of a map as one file in its `state/`: arrays and JSON, no pickled objects."""

from __future__ import annotations

import io
import json
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from afkb.errors import MapError
from afkb_mapping.memory.memory import Memory
from afkb_mapping.memory.passed import Passed
from afkb_mapping.memory.visit import Visit

MEMORY_FILE = "memory.npz"
"""In the map's `state/`.

- `format`: of this file. `visits`: UTF-8 JSON, see `Visit.as_json`.
- `rows` (N, 34) of every view: visit, stamp (s), T_placed and T_settled row by row.
- `lengths` (N,): bytes in `content` of the remembered view, 0 where it isn't kept.
- `content`: these, one after the other.
"""
FORMAT = 1


def to_bytes(memory: Memory) -> bytes:
    """The content of `MEMORY_FILE`; the same for the same memory."""
    rows = [[p.visit, p.stamp, *p.T_placed.ravel(), *p.T_settled.ravel()] for p in memory.passed]
    visits = json.dumps([v.as_json() for v in memory.visits], ensure_ascii=False)
    file = io.BytesIO()
    np.savez(
        file,
        format=np.array(FORMAT),
        visits=np.frombuffer(visits.encode(), np.uint8),
        rows=np.array(rows, np.float64).reshape(-1, 34),
        lengths=np.array([len(p.content) for p in memory.passed], np.int64),
        content=np.frombuffer(b"".join(p.content for p in memory.passed), np.uint8),
    )
    return file.getvalue()


def memory_of(folder: Path) -> Memory:
    """What a stored map is built from.

    Raises `MapError` where the map has no memory, or one that can't be read.
    """
    path = folder / "state" / MEMORY_FILE
    if not path.is_file():
        raise MapError(
            f"{folder}: can't be continued, it has no state/{MEMORY_FILE} (its mapper keeps no "
            "memory, or an older afkb wrote it); map again with --out"
        )
    try:
        return from_bytes(path.read_bytes())
    except (OSError, ValueError) as error:
        raise MapError(f"{path}: not readable ({error}); map again with --out") from error


def from_bytes(content: bytes) -> Memory:
    """The inverse of `to_bytes`. Raises `ValueError` where the content is none of its."""
    try:
        with np.load(io.BytesIO(content), allow_pickle=False) as stored:
            written = int(stored["format"])
            visits = json.loads(stored["visits"].tobytes())
            rows, lengths = stored["rows"].reshape(-1, 34), stored["lengths"]
            packed = stored["content"].tobytes()
    except (OSError, ValueError, KeyError, EOFError, TypeError, zipfile.BadZipFile) as error:
        raise ValueError("torn, or no memory of a map") from error
    if written != FORMAT:
        raise ValueError(f"format {written}, this afkb reads {FORMAT}")
    return Memory(_visits(visits), _passed(rows, lengths, packed))


def _visits(told: list[dict[str, Any]]) -> list[Visit]:
    try:
        return [Visit.from_json(one) for one in told]
    except (KeyError, TypeError, AttributeError) as error:
        raise ValueError(f"no visits of a map: {error}") from error


def _passed(rows: NDArray[np.float64], lengths: NDArray[np.int64], packed: bytes) -> list[Passed]:
    if len(rows) != len(lengths) or int(lengths.sum()) != len(packed):
        raise ValueError("its parts do not fit together")
    ends = np.cumsum(lengths).tolist()
    return [
        Passed(
            int(row[0]),
            float(row[1]),
            row[2:18].reshape(4, 4),
            row[18:].reshape(4, 4),
            packed[end - length : end],
        )
        for row, end, length in zip(rows, ends, lengths.tolist(), strict=True)
    ]
