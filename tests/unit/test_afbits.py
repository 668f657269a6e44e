import pytest
from hypothesis import given
from hypothesis import strategies as st

from afkb.csv_rows import Row
from afkb.errors import KnowledgeError
from afkb.ontology.afbits import DrawnAfbit, draw_afbits, summary
from afkb.ontology.notation import read_afbit, write_afbit
from afkb.ontology.rules import Rule
from ontology_tables import row, rule, subject

KINDS = {"ContainAbility": "structural", "BreakAbility": "material", "RingGrasp": "grasp"}
NAMES = st.from_regex(r"[A-Z][A-Za-z0-9]{0,12}", fullmatch=True)


def draw(tokens: str = "", **tables: list[Row]) -> list[DrawnAfbit]:
    rules = [Rule.read(r) for r in tables.get("rules", [rule()])]
    cup = subject(tokens)
    return draw_afbits([cup], KINDS, rules, tables.get("stated", []), tables.get("review", []))


def verdict(word: str, feature: str = "ContainAbility", part: str = "BasinPart") -> Row:
    cells = {"category": "Cup", "feature": feature, "verdict": word, "reason": "it is hollow"}
    return row("review/round-1", 5, **cells | ({"part": part} if part else {}))


def test_one_source_unread_keeps_an_afbit_out() -> None:
    [afbit] = draw()
    assert afbit.refusal() == "one source alone, not reviewed"
    [afbit] = draw("bddl:fillable", rules=[rule(any_of="trait:OpenTop bddl:fillable")])
    assert afbit.refusal() == "one source alone, not reviewed"


def test_two_public_sources_let_it_in() -> None:
    words = "bddl:fillable virtualhome:RECIPIENT"
    [afbit] = draw(words, rules=[rule(any_of=words)])
    assert afbit.refusal() is None
    assert afbit.status == "taken from data"
    assert afbit.row()["independent_sources"] == "2"
    assert "bddl:fillable (bddl.csv, line 7)" in afbit.row()["source"]


def test_a_verdict_lets_it_in_or_keeps_it_out() -> None:
    [right] = draw(review=[verdict("right")])
    assert right.refusal() is None
    assert right.status == "proposed"
    assert right.row()["reviewed"] == "yes"
    [wrong] = draw(review=[verdict("wrong")])
    assert wrong.refusal() == "judged wrong in review/round-1.csv, line 5"


def test_what_a_review_found_missing_stands_by_itself() -> None:
    _, supplied = sorted(draw(review=[verdict("missing", "BreakAbility", "")]), key=_feature)[::-1]
    assert supplied.key == ("Cup", "", "BreakAbility")
    assert supplied.supplied
    assert supplied.refusal() is None
    assert "supplied by the review: it is hollow" in supplied.row()["source"]


def test_what_the_paper_states_comes_in_and_keeps_its_strength() -> None:
    cells = {"category": "Cup", "part": "BasinPart", "feature": "ContainAbility"}
    said = row("afbits", 2, **cells, strength="0.75", status="stated", source="paper §II.D.i")
    [afbit] = draw(stated=[said])
    assert afbit.refusal() is None
    assert (afbit.status, afbit.row()["strength"]) == ("stated", "0.75")
    assert afbit.public_sources == ["paper"]


def test_grasps_come_in_by_rule_and_say_so() -> None:
    [grasp] = draw(rules=[rule("LightCylinderByRing", feature="RingGrasp", part="")])
    assert grasp.refusal() is None
    assert grasp.row()["source"].startswith("rule LightCylinderByRing (rules/structural.csv")


@pytest.mark.parametrize(
    ("tables", "message"),
    [
        ({"rules": [rule(feature="HoverAbility")]}, "line 3: feature HoverAbility is not in"),
        ({"review": [verdict("maybe")]}, "line 5: verdict 'maybe' is none of: right, wrong"),
        ({"review": [verdict("right", "HoverAbility")]}, "feature HoverAbility is not in"),
    ],
)
def test_bad_rows_are_refused_with_their_place(tables: dict[str, list[Row]], message: str) -> None:
    with pytest.raises(KnowledgeError, match=message):
        draw(**tables)


def test_a_summary_counts_what_came_in_and_what_did_not() -> None:
    assert summary(draw()) == {"structural": {"held back": 1}}
    assert summary(draw(review=[verdict("right")]))["structural"]["reviewed"] == 1


@given(
    st.fixed_dictionaries(
        {"category": NAMES, "feature": NAMES, "strength": st.floats(0, 1).map(lambda v: f"{v:g}")},
        optional={"part": NAMES},
    ),
    st.one_of(st.just(()), st.tuples(NAMES), st.tuples(NAMES, NAMES)),
)
def test_the_notation_reads_what_it_writes(cells: dict[str, str], where: tuple[str, ...]) -> None:
    full = cells | dict(zip(("pose", "scale"), where, strict=False))
    assert read_afbit(write_afbit(full)) == full


@pytest.mark.parametrize(
    "text", ["Mug ContainAbility = 0.9", "Mug > ContainAbility", "Mug > ContainAbility = 1.4", ""]
)
def test_what_is_no_afbit_is_refused(text: str) -> None:
    with pytest.raises(KnowledgeError, match=r"is no afbit; write it as in|is not in 0\.\.1"):
        read_afbit(text)


def _feature(afbit: DrawnAfbit) -> str:
    return afbit.key[2]
