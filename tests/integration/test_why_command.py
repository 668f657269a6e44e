"""`afkb why` on the bundled home's map: every chain leads to what the map states."""

import pytest

from afkb.explaining import explain
from afkb.explaining.naming import KINDS
from afkb.store import load
from afkb.store.made_with import knowledge_of
from afkb.store.vocabulary import local_name

pytestmark = pytest.mark.xdist_group("integration")
ROUNDED = 1e-7
"""The map states probabilities to 1e-9, those that the network takes in among them."""


@pytest.fixture(scope="module")
def explained(demo_folder):
    stored = load(demo_folder / "demo-map")
    kb = knowledge_of(stored)
    ids = [local_name(n.value) for kind in KINDS for n in stored.instances(kind)]
    return [explain(stored, id_, kb) for id_ in ids]


def test_the_posterior_of_every_node_is_the_one_that_the_map_states(explained) -> None:
    chains = {e.id: e.chain.off_by for e in explained if e.chain is not None}
    kinds = {e.kind for e in explained if e.chain is not None}
    assert len(chains) > 30 and {"ObservedEntity", "Room"} <= kinds
    assert {id_: off for id_, off in chains.items() if off > ROUNDED} == {}


def test_the_existence_of_every_node_is_the_one_that_its_steps_lead_to(explained) -> None:
    lives = {e.id: e.life for e in explained if e.life is not None and e.life.changes}
    assert len(lives) > 30
    off = {i: abs(life.recomputed - life.stored) for i, life in lives.items()}
    assert {id_: by for id_, by in off.items() if by > ROUNDED} == {}


def test_every_thing_names_its_pixels(explained) -> None:
    things = [e for e in explained if e.kind == "ObservedEntity"]
    assert all(e.sightings and all(s.n_pixels > 0 for s in e.sightings) for e in things)
