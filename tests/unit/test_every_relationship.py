"""Each dual and co-occurrence of the ontology, deleted and halved: what it should change, changes.

Two copies of the ontology do for all of them: in the one every other statement is deleted and the
rest halved, in the other it is the other way round. Predictors read nothing else.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from afkb.flow import Detection
from afkb.inference import network_of
from afkb.knowledge import COUNTED, AfNet
from afkb_filtrations.co_occurrence import CoOccurrencePredictor
from afkb_filtrations.duals import DualPredictor
from ontology_samples import Copy
from test_filtrations_duals import thing

KB = AfNet()
FAINTEST = 0.01
"""So that weak directions, and halves of them, are predicted."""
STATEMENTS = [d.name for d in KB.duals] + [
    c.name for c in KB.co_occurrences if c.is_rule or c.status != COUNTED
]
RULE = "LargerSupportNearSeat"


def changed(folder: Path, deleted: list[str]) -> AfNet:
    """The ontology without some of its relationships, the others at half their strength."""
    copy = Copy().set("FaintestHypothesis", "value", FAINTEST)
    for name in STATEMENTS:
        if name in deleted:
            copy.delete(name)
        else:
            strength = next(r.strength for r in (*KB.duals, *KB.co_occurrences) if r.name == name)
            copy.set(name, "strength", strength / 2)
    return copy.load(folder)


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> AfNet:
    copy = Copy().set("FaintestHypothesis", "value", FAINTEST)
    return copy.load(tmp_path_factory.mktemp("whole"))


@pytest.fixture(scope="module")
def halves(tmp_path_factory: pytest.TempPathFactory) -> tuple[AfNet, AfNet]:
    """Of every statement one copy that lacks it, and one that has it at half its strength."""
    evens, odds = STATEMENTS[::2], STATEMENTS[1::2]
    return (
        changed(tmp_path_factory.mktemp("evens"), [n for n in evens if n != RULE]),
        changed(tmp_path_factory.mktemp("odds"), [n for n in odds if n != RULE] + [RULE]),
    )


def stated(kb: AfNet) -> set[str]:
    return {r.name for r in (*kb.duals, *kb.co_occurrences)}


def predicted(kb: AfNet, seen: Detection) -> dict[str, float]:
    """Probability by axiom of what a thing predicts by duality."""
    found = DualPredictor(kb).predict([seen])
    return {h.axiom.rsplit("#", 1)[-1]: h.probability for h in found}


@pytest.mark.parametrize("name", [d.name for d in KB.duals])
def test_a_dual_is_all_that_its_hypothesis_rests_on(
    whole: AfNet, halves: tuple[AfNet, AfNet], name: str
) -> None:
    dual = next(d for d in KB.duals if d.name == name)
    seen = thing(dual.evidence, (2.0, 0.0, 1.0))
    assert predicted(whole, seen)[name] == pytest.approx(dual.strength)
    (with_half,) = [kb for kb in halves if name in stated(kb)]
    (without,) = [kb for kb in halves if name not in stated(kb)]
    assert predicted(with_half, seen)[name] == pytest.approx(dual.strength / 2)
    assert name not in predicted(without, seen)


def test_a_deleted_dual_changes_no_other_hypothesis(
    whole: AfNet, halves: tuple[AfNet, AfNet]
) -> None:
    """Half of what each other statement said is all that is left of it, in both copies."""
    for dual in KB.duals:
        seen = thing(dual.evidence, (2.0, 0.0, 1.0))
        before = predicted(whole, seen)
        for kb in halves:
            kept = {n: p / 2 for n, p in before.items() if n in stated(kb)}
            assert predicted(kb, seen) == pytest.approx(kept)


def test_the_rule_of_co_occurrence_is_all_that_its_hypothesis_rests_on(
    whole: AfNet, halves: tuple[AfNet, AfNet]
) -> None:
    chair = thing("SupportAbility", (2.0, 0.0, 0.4), (0.44, 0.44, 0.05))
    (before,) = CoOccurrencePredictor(whole).predict([chair])
    halved, deleted = halves
    (after,) = CoOccurrencePredictor(halved).predict([chair])
    assert after.probability == pytest.approx(before.probability / 2, rel=0.02)
    assert CoOccurrencePredictor(deleted).predict([chair]) == []


def test_a_listed_pair_modulates_its_category_and_no_other(tmp_path: Path) -> None:
    """The stronger of a category's pairs sets the rule's strength for it, and for its kinds."""
    changed = {"ChairSuggestsTable": ("Chair", 0.9), "BookSuggestsTable": ("Book", 0.8)}
    copy = Copy()
    for name, (_, strength) in changed.items():
        copy.set(name, "strength", strength)
    before, after = (network_of(kb).relations for kb in (KB, copy.load(tmp_path)))
    strength_of = dict(changed.values())
    for category in KB.categories:
        was, now = (r.co_occurrence(RULE, {category: 1.0}) for r in (before, after))
        told = next((strength_of[k] for k in KB.kinds_of(category) if k in strength_of), was)
        assert now == pytest.approx(told), category
