"""What detectors of several stages say of one thing becomes one detection, and one node."""

from dataclasses import replace

import pytest

from afkb.inference import network_of
from afkb.knowledge import AfNet
from afkb_mapping.frame_report import described
from afkb_mapping.ids import Ids
from afkb_mapping.one_per_thing import one_per_thing
from afkb_mapping.things.association import Association
from mapping_samples import container, support, view


def about(index, **affordances):
    return replace(container(1, 0), detector="closer", affordances=affordances, about=index)


def test_what_is_about_one_thing_is_joined_and_keeps_its_place() -> None:
    mug = container(1, 0)
    joined = one_per_thing(
        [support(3, 0), mug, about(1, PourAbility=0.7), about(2, HangAbility=0.6)]
    )
    assert len(joined) == 2
    assert joined[1].affordances == {"ContainAbility": 0.9, "PourAbility": 0.7, "HangAbility": 0.6}
    assert joined[1].box == mug.box
    assert joined[1].detectors == ("containers", "closer")


def test_the_last_word_on_a_feature_counts() -> None:
    (joined,) = one_per_thing([container(1, 0), about(0, ContainAbility=0.2)])
    assert joined.affordances["ContainAbility"] == 0.2


def test_what_nothing_is_about_stays_as_it_is() -> None:
    table = support(3, 0)
    assert one_per_thing([table])[0] is table


@pytest.mark.parametrize("index", [1, 2, -1])
def test_nothing_is_about_itself_or_what_comes_later(index) -> None:
    with pytest.raises(ValueError, match="earlier"):
        one_per_thing([container(1, 0), about(index, PourAbility=0.7), container(2, 0)])


def test_a_surface_stays_one_whatever_else_it_affords() -> None:
    sofa = replace(support(1, 0, z=0.44), detector="surfaces")
    seat = replace(sofa, affordances={"SitAbility": 0.99}, about=0)
    association = Association(Ids())
    (track,) = association.match(view(), one_per_thing([sofa, seat]))
    assert track is not None and track.is_surface
    assert set(track.affordances) == {"SupportAbility", "SitAbility"}


def test_one_frame_tells_what_stays_and_what_gets_moved() -> None:
    network = network_of(AfNet.load())
    bed = described(support(2, 0, z=0.5, width=2.0, depth=1.6), network)
    mug = described(container(1, 0), network)
    assert (bed["movability"], mug["movability"]) == ("Static", "Dynamic")
    assert (bed["scale"], mug["scale"]) == ("Large", "Small")


@pytest.mark.parametrize(("range_m", "counts"), [(1.0, True), (4.0, False)])
def test_only_a_view_from_as_near_speaks_against_by_not_speaking(range_m, counts) -> None:
    association = Association(Ids())
    mug = container(1, 0)
    body = replace(mug, detector="things", affordances={"DisposeAbility": 0.8})
    association.match(view(0), one_per_thing([body, replace(mug, about=0)]))
    (track,) = association.match(view(1), [replace(body, range_m=range_m)])
    assert track is not None and len(association.tracks) == 1
    assert track.affordances["DisposeAbility"] == pytest.approx(0.8)
    expected = (0.9 + 0.05) / 2 if counts else 0.9
    assert track.affordances["ContainAbility"] == pytest.approx(expected)
