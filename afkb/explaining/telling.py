"""An explanation in words and tables, from the pixels to the probability."""

from __future__ import annotations

from collections.abc import Iterator

from afkb.explaining.chain import Array, Chain, WhatIf, most_telling
from afkb.explaining.explanation import Explanation, Life
from afkb.explaining.life import WORDS
from afkb.explaining.source import Source
from afkb.flow import Sighting

Table = tuple[str, list[str], list[tuple[str, ...]]]
"""Title, columns, rows."""
SHOWN_WHAT_IF = 6
LEAST_MOVED = 0.005
"""What would move less of a belief than this is not worth a line."""


def tables(found: Explanation) -> Iterator[Table]:
    """The tables that tell an explanation, in the order in which the chain runs."""
    if found.sightings:
        rows = [_sighting(s) for s in found.sightings]
        more = f", the {len(rows)} that show most of it" if len(rows) < found.views else ""
        columns = ["view", "at (s)", "from (m)", "image box", "pixels", "detectors", "told"]
        yield f"seen in {found.views} views{more}", columns, rows
    if found.grounds:
        yield "rests on", ["what", "how"], [(g.id, g.how) for g in found.grounds]
    if found.life is not None and found.life.changes:
        columns = ["step", "at (s)", "view", "what", "weighs", "before", "after"]
        yield f"exists: {found.life.stored:.3f}", columns, list(_steps(found.life))
    if found.chain is not None:
        yield _chain_table(found.about, found.chain)
    yield from _what_if_tables(found)


def statements(found: Explanation) -> list[tuple[str, Source]]:
    """The statements behind the likeliest states' figures: number of the evidence, and each."""
    told = [("rule", g.source) for g in found.grounds if g.source is not None]
    chain = found.chain
    if chain is None:
        return told
    for state in chain.likeliest():
        told += [(f"{state}, before", source) for source in chain.prior_sources(state)]
        for row in chain.rows:
            told += [(f"{state}, {row.name}", source) for source in row.sources(state)]
    return told


def _sighting(sighting: Sighting) -> tuple[str, ...]:
    box = sighting.image_box
    told = sorted(sighting.affordances.items(), key=lambda item: (-item[1], item[0]))
    return (
        str(sighting.view),
        f"{sighting.stamp:.1f}",
        f"{sighting.range_m:.2f}",
        f"{box[0]},{box[1]} to {box[2]},{box[3]}" if box else "",
        str(sighting.n_pixels),
        " and ".join(sighting.detectors),
        ", ".join(f"{name} {p:.2f}" for name, p in told),
    )


def _steps(life: Life) -> Iterator[tuple[str, ...]]:
    for number, change in enumerate(life.changes, start=1):
        by = f" (by {' and '.join(change.by)})" if change.by else ""
        yield (
            str(number),
            f"{change.stamp:.1f}",
            "" if change.view is None else str(change.view),
            WORDS[change.kind] + by,
            f"{change.evidence:.3f}",
            "" if change.before is None else f"{change.before:.3f}",
            f"{change.after:.3f}",
        )


def _chain_table(about: str, chain: Chain) -> Table:
    """A row of likelihoods, P(observed | state), per piece of evidence; prior and posterior."""
    states = chain.likeliest()
    at = [chain.states.index(state) for state in states]
    steps = chain.steps()

    def cells(values: Array) -> tuple[str, ...]:
        return tuple(f"{values[i]:.3g}" for i in at)

    rows = [("before any evidence", "", *cells(steps[0]))]
    rows += [(row.name, row.observed, *cells(row.likelihood)) for row in chain.rows]
    rows.append(("so that it is", "", *cells(steps[-1])))
    stored = tuple(f"{chain.stored[s]:.3g}" if s in chain.stored else "" for s in states)
    rows.append(("the map states", "", *stored))
    return about, ["evidence", "observed", *states], rows


def _what_if_tables(found: Explanation) -> Iterator[Table]:
    asked = (
        ("its existence", found.life.what_if if found.life else ()),
        (found.about, found.chain.what_if if found.chain else ()),
    )
    for about, all_ in asked:
        telling = [w for w in most_telling(all_, SHOWN_WHAT_IF) if w.moved >= LEAST_MOVED]
        if telling:
            columns = ["what", "probable", "moves", "then"]
            yield f"what would change {about} most", columns, [_what_if(w) for w in telling]


def _what_if(what_if: WhatIf) -> tuple[str, ...]:
    name, p = max(sorted(what_if.posterior.items()), key=lambda item: item[1])
    instead = " instead" if what_if.flips_to else ""
    probable = "" if what_if.probability is None else f"{what_if.probability:.2f}"
    return what_if.what, probable, f"{what_if.moved:.2f}", f"{name} {p:.2f}{instead}"
