"""What a map is built from: every view of every visit that shows something anew."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from afkb.flow import View
from afkb_mapping.memory.familiar import FamiliarViewpoints
from afkb_mapping.memory.packing import packed
from afkb_mapping.memory.passed import Passed, RememberedViews
from afkb_mapping.memory.recollection import Recollection
from afkb_mapping.memory.remembered import RememberedView
from afkb_mapping.memory.visit import Visit

Array = NDArray[np.float64]


class Memory:
    """The views of all visits so far; a map is what a mapper makes of them, in this order.

    Its size is bounded by the place: views of viewpoints that are known well are not kept (see
    `FamiliarViewpoints`), but for where they were taken.
    """

    def __init__(self, visits: Iterable[Visit] = (), passed: Iterable[Passed] = ()) -> None:
        self._visits = list(visits)
        self._passed = list(passed)
        self._familiar = FamiliarViewpoints()

    @property
    def visits(self) -> tuple[Visit, ...]:
        """The visits, the present one last."""
        return tuple(self._visits)

    @property
    def passed(self) -> tuple[Passed, ...]:
        """What every view left behind, in the order they came in."""
        return tuple(self._passed)

    @property
    def views(self) -> RememberedViews:
        """The remembered views, each where it was placed as it came in."""
        return RememberedViews(self._passed, settled=False)

    @property
    def settled_views(self) -> RememberedViews:
        """The remembered views, each where it turned out to have been taken."""
        return RememberedViews(self._passed, settled=True)

    @property
    def trajectory(self) -> Array:
        """(N, 17): stamp (s), then T_map_base row by row, of every view, remembered or not."""
        rows = [[p.stamp, *p.T_settled.ravel()] for p in self._passed]
        return np.array(rows).reshape(-1, 17)

    def begin(self, visit: Visit) -> None:
        """Begin a visit; viewpoints that earlier ones know well are looked at anew."""
        self._visits.append(visit)
        self._familiar = FamiliarViewpoints()

    def is_worth_keeping(self, view: View) -> bool:
        """Whether a placed view, which is to be passed or kept next, shows something anew."""
        return self._familiar.is_worth_keeping(view)

    def pass_by(self, view: View) -> None:
        """Note where a placed view was taken, and no more."""
        self._append(view, b"")

    def keep(self, remembered: RememberedView) -> None:
        """Keep a view of the present visit."""
        self._append(remembered.view, packed(remembered))

    def _append(self, view: View, content: bytes) -> None:
        assert view.T_map_base is not None
        visit = len(self._visits) - 1
        self._passed.append(Passed(visit, view.stamp, view.T_map_base, view.T_map_base, content))

    def settle(self, poses: Sequence[Array]) -> None:
        """Say where the remembered views turned out to have been taken.

        `poses`: T_map_base (4, 4) of each of `views`. What is not remembered moves with the
        remembered view before it.
        """
        if len(poses) != len(self.views):
            raise ValueError(f"{len(poses)} poses for {len(self.views)} remembered views")
        settled, T_correction = iter(poses), np.eye(4)
        for i, passed in enumerate(self._passed):
            T = next(settled) if passed.content else T_correction @ passed.T_placed
            self._passed[i] = replace(passed, T_settled=T)
            T_correction = self._passed[i].T_correction

    def continued(self) -> Memory:
        """The same as a next visit finds it: placed where views turned out to have been taken."""
        return Memory(self._visits, (replace(p, T_placed=p.T_settled) for p in self._passed))

    def before_last_visit(self) -> Memory:
        """What was remembered when the last visit began."""
        last = len(self._visits) - 1
        return Memory(self._visits[:last], (p for p in self._passed if p.visit < last))

    def without_visits(self, first: int) -> Memory:
        """What was remembered at the visits after the first so many."""
        return Memory(self._visits, (p for p in self._passed if p.visit >= first))

    def of_last_visit(self) -> Recollection:
        """What was remembered since."""
        last = len(self._visits) - 1
        return Recollection(RememberedViews((p for p in self._passed if p.visit == last), False))
