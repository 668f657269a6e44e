"""`afkb ontology`: a command a file; here they come together, in the order in which help lists."""

from __future__ import annotations

import typer

from afkb.cli.building_command import build
from afkb.cli.checking_command import check
from afkb.cli.counting_command import count
from afkb.cli.gathering_command import gather
from afkb.cli.learning_commands import homes, learn
from afkb.cli.network_command import network
from afkb.cli.reference_command import reference
from afkb.cli.showing_command import show
from afkb.cli.starter_command import new
from afkb.cli.status_command import status

app = typer.Typer(no_args_is_help=True, help="Build, check and show the ontology.")
for command in (show, reference, status, check, new, gather, count, homes, learn, build, network):
    app.command()(command)
