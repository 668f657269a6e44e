"""What detectors of several stages say of one thing becomes one detection, and one node."""

from dataclasses import replace

import pytest

from afkb.inference import network_of
from afkb.knowledge import AfNet
from afkb_mapping.association import Association
from afkb_mapping.frame_report import described
from afkb_mapping.ids import Ids
from afkb_mapping.one_per_thing import one_per_thing
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


def test_a_view_that_does_not_speak_of_a_feature_speaks_against_it() -> None:
    association = Association(Ids())
    mug = container(1, 0)
    body = replace(mug, detector="things", affordances={"DisposeAbility": 0.8})
    for index in range(3):
        association.match(view(index), [body])
    (track,) = association.match(view(3), one_per_thing([body, replace(mug, about=0)]))
    assert track is not None and len(association.tracks) == 1
    assert track.affordances["DisposeAbility"] == pytest.approx(0.8)
    assert track.affordances["ContainAbility"] == pytest.approx((0.9 + 3 * 0.05) / 4)
