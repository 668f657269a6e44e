"""A plugin that fails is named: on one view the run goes on, on every view it ends."""

import pytest

from afkb.errors import PluginError, SourceError
from afkb.plugins import hookimpl
from afkb.plugins.host import PluginHost
from afkb_mapping.run import make_map
from afkb_mapping.run_record import Settings


class Fragile:
    """A detector that fails on the given views."""

    name = "fragile"
    affordances = ("SupportAbility",)
    stage = 0

    def __init__(self, fails_on):
        self._fails_on = fails_on

    def detect(self, view, earlier):
        if view.index in self._fails_on:
            raise ZeroDivisionError("an empty cluster")
        return []


class Plugin:
    def __init__(self, fails_on):
        self._fails_on = fails_on

    @hookimpl
    def afkb_detectors(self, knowledge_base):
        return [Fragile(self._fails_on)]


def run_with(fails_on, out):
    host = PluginHost()
    host.register(Plugin(fails_on), name="fragile")
    return make_map(host, Settings(uri="world:two_rooms", out=out, stop=4, detectors=("fragile",)))


def test_a_view_that_a_detector_fails_on_is_skipped_and_counted(tmp_path):
    run = run_with({1}, tmp_path / "map").run
    assert run["frames"]["used"] == 3
    assert run["frames"]["skipped"] == 1
    assert "'fragile' failed with ZeroDivisionError: an empty cluster" in str(run["frames"])


def test_a_detector_that_fails_everywhere_is_an_error_and_nothing_is_written(tmp_path):
    with pytest.raises((PluginError, SourceError), match="fragile"):
        run_with(range(100), tmp_path / "map")
    assert not (tmp_path / "map").exists()
