"""Why a map believes what it believes of one node, as plain data."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from afkb.explaining.chain import Chain, WhatIf
from afkb.explaining.source import Source
from afkb.flow import Change, Sighting


@dataclass(frozen=True, slots=True)
class Life:
    """How sure a thing's existence is: what the map states, and the steps that lead there.

    `recomputed`: by folding the steps again; None where the map keeps no steps of it.
    """

    stored: float
    recomputed: float | None
    changes: tuple[Change, ...]
    what_if: tuple[WhatIf, ...] = ()


@dataclass(frozen=True, slots=True)
class Ground:
    """Something that a belief rests on: another node or a statement, and what it has to do with it.

    `id`: of the node, or name of the statement; `how`: in words; `source`: of a statement.
    """

    id: str
    how: str
    source: Source | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Explanation:
    """Why a node is in the map, and is held for what it is held for.

    - `kind`: local name of its class; `told`: its headline, in words.
    - `facts`: what was measured of it, name to text.
    - `sightings`: the views that showed most of it; `views`: how many saw or implied it.
    - `grounds`: nodes and statements that it rests on. `about`: what `chain` is about, in words.
    - `notes`: what keeps the chain from being the whole story.
    """

    id: str
    kind: str
    told: str
    facts: Mapping[str, str]
    sightings: tuple[Sighting, ...] = ()
    views: int = 0
    life: Life | None = None
    grounds: tuple[Ground, ...] = ()
    about: str = ""
    chain: Chain | None = None
    notes: tuple[str, ...] = field(default=())
