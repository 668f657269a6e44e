"""One absurd pose is doubted; a new place that frames agree on is believed."""

from dataclasses import replace

import numpy as np
import pytest

from afkb.errors import BadFrame
from afkb_mapping.geometry import T_from_xy_yaw
from afkb_mapping.placing.pose_gate import PoseGate
from mapping_samples import view


def at(x, index):
    return replace(view(index), T_odom_base=T_from_xy_yaw(x, 0.0, 0.0))


def test_a_glitch_is_refused_and_the_way_goes_on():
    gate = PoseGate()
    gate.check(at(0.0, 0))
    with pytest.raises(BadFrame, match=r"1e\+06 m"):
        gate.check(at(1e6, 1))
    gate.check(at(0.5, 2))


def test_a_gap_in_the_recording_is_no_glitch():
    gate = PoseGate()
    gate.check(at(0.0, 0))
    gate.check(at(9.0, 1))
    gate.check(at(60.0, 20))


def test_where_several_frames_agree_the_robot_was_carried():
    gate = PoseGate()
    gate.check(at(0.0, 0))
    for index in (1, 2):
        with pytest.raises(BadFrame):
            gate.check(at(100.0 + index, index))
    gate.check(at(103.0, 3))
    gate.check(at(103.5, 4))


def test_glitches_that_disagree_are_never_believed():
    gate = PoseGate()
    gate.check(at(0.0, 0))
    for index, x in enumerate(np.linspace(1e3, 9e3, 6), start=1):
        with pytest.raises(BadFrame):
            gate.check(at(x, index))
