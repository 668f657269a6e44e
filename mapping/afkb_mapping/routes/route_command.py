"""The command that plans ways on a map, to a place or in search of a thing: `route`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from afkb.cli.output import print_json, print_table, print_text
from afkb.cli.state import state_of

if TYPE_CHECKING:
    from afkb_mapping.routes.planner import Route
    from afkb_mapping.routes.search import Search

WIDEST_M = 5.0


def route(
    ctx: typer.Context,
    map_: Annotated[Path, typer.Argument(metavar="MAP", help="Folder that `afkb map` wrote.")],
    start: Annotated[
        str, typer.Option("--from", metavar="A", help="x,y, a node's id, or a room by id or kind.")
    ],
    goal: Annotated[
        str, typer.Option("--to", metavar="B", help="The same, or a kind of thing: then a search.")
    ],
    robot_radius: Annotated[
        float, typer.Option(min=0.0, max=WIDEST_M, help="Of the robot, seen from above, m.")
    ] = 0.2,
    json_: Annotated[bool, typer.Option("--json", help="Print the route as JSON.")] = False,
) -> None:
    """Plan the shortest way, or the order of places in which to look for a thing.

    Example: afkb route my-map --from Bedroom --to mug
    """
    from afkb_mapping.routes.ends import Kind, end_of
    from afkb_mapping.routes.planner import Planner
    from afkb_mapping.routes.route_map import RouteMap
    from afkb_mapping.routes.search import search

    kb = state_of(ctx).host.knowledge_base
    known = RouteMap.read(map_)
    first, last = end_of(start, known, kb), end_of(goal, known, kb)
    planner = Planner.of(known, robot_radius)
    if isinstance(last, Kind):
        found = search(planner, kb, first, last)
        if json_:
            print_json(search_json(found))
        else:
            _print_search(found, last.category)
        return
    way = planner.route_round(first, last)
    if json_:
        print_json(route_json(way))
    else:
        _print_route(way)


def route_json(way: Route) -> dict[str, object]:
    """A route in the shape of `afkb route --json`: m, map frame."""
    return {
        "length": round(way.length, 3),
        "path": [[round(float(x), 3), round(float(y), 3)] for x, y in way.path],
        "nodes": list(way.nodes),
        "doorways": list(way.doorways),
        "rooms": list(way.rooms),
        "through": list(way.through),
    }


def search_json(found: Search) -> dict[str, object]:
    """A search: its route through all places, these in order, and what it is expected to cost."""
    return {
        **route_json(found.route),
        "places": [
            {
                "nodes": [c.node.id for c in place.found],
                "x": round(float(place.xy[0]), 3),
                "y": round(float(place.xy[1]), 3),
                "room": place.room,
                "probability": round(place.probability, 4),
                "length": round(metres, 3),
                "reason": place.found[0].reason,
            }
            for place, metres in zip(found.places, found.metres, strict=True)
        ],
        "nowhere": round(found.nowhere, 4),
        "expected_length": round(found.order.expected_m, 3),
        "at_least": round(found.order.at_least_m, 3),
        "if_known": round(found.known_m, 3),
        "nearest_first": round(found.nearest_m, 3),
        "most_probable_first": round(found.probable_m, 3),
    }


def _print_route(way: Route) -> None:
    rows = [(f"{x:.2f}", f"{y:.2f}") for x, y in way.path]
    print_table(["x", "y"], rows, title=f"{way.length:.2f} m", numbers=["x", "y"])
    for name, ids in (("nodes", way.nodes), ("doorways", way.doorways), ("rooms", way.rooms)):
        print_text(f"{name}: {', '.join(ids) or 'none'}")
    if way.through:
        print_text(f"leads over places where {', '.join(way.through)} is expected")


def _print_search(found: Search, category: str) -> None:
    columns = ["look at", "in", "p", "m so far", "why"]
    rows = []
    for place, metres in zip(found.places, found.metres, strict=True):
        nodes = [c.node.id for c in place.found]
        more = f" and {len(nodes) - 3} more" if len(nodes) > 3 else ""
        where = ", ".join(nodes[:3]) + more
        rows.append(
            (where, place.room, f"{place.probability:.2f}", f"{metres:.2f}", place.found[0].reason)
        )
    print_table(columns, rows, title=f"search for a {category}", numbers=["p", "m so far"])
    order = found.order
    best = "no order is better" if order.exact else f"no order is below {order.at_least_m:.2f} m"
    print_text(f"expected way until found: {order.expected_m:.2f} m ({best})")
    print_text(f"if one knew where it is: {found.known_m:.2f} m")
    print_text(f"the nearest next: {found.nearest_m:.2f} m")
    print_text(f"the likeliest next: {found.probable_m:.2f} m")
    print_text(f"at none of them: {found.nowhere:.2f}")
