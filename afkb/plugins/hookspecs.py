"""The hooks: signatures with a line each, and nothing else."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from afkb.plugins import hookspec

if TYPE_CHECKING:
    import typer

    from afkb.flow import Truth
    from afkb.knowledge import AfNet
    from afkb.plugins.protocols import (
        Detector,
        Exporter,
        MapperFactory,
        Predictor,
        RoomClassifier,
        Source,
        Viewer,
    )


@hookspec(firstresult=True)
def afkb_open_source(uri: str, options: Mapping[str, str], knowledge_base: AfNet) -> Source | None:
    """Open a recording if it is of a kind this plugin knows, else return None."""


@hookspec(firstresult=True)
def afkb_truth(uri: str, knowledge_base: AfNet) -> Truth | None:
    """Return what is so where a recording was made, to judge its map by, or None if unknown."""


@hookspec
def afkb_detectors(knowledge_base: AfNet) -> Iterable[Detector]:
    """Return detectors, ready to use."""


@hookspec
def afkb_predictors(knowledge_base: AfNet) -> Iterable[Predictor]:
    """Return predictors, ready to use."""


@hookspec
def afkb_mappers(knowledge_base: AfNet) -> Iterable[MapperFactory]:
    """Return factories of mappers."""


@hookspec
def afkb_room_classifiers(knowledge_base: AfNet) -> Iterable[RoomClassifier]:
    """Return classifiers of rooms, whose beliefs stand beside the mapper's."""


@hookspec
def afkb_exporters(knowledge_base: AfNet) -> Iterable[Exporter]:
    """Return exporters, ready to use."""


@hookspec
def afkb_viewers(knowledge_base: AfNet) -> Iterable[Viewer]:
    """Return viewers, which show a map while it is made."""


@hookspec
def afkb_ontologies(knowledge_base: AfNet) -> Iterable[Path]:
    """Return paths of files that extend the ontology: YAML, tables or OWL."""


@hookspec
def afkb_commands(cli: typer.Typer, knowledge_base: AfNet) -> None:
    """Add commands to the command line; the knowledge base is read when it is first used."""
