"""`afkb why`: chains that lead, by the ontology's statements, to what the map states."""

import json
import math
from dataclasses import replace

import pytest
from typer.testing import CliRunner

from afkb.cli.app import build_cli
from afkb.errors import MapError
from afkb.explaining import explain
from afkb.explaining.reading import counts_by_room, entities_of
from afkb.explaining.shape import explanation_json
from afkb.explaining.telling import statements
from afkb.inference import network_of
from afkb.inference.existence import EMPTY_LIKELIHOOD_RATIO
from afkb.inference.recognition import standing_together
from afkb.inference.update_rules import against
from afkb.knowledge import AfNet
from afkb.plugins.host import PluginHost
from afkb.store.made_with import changed_since, knowledge_of
from explained_samples import explained_map
from ontology_samples import Copy

OWN = "extension: own\nsource: seen here\nafbits:\n  - Bookshelf > HangAbility @ HangingPose = {}\n"
ROUNDED = 1e-7
"""The map states probabilities to 1e-9, those that the network takes in among them."""


@pytest.fixture(scope="module")
def kb():
    return AfNet.load()


@pytest.fixture(scope="module")
def stored(kb, tmp_path_factory):
    return explained_map(tmp_path_factory.mktemp("why") / "map", kb)


def why(*arguments):
    return CliRunner().invoke(build_cli(PluginHost()), ["why", *map(str, arguments)])


@pytest.mark.parametrize("id_", ["n1", "n2", "n3", "room1"])
def test_a_chain_leads_to_what_the_map_states(stored, kb, id_) -> None:
    found = explain(stored, id_, kb)
    assert found.chain is not None and found.chain.rows
    assert found.chain.off_by < ROUNDED
    assert math.isclose(sum(found.chain.posterior.values()), 1.0)
    assert found.notes == ()


def test_a_life_leads_to_the_existence_that_the_map_states(stored, kb) -> None:
    life = explain(stored, "n1", kb).life
    assert life.recomputed == pytest.approx(life.stored, abs=ROUNDED)
    told = {w.what: w.posterior["it is there"] for w in life.what_if}
    assert told["without step 2: in clear view and not detected"] > life.stored
    assert told["without step 3: seen"] < life.stored
    through = told["if one more view found it seen through"]
    assert through == pytest.approx(against(life.stored, EMPTY_LIKELIHOOD_RATIO))


def test_a_thing_is_told_by_its_room_and_by_what_it_stands_on(stored, kb) -> None:
    chain = explain(stored, "n2", kb).chain
    rows = {r.name: r for r in chain.rows}
    assert rows["Room"].observed.startswith("room1, by what else is in it")
    assert rows["Neighbours"].observed.startswith("on n1 (")
    assert all(rows["Room"].sources(state) for state in chain.likeliest())


def test_pixels_and_frames_are_named(stored, kb) -> None:
    (sighting,) = explain(stored, "n1", kb).sightings
    assert (sighting.view, sighting.image_box) == (40, (108, 144, 124, 156))
    assert (sighting.n_pixels, sighting.detectors) == (1280, ("surfaces",))


def test_a_row_is_the_figure_that_its_statement_gives(stored, kb) -> None:
    chain = explain(stored, "n2", kb).chain
    row = next(r for r in chain.rows if r.name == "ContainAbility")
    (source,) = row.sources("Mug")
    assert source.name.startswith("Mug.") and source.place.endswith(tuple("0123456789"))
    strength, p = float(source.says.rsplit(" ", 1)[1]), 0.9
    given = p * strength + (1 - p) * (1 - strength)
    assert row.likelihood[chain.states.index("Mug")] == pytest.approx(given)


def test_a_changed_statement_changes_its_cell_and_nothing_else(stored, kb, tmp_path) -> None:
    chain = explain(stored, "n2", kb).chain
    (source,) = next(r for r in chain.rows if r.name == "ContainAbility").sources("Mug")
    changed = Copy().set(source.name, "strength", 0.4).load(tmp_path)
    before, after = (explain(stored, "n2", k).chain for k in (kb, changed))
    cells = {
        (row.name, state)
        for row, other in zip(before.rows, after.rows, strict=True)
        for state, a, b in zip(before.states, row.likelihood, other.likelihood, strict=True)
        if a != pytest.approx(b, rel=1e-9)
    }
    # What something else affords is the mean of all categories.
    assert cells == {("ContainAbility", "Mug"), ("ContainAbility", "SomethingElse")}


