"""Brings the built-in mapper and the commands that need geometry."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from afkb.plugins import hookimpl

if TYPE_CHECKING:
    import typer

    from afkb.knowledge import AfNet
    from afkb.plugins.protocols import Mapper, MapperFactory


@dataclass(frozen=True, slots=True)
class AffordanceMapperFactory:
    """Makes mappers that follow Algorithm 1 of the paper."""

    knowledge_base: AfNet
    name: str = "affordance"

    def __call__(self, rule: str) -> Mapper:
        """A fresh mapper with the named update rule."""
        from afkb.inference import network_of
        from afkb_mapping.mapper import AffordanceMapper

        return AffordanceMapper(network_of(self.knowledge_base), rule)


@hookimpl
def afkb_mappers(knowledge_base: AfNet) -> Iterable[MapperFactory]:
    """Return the built-in mapper."""
    return [AffordanceMapperFactory(knowledge_base)]


@hookimpl
def afkb_commands(cli: typer.Typer, knowledge_base: AfNet) -> None:
    """Add `map`, `batch`, `demo`, `detect`, `locate`, `route`, `diff` and `export`."""
    from afkb_mapping.batch.batch_command import batch
    from afkb_mapping.commands import demo, map_
    from afkb_mapping.detect_command import detect
    from afkb_mapping.exporting.export_command import export
    from afkb_mapping.localisation.locate_command import locate
    from afkb_mapping.routes.route_command import route
    from afkb_mapping.visits.diff_command import diff

    cli.command(name="map")(map_)
    cli.command()(batch)
    cli.command()(demo)
    cli.command()(detect)
    cli.command()(locate)
    cli.command()(route)
    cli.command()(diff)
    cli.command()(export)
