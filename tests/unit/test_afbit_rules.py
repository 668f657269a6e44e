import pytest

from afkb.errors import KnowledgeError
from afkb.ontology.rules import Rule, family_of
from afkb.ontology.subjects import kinds_of, measures_of, read_subjects
from ontology_tables import category, row, rule, subject


def test_a_rule_holds_where_all_it_needs_holds() -> None:
    found = Rule.read(rule()).evidence(subject())
    assert found == {"trait:OpenTop": "categories/kitchen.csv, line 2"}


@pytest.mark.parametrize(
    ("cells", "holds"),
    [
        ({"needs": "trait:OpenTop width_m<0.1"}, True),
        ({"needs": "trait:OpenTop width_m>0.1"}, False),
        ({"needs": "trait:Lid"}, False),
        ({"needs": "trait:OpenTop", "unless": "mainly:CeramicMaterial"}, False),
        ({"needs": "trait:OpenTop", "unless": "top_m>0.5"}, True),
        ({"any_of": "trait:OpenTop bddl:fillable"}, True),
        ({"any_of": "trait:OpenTop bddl:fillable", "least": "2"}, False),
        ({"any_of": "trait:OpenTop shape:CylinderShape", "least": "2"}, False),
        ({"any_of": "bddl:fillable wordnet:vessel.n.03", "least": "1"}, False),
    ],
)
def test_needs_measures_exceptions_and_families(cells: dict[str, str], holds: bool) -> None:
    assert (Rule.read(rule(**cells)).evidence(subject()) is not None) == holds


def test_two_public_tables_are_two_families_and_this_project_is_one() -> None:
    cup = subject("bddl:fillable virtualhome:RECIPIENT")
    needs_two = Rule.read(rule(any_of="bddl:fillable virtualhome:RECIPIENT", least="2"))
    assert set(needs_two.evidence(cup) or ()) == {"bddl:fillable", "virtualhome:RECIPIENT"}
    assert family_of("trait:OpenTop") == family_of("shape:BoxShape") == "project"


@pytest.mark.parametrize(
    ("cells", "message"),
    [
        ({"needs": "OpenTop"}, r"rules/structural\.csv, line 3: 'OpenTop' is neither"),
        ({"needs": "width_m<small"}, "neither family:word nor a measure"),
        ({"needs": ""}, "a rule needs something"),
    ],
)
def test_a_rule_that_means_nothing_is_refused_with_its_place(
    cells: dict[str, str], message: str
) -> None:
    with pytest.raises(KnowledgeError, match=message):
        Rule.read(rule(**cells))


def test_measures_are_typical_and_sorted() -> None:
    measures = measures_of(category(mass_min_kg="0.1", mass_max_kg="0.4"))
    assert measures["mass_kg"] == pytest.approx(0.2)
    assert measures["shortest_m"] <= measures["middle_m"] <= measures["longest_m"]
    with pytest.raises(KnowledgeError, match=r"length from 0\.3 to 0\.14: expected 0 < min"):
        measures_of(category(length_min_m="0.3"))


def test_kinds_run_up_and_stop_where_they_close() -> None:
    assert kinds_of("Mug", {"Mug": "Cup", "Cup": "Tableware"}) == ["Mug", "Cup", "Tableware"]
    assert kinds_of("A", {"A": "B", "B": "A"}) == ["A", "B"]


def test_evidence_about_a_category_that_is_not_there_is_refused() -> None:
    said = row("bddl", 9, category="Goblet", source="bddl", property="fillable", found_in="x.csv")
    with pytest.raises(KnowledgeError, match=r"bddl\.csv, line 9: category Goblet"):
        read_subjects([category()], [], [said])
