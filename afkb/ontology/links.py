"""What categories are called elsewhere: WordNet's synsets and Wikidata's items; units of numbers.

The facts are gathered from a public table into `links.csv`; the alignment files are built from it
and from `units.csv`.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path

from rdflib import Graph, URIRef

from afkb.csv_rows import Row, csv_text, read_rows
from afkb.errors import KnowledgeError
from afkb.ontology.header import CREATED, LICENCE, MODIFIED
from afkb.ontology.names import AFN, ONTOLOGY_IRI, VERSION

HEADER = ("category", "wordnet_ili", "oewn", "wikidata", "status", "source")
PUBLIC_TABLE = "object_oewn_ili_wikidata.csv"
_ALIGNMENTS = f"{ONTOLOGY_IRI}/alignments"
_PREFIXES = {
    "afn": AFN,
    "dcterms": "http://purl.org/dc/terms/",
    "ili": "http://globalwordnet.org/ili/",
    "oewn": "https://en-word.net/id/oewn-",
    "owl": "http://www.w3.org/2002/07/owl#",
    "rdfs": "http://www.w3.org/2000/01/rdf-schema#",
    "skos": "http://www.w3.org/2004/02/skos/core#",
    "unit": "http://qudt.org/vocab/unit/",
    "wd": "http://www.wikidata.org/entity/",
    "xsd": "http://www.w3.org/2001/XMLSchema#",
}
_NOTES = {
    "wordnet": (
        "WordNet",
        "Categories and the synsets that mean nearly the same: of the Collaborative Interlingual "
        "Index (ILI) and of the Open English WordNet.",
        "Target: Open English WordNet, CC BY 4.0, derived from Princeton WordNet (WordNet "
        "licence). Only its identifiers are named. Checked: each synset against the hypernyms of "
        "the BDDL 3.6.0 synset of the same thing, in the table that links.csv names; synsets that "
        "failed are left out. The IRIs' form is that of the two projects' RDF.",
    ),
    "wikidata": (
        "Wikidata",
        "Categories and the Wikidata items that mean nearly the same.",
        "Target: Wikidata, CC0. Only its identifiers are named. Checked: they are the items that "
        "the Open English WordNet gives for the synset in wordnet.ttl; the items themselves were "
        "not read.",
    ),
    "qudt": (
        "QUDT",
        "The unit of every number, as a unit of QUDT.",
        "Target: QUDT 2.1 units, CC BY 4.0. Only its identifiers are named. Checked: unit:M, M2, "
        "RAD, KiloGM and UNITLESS in its units file; unit:SEC only by its use in public code. "
        "qudt:hasUnit is not used: in schema/SCHEMA_QUDT-v2.1.ttl (qudt/qudt-public-repo, commit "
        "00348b15) the range of its inverse is qudt:SystemOfUnits, so that a property would "
        "become a system of units; afn:unit is an annotation.",
    ),
}


def gather_links(folder: Path, names: Iterable[Row]) -> str:
    """The text of `links.csv`: for each Open English WordNet name of a category, its identifiers.

    Only rows whose synset passed the table's hypernym check count; a name without one is a
    `KnowledgeError` with its place.
    """
    path = folder / PUBLIC_TABLE
    if not path.is_file():
        raise KnowledgeError(f"{path}: missing; give the folder that holds the public tables")
    known = {row["object"]: row for row in read_rows(path, table=PUBLIC_TABLE)}
    lines = set()
    for name in names:
        if name["source"] != "oewn":
            continue
        row = known.get(name["name"])
        if row is None or row.get("hypernym_check") != "1" or not row.get("oewn_synset"):
            raise name.error(f"{name['name']!r} has no checked synset in {PUBLIC_TABLE}; remove it")
        source = f"Open English WordNet by {row.place}; hypernym check passed"
        ids = (row["ili"], row["oewn_synset"], row["wikidata"])
        lines.add((name["category"], *ids, "taken from data", source))
    return csv_text(HEADER, sorted(lines))


def check_links(graph: Graph, links: Iterable[Row], units: Iterable[Row]) -> None:
    """Raise `KnowledgeError`, with its place, for a link of a term that the ontology lacks."""
    for row, column in [*((r, "category") for r in links), *((r, "property") for r in units)]:
        if (URIRef(AFN + row[column]), None, None) not in graph:
            raise row.error(
                f"{column} {row[column]} is not in the ontology; mend or remove the row"
            )


def link_files(links: Iterable[Row], units: Iterable[Row]) -> Mapping[str, str]:
    """The alignment files that are built from tables: name to Turtle, same bytes for same rows."""
    rows = list(links)
    wordnet = _pairs(rows, "category", "ili", "wordnet_ili")
    wordnet += _pairs(rows, "category", "oewn", "oewn")
    wikidata = _pairs(rows, "category", "wd", "wikidata")
    measured = _pairs(units, "property", "unit", "unit")
    return {
        "wordnet.ttl": _turtle("wordnet", "skos:closeMatch", wordnet),
        "wikidata.ttl": _turtle("wikidata", "skos:closeMatch", wikidata),
        "qudt.ttl": _turtle("qudt", "afn:unit", measured),
    }


def _pairs(rows: Iterable[Row], about: str, prefix: str, column: str) -> list[tuple[str, str]]:
    return [(row[about], f"{prefix}:{row[column]}") for row in rows if row.get(column)]


def _turtle(name: str, predicate: str, pairs: Iterable[tuple[str, str]]) -> str:
    lines = [f"afn:{subject} {predicate} {value} ." for subject, value in sorted(set(pairs))]
    body = "\n".join(lines)
    used = {"afn", "dcterms", "owl", "rdfs", "xsd"} | {
        prefix for prefix in _PREFIXES if f" {prefix}:" in body
    }
    prefixes = [f"@prefix {p}: <{iri}> ." for p, iri in _PREFIXES.items() if p in used]
    kind = [f"{predicate} a owl:AnnotationProperty ."]
    return "\n".join([*prefixes, "", *_header(name), "", *kind, "", body, ""])


def _header(name: str) -> list[str]:
    title, about, note = _NOTES[name]
    iri = f"{_ALIGNMENTS}/{name}"
    return [
        f"<{iri}> a owl:Ontology ;",
        f"  owl:versionIRI <{iri}/{VERSION}> ;",
        f'  dcterms:title "AfNet/AfRob reconstruction: alignment with {title}"@en ;',
        f'  dcterms:description "{about}"@en ;',
        '  dcterms:creator "The afkb authors"@en ;',
        f"  dcterms:license <{LICENCE}> ;",
        f'  dcterms:created "{CREATED}"^^xsd:date ;',
        f'  dcterms:modified "{MODIFIED}"^^xsd:date ;',
        f'  rdfs:comment "Built from the tables by `afkb ontology build`. {note}"@en .',
    ]
