import pytest
from hypothesis import given
from hypothesis import strategies as st

from afkb.errors import PluginError
from afkb.inference.update_rules import CERTAIN, RULES, against, literal, update_rule

probability = st.floats(0.01, 0.99)


@given(probability, probability, st.sampled_from(sorted(RULES)))
def test_every_rule_stays_a_probability(p, evidence, name):
    assert 0 <= RULES[name](p, evidence) <= 1


@given(probability, st.floats(0.51, 0.99), st.sampled_from(sorted(RULES)))
def test_supporting_evidence_never_lowers(p, evidence, name):
    assert RULES[name](p, evidence) >= min(p, CERTAIN) - 1e-12


def test_log_odds_of_even_evidence_changes_nothing():
    assert RULES["log-odds"](0.7, 0.5) == pytest.approx(0.7)


def test_log_odds_and_noisy_or_differ_in_how_fast_they_grow():
    assert RULES["log-odds"](0.7, 0.7) == pytest.approx(0.49 / (0.49 + 0.09))
    assert RULES["noisy-or"](0.7, 0.7) == pytest.approx(0.91)


def test_the_printed_rule_is_certain_at_once():
    assert literal(0.7, 0.7) == 1.0


@given(probability, st.floats(0.05, 0.95))
def test_evidence_against_lowers(p, ratio):
    assert against(p, ratio) < p


def test_unknown_rule_names_the_known_ones():
    with pytest.raises(PluginError, match="log-odds"):
        update_rule("sum")
