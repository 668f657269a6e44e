"""Afbits: what is stated by hand, what rules make, and which of them may come in."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

from afkb.csv_rows import Row
from afkb.ontology.notation import write_afbit
from afkb.ontology.rules import PROJECT, Rule, family_of
from afkb.ontology.subjects import Subject

Key = tuple[str, str, str]
"""Category, part (or an empty string), feature."""
VERDICTS = ("right", "wrong", "missing")
"""`missing`: it holds, and no rule said so when the verdict was written; so the row itself does."""
SUPPLIED_STRENGTH = 0.8
"""Strength of an afbit that a review supplied: it holds for most instances."""


@dataclass(slots=True)
class DrawnAfbit:
    """One statement: a category, or a part of it, has an affordance (paper §II.A).

    `stated`: its own row of `afbits.csv`, which takes precedence over what rules say. `rules`:
    those that make it. `evidence`: tokens that speak for it, with their places. `verdict`: the
    row of the review that judged it.
    """

    key: Key
    subject: Subject
    kind: str
    stated: Row | None = None
    rules: list[Rule] = field(default_factory=list)
    evidence: dict[str, str] = field(default_factory=dict)
    verdict: Row | None = None

    @property
    def public_sources(self) -> list[str]:
        """The public tables that speak for it, and the paper where it does."""
        families = {family_of(token) for token in self.evidence} - {PROJECT}
        paper = self.stated is not None and self.stated["status"] == "stated"
        return sorted(families | ({"paper"} if paper else set()))

    @property
    def supplied(self) -> bool:
        """Whether it stands on a review alone: no rule makes it, and no table states it."""
        return not self.rules and self.stated is not None and "verdict" in self.stated.cells

    @property
    def status(self) -> str:
        """Where it stands, in the words of the ontology's statuses."""
        if self.stated is not None:
            return self.stated["status"]
        return "taken from data" if len(self.public_sources) > 1 else "proposed"

    def refusal(self) -> str | None:
        """Why it may not come in, or None: no statement does on one source alone, unread."""
        if self.verdict is not None and self.verdict["verdict"] == "wrong":
            return f"judged wrong in {self.verdict.place}"
        if self.kind == "grasp" or self.verdict is not None or len(self.public_sources) > 1:
            return None
        if "paper" in self.public_sources:
            return None
        return "one source alone, not reviewed"

    def row(self) -> Row:
        """The row of its individual."""
        first = self.stated or self.rules[0].row
        cells = {
            "category": self.key[0],
            "part": self.key[1],
            "feature": self.key[2],
            "pose": self._cell("pose") or "UprightPose",
            "scale": self._cell("scale") or self.subject.row["scale"],
            "strength": str(self._strength()),
            "rules": "|".join(rule.name for rule in self.rules),
            "status": self.status,
            "source": self._source(),
            "reviewed": "yes" if self.verdict is not None else "no",
            "independent_sources": str(len(self.public_sources)),
        }
        cells["label"] = write_afbit(cells)
        return Row(first.table, first.line, {k: v for k, v in cells.items() if v})

    def _strength(self) -> float:
        if self.stated is not None:
            return self.stated.number("strength")
        return max(rule.row.number("strength") for rule in self.rules)

    def _cell(self, column: str) -> str:
        rows = ([self.stated] if self.stated else []) + [rule.row for rule in self.rules]
        return next((row.get(column) for row in rows if row.get(column)), "")

    def _source(self) -> str:
        parts = [self.stated["source"]] if self.stated else []
        parts += [f"rule {rule.name} ({rule.row.place})" for rule in self.rules]
        parts += [f"{token} ({place})" for token, place in sorted(self.evidence.items())]
        if self.verdict is not None:
            parts.append(f"reviewed: {self.verdict.place}")
        return "; ".join(parts)


