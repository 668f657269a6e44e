"""What all engines are asked: lookups and joins that robots need, in SPARQL that all know."""

from __future__ import annotations

_HEAD = """PREFIX afn: <https://w3id.org/afkb/afnet#>
PREFIX prov: <http://www.w3.org/ns/prov#>
PREFIX rdf: <http://www.w3.org/1999/02/22-rdf-syntax-ns#>
"""

TYPICAL = "typical"
DUAL = "dual join"

QUESTIONS: dict[str, tuple[str, str]] = {
    "containers and their supports": (
        TYPICAL,
        """SELECT ?thing ?support ?height WHERE {
          ?thing afn:affords afn:ContainAbility ; afn:supportedBy ?support .
          ?support afn:z ?height }""",
    ),
    "supports at table height": (
        TYPICAL,
        """SELECT ?support ?z WHERE {
          ?support afn:affords afn:SupportAbility ; afn:z ?z ; afn:existence ?e .
          FILTER (?z > 0.6 && ?z < 0.9 && ?e > 0.5) }""",
    ),
    "what may be a mug": (
        TYPICAL,
        """SELECT ?thing ?p WHERE {
          ?thing afn:categoryBelief ?belief .
          ?belief afn:category afn:Mug ; afn:probability ?p }""",
    ),
    "what is in likely kitchens": (
        TYPICAL,
        """SELECT ?thing ?room WHERE {
          ?room afn:roomBelief ?belief .
          ?belief afn:roomCategory afn:Kitchen ; afn:probability ?p .
          FILTER (?p > 0.5)
          ?thing afn:inRoom ?room ; rdf:type afn:ObservedEntity }""",
    ),
    "things per room": (
        TYPICAL,
        """SELECT ?room (COUNT(?thing) AS ?things) WHERE {
          ?thing afn:inRoom ?room ; rdf:type afn:ObservedEntity } GROUP BY ?room""",
    ),
    "rooms side by side": (
        TYPICAL,
        """SELECT ?a ?b ?width WHERE {
          ?door rdf:type afn:Doorway ; afn:connects ?a ; afn:connects ?b ; afn:width ?width .
          FILTER (?a != ?b) }""",
    ),
    "duals met: evidence seen, its dual seen below": (
        DUAL,
        """SELECT ?thing ?support ?dual WHERE {
          ?dual rdf:type afn:Dual ; afn:evidence ?seen ; afn:predicted ?expected .
          ?thing afn:affords ?seen ; afn:supportedBy ?support .
          ?support afn:affords ?expected }""",
    ),
    "predictions by a dual that came true": (
        DUAL,
        """SELECT ?prediction ?dual ?thing ?anchor WHERE {
          ?dual rdf:type afn:Dual ; afn:evidence ?seen ; afn:predicted ?expected .
          ?prediction prov:wasDerivedFrom ?dual ; afn:confirmedBy ?thing ;
                      afn:predictedFrom ?anchor .
          ?thing afn:affords ?expected . ?anchor afn:affords ?seen }""",
    ),
}


def text(name: str) -> str:
    """The whole query."""
    return _HEAD + QUESTIONS[name][1]
