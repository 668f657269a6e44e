"""An explanation as the JSON of `afkb why --json`; docs/reference.md lists the shape."""

from __future__ import annotations

from dataclasses import asdict

from afkb.explaining.chain import Chain, WhatIf, as_belief, most_telling
from afkb.explaining.explanation import Explanation, Life
from afkb.explaining.source import Source
from afkb.flow import Change, Sighting

Json = dict[str, object]
KEPT = 8
"""Of a belief so many states are told, the likeliest."""
WHAT_IF_KEPT = 12


def explanation_json(found: Explanation) -> Json:
    """All of an explanation as plain data; m, s, probabilities 0 to 1."""
    return {
        "id": found.id,
        "kind": found.kind,
        "told": found.told,
        "facts": dict(found.facts),
        "views": found.views,
        "sightings": [_sighting(s) for s in found.sightings],
        "existence": _life(found.life) if found.life else None,
        "grounds": [
            {"id": g.id, "how": g.how, "statement": _source(g.source) if g.source else None}
            for g in found.grounds
        ],
        "belief": {"about": found.about, **_chain(found.chain)} if found.chain else None,
        "notes": list(found.notes),
    }


def _sighting(sighting: Sighting) -> Json:
    return {
        "view": sighting.view,
        "stamp": sighting.stamp,
        "detectors": list(sighting.detectors),
        "pixels": sighting.n_pixels,
        "image_box": list(sighting.image_box) if sighting.image_box else None,
        "range": sighting.range_m,
        "affords": dict(sighting.affordances),
    }


def _life(life: Life) -> Json:
    return {
        "stored": life.stored,
        "recomputed": _rounded(life.recomputed),
        "steps": [_change(c) for c in life.changes],
        "what_if": [_what_if(w) for w in most_telling(life.what_if, WHAT_IF_KEPT)],
    }


def _change(change: Change) -> Json:
    return {
        "kind": change.kind.value,
        "weighed": change.evidence,
        "before": change.before,
        "after": change.after,
        "stamp": change.stamp,
        "view": change.view,
        "by": list(change.by),
    }


def _chain(chain: Chain) -> Json:
    likeliest = chain.likeliest(KEPT)
    steps = [as_belief(chain.states, step) for step in chain.steps()]
    rows = [
        {
            "evidence": row.name,
            "observed": row.observed,
            "likelihood": {s: _rounded(p) for s, p in _of(likeliest, chain, row.likelihood)},
            "belief": _kept(after, likeliest),
            "statements": {s: [_source(x) for x in row.sources(s)] for s in likeliest},
        }
        for row, after in zip(chain.rows, steps[1:], strict=True)
    ]
    return {
        "stored": dict(chain.stored),
        "recomputed": {s: _rounded(p) for s, p in steps[-1].items()},
        "prior": _kept(steps[0], likeliest),
        "prior_statements": {s: [_source(x) for x in chain.prior_sources(s)] for s in likeliest},
        "evidence": rows,
        "what_if": [_what_if(w) for w in most_telling(chain.what_if, WHAT_IF_KEPT)],
    }


def _of(states: list[str], chain: Chain, values: object) -> list[tuple[str, float]]:
    found = dict(zip(chain.states, values.tolist(), strict=True))  # type: ignore[attr-defined]
    return [(state, found[state]) for state in states]


def _kept(belief: dict[str, float], states: list[str]) -> dict[str, float | None]:
    return {state: _rounded(belief[state]) for state in states}


def _what_if(what_if: WhatIf) -> Json:
    ranked = sorted(what_if.posterior.items(), key=lambda item: (-item[1], item[0]))
    return {
        "what": what_if.what,
        "probability": _rounded(what_if.probability),
        "moved": _rounded(what_if.moved),
        "flips_to": what_if.flips_to,
        "belief": {name: _rounded(p) for name, p in ranked[:KEPT]},
    }


def _source(source: Source) -> Json:
    return asdict(source)


def _rounded(value: float | None) -> float | None:
    return None if value is None else round(value, 9)
