"""One thing is one track: when tracks begin, and when one turns out to be two."""

from __future__ import annotations

from dataclasses import replace

from afkb.flow import OrientedBox
from afkb.inference import network_of
from afkb.knowledge import AfNet
from afkb_mapping.ids import Ids
from afkb_mapping.things.association import Association
from mapping_samples import container, patch, view


def two_as_one():
    """Two mugs side by side that a view from afar takes for one thing."""
    one = container(2.0, 0.0)
    box = OrientedBox((2.0, 0.0, 0.8), (0.2, 0.09, 0.1))
    return replace(one, box=box, footprint_xy=patch(2.0, 0.0, 0.2, 0.09, 0.005))


def test_what_a_nearer_view_shows_to_be_two_things_is_split() -> None:
    association = Association(Ids())
    (both,) = association.match(view(0), [two_as_one()])
    mugs = [container(1.95, 0.0), container(2.06, 0.0)]
    left, right = association.match(view(1), mugs)
    assert (association.births, association.splits) == (2, 1)
    assert both in (left, right) and left is not right
    association.merge_doubles()
    assert len(association.tracks) == 2 and association.merges == 0


def test_a_second_thing_beside_the_first_splits_nothing() -> None:
    association = Association(Ids())
    association.match(view(0), [container(2.0, 0.0)])
    association.match(view(1), [container(2.0, 0.0), container(2.12, 0.0)])
    assert (association.births, association.splits) == (2, 0)


def test_things_that_share_no_kind_are_not_one() -> None:
    network = network_of(AfNet.load())
    pours = {"ContainAbility": 0.99, "PourAbility": 0.95}
    mug = replace(container(2.0, 0.0), affordances=pours)
    tray = container(2.0, 0.0, height=0.02, width=0.25)
    tray = replace(tray, affordances={"ContainAbility": 0.02, "StackAbility": 0.95})
    for association, births in ((Association(Ids(), network), 2), (Association(Ids()), 1)):
        association.match(view(0), [mug])
        association.match(view(1), [mug])
        association.match(view(2), [tray])
        assert association.births == births