def draw_afbits(
    subjects: Sequence[Subject],
    kinds: Mapping[str, str],
    rules: Iterable[Rule],
    stated: Iterable[Row] = (),
    verdicts: Iterable[Row] = (),
) -> list[DrawnAfbit]:
    """Every afbit that is stated or that a rule makes, sorted, admitted or not.

    `kinds`: feature to structural, material or grasp. Raises `KnowledgeError`, with the place,
    for a row about a category, feature or verdict that there is not, and for a second one.
    """
    known = {subject.name: subject for subject in subjects}
    rules = list(rules)
    drawn: dict[Key, DrawnAfbit] = {}
    for row in stated:
        key = _key(row, known, kinds)
        if key in drawn:
            raise row.error(f"{'.'.join(filter(None, key))} is stated a second time; keep one")
        drawn[key] = DrawnAfbit(key, known[key[0]], kinds[key[2]], stated=row)
    for rule in rules:
        if rule.row["feature"] not in kinds:
            raise rule.row.error(f"feature {rule.row['feature']} is not in the table of features")
        for subject in subjects:
            _apply(rule, subject, kinds, drawn)
    for row in verdicts:
        if row["verdict"] not in VERDICTS:
            raise row.error(f"verdict {row['verdict']!r} is none of: {', '.join(VERDICTS)}")
        key = _key(row, known, kinds)
        if row["verdict"] == "missing" and key not in drawn:
            drawn[key] = DrawnAfbit(key, known[key[0]], kinds[key[2]], stated=_supplied(row, rules))
        if key in drawn:
            drawn[key].verdict = row
    return [drawn[key] for key in sorted(drawn)]


def _supplied(row: Row, rules: Iterable[Rule]) -> Row:
    """What a review found missing, as a row of its own, in the pose in which rules say the like."""
    reason = f"supplied by the review: {row['reason']}"
    said = {"strength": str(SUPPLIED_STRENGTH), "status": "proposed", "source": reason}
    alike = [rule.row for rule in rules if rule.row["feature"] == row["feature"]]
    closer = [rule for rule in alike if rule.get("part") == row.get("part")]
    usual = next(iter(closer or alike), None)
    if usual is not None:
        said["pose"] = usual.get("pose")
        said["scale"] = usual.get("scale") if closer else ""
    return replace(row, cells=row.cells | said)


def _apply(
    rule: Rule, subject: Subject, kinds: Mapping[str, str], drawn: dict[Key, DrawnAfbit]
) -> None:
    evidence = rule.evidence(subject)
    if evidence is None:
        return
    key = (subject.name, rule.row.get("part"), rule.row["feature"])
    afbit = drawn.setdefault(key, DrawnAfbit(key, subject, kinds[key[2]]))
    afbit.rules.append(rule)
    afbit.evidence |= evidence


def _key(row: Row, known: Mapping[str, Subject], kinds: Mapping[str, str]) -> Key:
    if row["category"] not in known:
        raise row.error(f"category {row['category']} is not in the table of categories")
    if row["feature"] not in kinds:
        raise row.error(f"feature {row['feature']} is not in the table of features")
    return row["category"], row.get("part"), row["feature"]


def whole_afbits(rows: Iterable[Row], parts: Iterable[Row], kinds: Mapping[str, str]) -> list[Row]:
    """The rows of structural and material afbits that are met as the thing's own.

    `parts`: rows of parts, some of which stand for the whole. `kinds`: feature to its kind.
    """
    wholes = {"", *(part["name"] for part in parts if part.get("whole") == "yes")}
    return [r for r in rows if r.get("part") in wholes and kinds[r["feature"]] != "grasp"]


def summary(afbits: Iterable[DrawnAfbit]) -> dict[str, dict[str, int]]:
    """Per kind of feature: how many, on two sources, reviewed, held back and why."""
    counts: dict[str, dict[str, int]] = defaultdict(lambda: defaultdict(int))
    for afbit in afbits:
        of_kind = counts[afbit.kind]
        refusal = afbit.refusal()
        of_kind["held back" if refusal else "admitted"] += 1
        if not refusal:
            of_kind["two sources"] += len(afbit.public_sources) > 1
            of_kind["reviewed"] += afbit.verdict is not None
    return {kind: dict(found) for kind, found in sorted(counts.items())}
