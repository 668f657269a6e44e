"""Where could a robot put down a tray? Lists supports of a map with room to spare, best first.

usage: python examples/free_supports.py MAP
"""

from __future__ import annotations

import sys

from afkb.knowledge import AfNet
from afkb.store import load, query

QUESTION = """
SELECT ?support ?height ?area (COUNT(?thing) AS ?things) WHERE {
  ?support a afn:ObservedEntity ; afn:affords afn:SupportAbility ;
           afn:z ?height ; afn:sizeX ?x ; afn:sizeY ?y ; afn:existence ?p .
  OPTIONAL { ?thing afn:supportedBy ?support }
  BIND(?x * ?y AS ?area)
  FILTER(?height > 0.3 && ?height < 1.2 && ?area > 0.2 && ?p > 0.8)
}
GROUP BY ?support ?height ?area
ORDER BY ?things DESC(?area)
"""


def main(folder: str) -> None:
    """Print one line for each support: name, height, area, how many things stand on it."""
    answer = query([load(folder)], QUESTION, AfNet().files)
    for support, height, area, things in answer.cells():
        print(f"{support}: {float(height):.2f} m high, {float(area):.1f} m², {things} things on it")


if __name__ == "__main__":
    main(sys.argv[1])
