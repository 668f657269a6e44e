"""The compliance kit: what a plugin author runs against a plugin, and every built-in one passes.

Each check raises `AssertionError` with what is wrong and how to mend it:

    >>> from afkb.testing import check_detector, sample_views
    >>> from afkb.plugins.host import PluginHost
    >>> host = PluginHost()
    >>> for detector in host.detectors(["laser-bounds"]):
    ...     check_detector(detector, sample_views(), host.knowledge_base)
"""

from afkb.testing.detectors import check_detections, check_detector
from afkb.testing.exporters import check_exporter
from afkb.testing.extensions import check_commands, check_ontology
from afkb.testing.mappers import check_map, check_mapper_factory
from afkb.testing.predictors import check_predictor
from afkb.testing.room_classifiers import check_room_classifier
from afkb.testing.sample_flow import sample_detections, sample_hypotheses, sample_map
from afkb.testing.sample_views import sample_view, sample_views
from afkb.testing.sources import check_source
from afkb.testing.viewers import check_viewer

__all__ = [
    "check_commands",
    "check_detections",
    "check_detector",
    "check_exporter",
    "check_map",
    "check_mapper_factory",
    "check_ontology",
    "check_predictor",
    "check_room_classifier",
    "check_source",
    "check_viewer",
    "sample_detections",
    "sample_hypotheses",
    "sample_map",
    "sample_view",
    "sample_views",
]
