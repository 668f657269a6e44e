"""Several homes asked as one: which of them has room on a table, and what their rooms are for.

usage: python examples/fleet_query.py MAP MAP ...
"""

from __future__ import annotations

import sys

from afkb.asking import open_maps

ROOM_ON_TABLES = """
SELECT ?map (COUNT(DISTINCT ?table) AS ?tables) (SUM(?area) AS ?square_metres) WHERE {
  GRAPH ?map {
    ?table a afn:ObservedEntity ; afn:affords afn:SupportAbility ; afn:z ?height ;
           afn:sizeX ?x ; afn:sizeY ?y .
    FILTER(0.6 < ?height && ?height < 1.0)
    BIND(?x * ?y AS ?area)
  }
}
GROUP BY ?map
ORDER BY DESC(?square_metres)
"""


def main(*folders: str) -> None:
    """Print, for each map, its table tops and what its rooms are for."""
    fleet = open_maps(*folders)
    for row in fleet.ask(ROOM_ON_TABLES):
        home = fleet.graphs[str(row["map"])]
        rooms = [next(iter(room["belief"])) for room in home.rooms()]
        print(f"{home.folder}: {row['tables']} table tops, {row['square_metres']:.1f} m²")
        print(f"    {', '.join(rooms)}")


if __name__ == "__main__":
    main(*sys.argv[1:])
