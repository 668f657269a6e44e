"""What context is said to do at a threshold, and when a node is said to be there."""

from __future__ import annotations

from bench.inference.context import is_right
from bench.inference.context_scores import scores


def row(right: bool, before: float, after: float, stated: tuple[bool, bool]) -> dict:
    p = {"without": before, "with": after}
    return {"right": right, "p": p, "in_map": dict(zip(p, stated, strict=True))}


ROSE = row(True, 0.4, 0.8, (False, True))
ROSE_WRONGLY = row(False, 0.4, 0.6, (False, True))
FELL_RIGHTLY = row(False, 0.55, 0.3, (True, True))
STAYS = row(True, 0.9, 0.9, (True, True))


def test_what_rose_and_fell_is_counted_and_how_much_of_it_rightly() -> None:
    told = scores([ROSE, ROSE_WRONGLY, FELL_RIGHTLY, STAYS], [{"nodes": [ROSE]}, {"nodes": []}])
    at = told["at"]["0.5"]
    assert (at["rose"], at["rose_rightly"], at["fell"], at["fell_rightly"]) == (2, 1, 1, 1)
    assert at["without"] == {"stated": 2, "right": 1, "precision": 0.5, "recall": 0.5, "found": 0}
    assert at["with"] == {"stated": 3, "right": 2, "precision": 0.667, "recall": 1.0, "found": 1}
    assert told["at"]["0.7"]["with"]["precision"] == 1.0
    assert told["sure"]["with"]["brier"] == 0.125


def test_a_surface_is_right_at_a_tops_height_only_and_over_several_things() -> None:
    def cabinet(x: float) -> dict:
        low, high = [x, 0.0, 0.0], [x + 1, 0.6, 0.9]
        return {"category": "bottom_cabinet", "min": low, "max": high, "top_height": 0.9}

    run = [cabinet(0.0), cabinet(1.0)]
    board = {"x": 1.0, "y": 0.3, "z": 0.9, "yaw": 0.0, "size": (2, 0.6, 0.02)}
    board["affords"] = ["SupportAbility"]
    assert is_right(board, run)
    assert not is_right(board, run[:1])
    assert not is_right({**board, "z": 0.5}, run)
