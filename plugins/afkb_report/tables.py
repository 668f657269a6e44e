"""The tables of the report, as HTML text."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from html import escape
from urllib.parse import quote

from afkb.drawing.words import affords, best, role
from afkb.flow import Entity, NodeKind, Room, TopologicalMap

_KINDS = {
    NodeKind.OBSERVED: "seen",
    NodeKind.DUAL: "predicted (dual)",
    NodeKind.CO_OCCURRENCE: "predicted (co-occurrence)",
}


def table(
    columns: Sequence[str],
    rows: Sequence[Sequence[str]],
    kind: str = "",
    ids: Sequence[str] | None = None,
) -> str:
    """An HTML table of ready-made cells (HTML text), or a dash where there are no rows.

    `ids`: of the nodes that the rows are about.
    """
    starts = [f'<tr data-id="{escape(id_)}">' for id_ in ids or ()] or ["<tr>"] * len(rows)
    cells = ("".join(f"<td>{cell}</td>" for cell in row) for row in rows)
    body = "\n".join(f"{start}{row}</tr>" for start, row in zip(starts, cells, strict=True))
    if not body:
        return '<p class="none">none</p>'
    head = "".join(f'<th scope="col">{escape(column)}</th>' for column in columns)
    return (
        f'<div class="scroll"><table class="{kind}"><thead><tr>{head}</tr></thead>\n'
        f"<tbody>{body}</tbody></table></div>"
    )


def counts(m: TopologicalMap) -> str:
    """How many there are of each kind."""
    kinds = [entity.kind for entity in m.entities]
    counted = {
        "robot places (V_r)": len(m.places),
        "things seen (V_ao)": kinds.count(NodeKind.OBSERVED),
        "predicted by duality (V_ap)": kinds.count(NodeKind.DUAL),
        "predicted by co-occurrence (V_ac)": kinds.count(NodeKind.CO_OCCURRENCE),
        "dynamic things": sum(e.movability == "Dynamic" for e in m.entities),
        "bounds": len(m.bounds),
        "doorways": len(m.doorways),
        "rooms": len(m.rooms),
        "edges": len(m.edges),
        "loop closures": len(m.closures),
    } | {name.replace("_", " "): number for name, number in sorted(m.counts.items())}
    return table(["what", "count"], [(escape(k), str(v)) for k, v in counted.items()], "numbers")


def rooms(m: TopologicalMap) -> str:
    """Rooms with their area and posterior."""
    by = sorted({name for room in m.rooms for name in room.other_beliefs})
    rows = [
        (
            escape(room.id),
            f"{room.area:.1f}",
            _bars(room.belief) + _second(room),
            *(_bars(room.other_beliefs.get(name, {}), 2) for name in by),
            "yes" if room.visited else "no",
        )
        for room in m.rooms
    ]
    return table(["room", "area (m²)", "what for", *map(escape, by), "visited"], rows)


def _second(room: Room) -> str:
    """What an open plan is for besides."""
    if room.second_purpose is None:
        return ""
    name, p = room.second_purpose
    return f"also for another purpose {p:.2f}: <b>{escape(name)}</b>"


def _bars(belief: Mapping[str, float], count: int = 4) -> str:
    return "".join(
        f'<div class="bar"><span style="width:{100 * p:.1f}%"></span>'
        f"<b>{escape(name)}</b> {p:.2f}</div>"
        for name, p in best(belief, count)
    )


def things(m: TopologicalMap) -> str:
    """Everything seen or predicted, with where it is and what it may be; an id shows its node."""
    columns = ["id", "how", "affords", "may be", "exists", "x", "y", "height", "on", "room"]
    return table(columns, [_row(e) for e in m.entities], "things", [e.id for e in m.entities])


def _row(entity: Entity) -> tuple[str, ...]:
    x, y, z = entity.position_xyz
    mark = f'<i class="mark {role(entity)} {_mark(entity)}"></i>'
    moves = " dynamic" if entity.movability == "Dynamic" else ""
    return (
        f'{mark}<a href="#{quote(entity.id)}">{escape(entity.id)}</a>',
        escape(_KINDS[entity.kind] + moves),
        escape(", ".join(affords(entity)[:3])),
        escape(", ".join(f"{name} {p:.2f}" for name, p in best(entity.category_belief, 2))),
        f"{entity.existence:.2f}",
        f"{x:.2f}",
        f"{y:.2f}",
        f"{z:.2f}",
        escape(entity.supported_by or ""),
        escape(entity.room or ""),
    )


def _mark(entity: Entity) -> str:
    seen = "seen" if entity.kind is NodeKind.OBSERVED else "predicted"
    return f"{seen} dynamic" if entity.movability == "Dynamic" else seen


def closures(m: TopologicalMap) -> str:
    """Predictions that came true: the paper's loop closures."""
    rows = [
        (
            escape(c.entity),
            escape(_KINDS[c.predicted_as]),
            f"{c.predicted_probability:.2f}",
            f"{c.displacement_m:.2f}",
            escape(c.place),
        )
        for c in m.closures
    ]
    return table(["thing", "was", "with p", "off by (m)", "seen from"], rows)


def notes(m: TopologicalMap) -> str:
    """What the run wants a reader to know."""
    if not m.notes:
        return ""
    items = "".join(f"<li>{escape(note)}</li>" for note in m.notes)
    return f'<section><h2>Notes</h2><ul class="notes">{items}</ul></section>'


def timings(run: Mapping[str, object]) -> str:
    """A row per stage, whose seconds the page reads from run.json: they differ from run to run."""
    seconds = run.get("seconds")
    stages = list(seconds) if isinstance(seconds, Mapping) else []
    rows = [(escape(str(s)), f'<span data-seconds="{escape(str(s))}">–</span>') for s in stages]
    return table(["stage", "seconds"], rows, "numbers timings")
