"""Whatever the host finds, built in or a stranger's, passes the compliance kit."""

from __future__ import annotations

from pathlib import Path

import pytest

from afkb import testing
from afkb.plugins.host import PluginHost
from afkb.plugins.protocols import Detector, Exporter, MapperFactory, Predictor, RoomClassifier

HOST = PluginHost()
HOOK, HANDED = HOST.manager.hook, {"knowledge_base": HOST.knowledge_base}
MAPPERS = [factory for group in HOOK.afkb_mappers(**HANDED) for factory in group]
COMMANDS = [p.name for p in HOST.plugins() if "afkb_commands" in p.hooks]
ONTOLOGIES = [Path(path) for group in HOOK.afkb_ontologies(**HANDED) for path in group]
RECORDINGS = ("redkitchen", "homes/merom/bag", "lasers/intel.log")


def name_of(plugin: object) -> str:
    return str(getattr(plugin, "name", plugin))


DETECTORS = [*HOST.detectors(), *HOST.detectors(["open3d-patches"])]


@pytest.mark.parametrize("detector", DETECTORS, ids=name_of)
def test_detector(detector: Detector) -> None:
    earlier = [d for d in HOST.detectors() if d.stage < detector.stage]
    testing.check_detector(detector, testing.sample_views(), HOST.knowledge_base, earlier)


@pytest.mark.parametrize("predictor", HOST.predictors(), ids=name_of)
def test_predictor(predictor: Predictor) -> None:
    testing.check_predictor(predictor, testing.sample_detections(), HOST.knowledge_base)


@pytest.mark.parametrize("factory", MAPPERS, ids=name_of)
def test_mapper_factory(factory: MapperFactory) -> None:
    testing.check_mapper_factory(factory, HOST.knowledge_base)


@pytest.mark.parametrize("classifier", HOST.room_classifiers(), ids=name_of)
def test_room_classifier(classifier: RoomClassifier) -> None:
    testing.check_room_classifier(classifier, testing.sample_map(), HOST.knowledge_base)


@pytest.mark.parametrize("exporter", HOST.exporters(), ids=name_of)
def test_exporter(exporter: Exporter, tmp_path: Path) -> None:
    testing.check_exporter(exporter, tmp_path)


def test_ontologies() -> None:
    for path in ONTOLOGIES:
        testing.check_ontology(path, HOST.knowledge_base)


@pytest.mark.parametrize("plugin", COMMANDS)
def test_commands(plugin: str) -> None:
    testing.check_commands(HOST.manager.get_plugin(plugin), HOST.knowledge_base)


@pytest.mark.parametrize("name", RECORDINGS)
def test_source_of_a_recording(name: str, data_dir: Path) -> None:
    if not (data_dir / name).exists():
        pytest.skip(f"no {name} in {data_dir}")
    testing.check_source(HOST.open_source(str(data_dir / name)), at_most=4)


def test_source_of_the_bundled_world() -> None:
    testing.check_source(HOST.open_source("world:paper_home"), at_most=3)


def test_detectors_find_the_sample_table() -> None:
    """The sample room is no empty formality: together the detectors see what stands in it."""
    seen = []
    for detector in HOST.detectors():
        seen += detector.detect(testing.sample_view(), tuple(seen))
    tops = [d.position_xyz[2] for d in seen if d.affords("SupportAbility")]
    assert min(abs(z - 0.73) for z in tops) < 0.02
    assert any(d.affords("ContainAbility") for d in seen)