def test_every_likely_state_has_a_statement_for_every_row_of_its_own(stored, kb) -> None:
    for id_ in ("n1", "n2", "room1"):
        found = explain(stored, id_, kb)
        told = {about for about, _ in statements(found)}
        own = [r.name for r in found.chain.rows if r.name not in ("Room", "Neighbours")]
        for state in found.chain.likeliest():
            assert {f"{state}, before", *(f"{state}, {name}" for name in own)} <= told


def recognised_if(stored, kb, affordances):
    """P(category) of the mug n2, if that were what it affords."""
    network, counts = network_of(kb), counts_by_room(stored)
    entities = list(entities_of(stored).values())
    together = next(standing_together(entities, lambda room: counts[room], network))
    things = [replace(t, affordances=affordances) if t.on == 0 else t for t in together.things]
    at = [e.id for e in together.entities].index("n2")
    shares = network.joint.recognise(things, together.room).shares[at]
    return dict(zip(network.objects.categories, shares, strict=True))


def test_what_would_change_it_most_is_what_the_network_says_then(stored, kb) -> None:
    chain = explain(stored, "n2", kb).chain
    without = next(w for w in chain.what_if if w.what.startswith("without ContainAbility"))
    assert without.posterior == pytest.approx(recognised_if(stored, kb, {}))
    seen = next(w for w in chain.what_if if w.what.endswith("were seen"))
    feature = seen.what.split()[1]
    both = {"ContainAbility": 0.9, feature: 1.0}
    assert seen.posterior == pytest.approx(recognised_if(stored, kb, both))
    missed = next(w for w in chain.what_if if w.what.startswith(f"if {feature} were looked"))
    assert seen.probability + missed.probability == pytest.approx(1.0)


def test_a_room_without_one_of_its_things_is_what_the_counts_then_say(stored, kb) -> None:
    chain, network = explain(stored, "room1", kb).chain, network_of(kb)
    without = next(w for w in chain.what_if if w.what.startswith("without n2"))
    fewer = {"TableHeightSupport": 1, "SmallContainer": 0, "BedSupport": 0}
    assert without.posterior == pytest.approx(network.room_posterior(fewer))


def test_a_prediction_rests_on_its_anchors_and_on_an_axiom_with_its_source(stored, kb) -> None:
    grounds = {g.id: g for g in explain(stored, "n3", kb).grounds}
    assert set(grounds) == {"n2", "LargerSupportNearSeat"}
    assert "0.65" in grounds["LargerSupportNearSeat"].source.says
    assert "co_occurrences.csv, line" in grounds["LargerSupportNearSeat"].source.place


@pytest.mark.parametrize("id_", ["p1", "b1", "d1", "e1", "closure-1", "loop-1", "room2"])
def test_every_kind_of_node_is_explained(stored, kb, id_) -> None:
    told = json.loads(json.dumps(explanation_json(explain(stored, id_, kb)), allow_nan=False))
    assert told["id"] == id_ and told["told"]


def test_an_id_that_is_none_gets_those_that_are_alike(stored, kb) -> None:
    with pytest.raises(MapError, match="did you mean room1 or room2"):
        explain(stored, "rooms1", kb)
    assert explain(stored, "ROOM1", kb).id == "room1"


def test_the_ontology_is_the_one_that_the_map_was_made_with(stored, kb, tmp_path) -> None:
    assert knowledge_of(stored).files == kb.files
    assert changed_since(stored, kb) == []
    extension = tmp_path / "own.yaml"
    extension.write_text(OWN.format(0.5), encoding="utf-8")
    mine = explained_map(tmp_path / "mine", kb.extended([extension]))
    assert knowledge_of(mine).files[1:] == (extension,)
    extension.write_text(OWN.format(0.6), encoding="utf-8")
    assert explain(mine, "n2", knowledge_of(mine)).notes == (
        "own.yaml has changed since the map was made",
    )
    extension.unlink()
    with pytest.raises(MapError, match="--ontology"):
        knowledge_of(mine)


def test_the_command_tells_it_from_pixels_to_posterior(stored) -> None:
    found = why(stored.folder, "n1")
    assert found.exit_code == 0, found.output
    for told in ("108,144 to 124,156", "before any evidence", "so that it is", "what would change"):
        assert told in found.stdout
    as_json = json.loads(why(stored.folder, "n1", "--json").stdout)
    assert as_json["belief"]["recomputed"].keys() >= as_json["belief"]["stored"].keys()
    missing = why(stored.folder, "n11")
    assert missing.exit_code == 1 and "did you mean n1" in missing.stderr
