"""What others make of the same rows: a naive Bayes and a random forest on categories."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray
from sklearn.ensemble import RandomForestClassifier
from sklearn.naive_bayes import BernoulliNB

from bench.inference.tables import RoomRow, Table

TREES, LEAF, SEED = 300, 2, 0


def peer_posteriors(
    table: Table, train: Table, held_out: Sequence[int], rooms: Sequence[str]
) -> Mapping[str, NDArray[np.float64]]:
    """(N, R) posteriors of the held-out rows by peer."""
    columns = {c: i for i, c in enumerate(sorted({c for row in train.rows for c in row.things}))}
    x, y = _numbers(train.rows, columns), [row.room for row in train.rows]
    asked = _numbers([table.rows[i] for i in held_out], columns)
    peers = {
        "bayes": BernoulliNB(alpha=0.3).fit(x > 0, y).predict_proba(asked > 0),
        "forest": RandomForestClassifier(TREES, min_samples_leaf=LEAF, random_state=SEED)
        .fit(x, y)
        .predict_proba(asked),
    }
    known = sorted(set(y))
    at = [known.index(room) if room in known else -1 for room in rooms]
    return {
        name: np.column_stack([p[:, i] if i >= 0 else np.zeros(len(p)) for i in at])
        for name, p in peers.items()
    }


def _numbers(rows: Sequence[RoomRow], columns: Mapping[str, int]) -> NDArray[np.float64]:
    x = np.zeros((len(rows), len(columns)))
    for i, row in enumerate(rows):
        for category, number in row.things.items():
            if category in columns:
                x[i, columns[category]] = number
    return x
