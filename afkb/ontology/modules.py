"""The ontology in five parts, for whoever needs only some of it; `afnet.owl` stays the whole."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from xml.sax.saxutils import quoteattr

from rdflib import BNode, Graph, URIRef
from rdflib.namespace import OWL, RDF, RDFS
from rdflib.term import Node

from afkb.ontology.header import PREFIXES, RECONSTRUCTION, add_header
from afkb.ontology.names import AFN, KINDS, ONTOLOGY_IRI, VERSION
from afkb.ontology.rdfxml import to_rdfxml
from afkb.ontology.writing import put_whole

CATALOG = "catalog-v001.xml"


@dataclass(frozen=True, slots=True)
class Module:
    """A part of the ontology.

    `imports`: the modules whose terms it uses, those that they import left out. `classes`: the
    classes that it describes, with their individuals and the properties about them.
    """

    name: str
    about: str
    imports: tuple[str, ...]
    classes: frozenset[str]

    @property
    def iri(self) -> str:
        """The module's ontology IRI."""
        return f"{ONTOLOGY_IRI}/{self.name}"


_CATEGORY_CLASSES = (
    "ObjectCategory", "CategoryGroup", "Afbit", "AfbitRule", "ReportRate", "Shape", "Material",
    "Trait", "ObjectPart", "Pose", "MovingHabit", "Movability",
)  # fmt: skip
_RELATION_CLASSES = (
    "Relationship", "Dual", "CoOccurrence", "ObjectWithObject", "ObjectOnSupport",
    "NetworkParameter",
)  # fmt: skip
MODULES = (
    Module(
        "features",
        "affordance features, their grounding, scales, and the annotations that every module uses",
        (),
        frozenset(("Affordance", *KINDS.values(), "Trapezoid", "Measure", "Scale")),
    ),
    Module(
        "categories",
        "object categories with their sizes, materials and afbits, and the rules that make afbits",
        ("features",),
        frozenset(_CATEGORY_CLASSES),
    ),
    Module(
        "rooms",
        "room categories, what is counted to tell them apart, and what they hold",
        ("categories",),
        frozenset(("RoomCategory", "RoomEvidence", "EvidenceClass", "ObjectInRoom", "Figure")),
    ),
    Module(
        "relations",
        "duals, co-occurrences, figures of things with things, and the numbers of the network",
        ("rooms",),
        frozenset(_RELATION_CLASSES),
    ),
    Module(
        "scene",
        "the words of topological affordance maps, and the classes that classify their entities",
        ("rooms",),
        frozenset(),
    ),
)
"""The modules, those that are imported first. What no other describes belongs to the last."""

# Where neither the kind nor the domain of a property tells: an annotation belongs to the first
# module, a property to the module of its domain, any other to the last.
_PROPERTIES = {
    "features": (
        "status", "groundingStatus", "grounding", "observability", "fromRow", "parameterName",
        "z1", "n1", "n2", "z2", "extentMin", "extentMax", "ofFeature", "scale", "strength",
    ),
    "categories": (
        "entityClass", "standsOn", "ofCategory", "lengthMin", "lengthMax", "widthMin", "widthMax",
        "heightMin", "heightMax", "topMin", "topMax", "expectedNumber", "matchingWeight",
        "movability", "moved", "shape", "madeOf", "hasTrait", "massMin", "massMax", "ofPart",
        "pose", "byRule", "reviewed", "independentSources", "whole", "rate",
    ),
    "rooms": (
        "ofRoom", "ofEvidenceClass", "expectedCount", "dispersion", "givenCategory", "successes",
        "trials", "buildings", "probability",
    ),
    "relations": (
        "evidence", "predicted", "relation", "evidenceBottomMin", "evidenceClass",
        "predictedClass", "evidenceCategory", "predictedCategory", "distanceMean", "distanceSd",
        "sizeXTypical", "sizeYTypical", "predictedScale", "value",
    ),
}  # fmt: skip
_DEFINED_IN = {name: module for module, names in _PROPERTIES.items() for name in names}
_ORDER = [module.name for module in MODULES]
_STATEMENTS = frozenset((
    "Afbit", "Trapezoid", "ReportRate", "RoomEvidence", "ObjectInRoom", "ObjectWithObject",
    "ObjectOnSupport",
))  # fmt: skip
"""Classes whose individuals are statements: they are no terms that a module defines."""


def add_modules(graph: Graph) -> None:
    """State of every term by which module it is defined."""
    homes = _Homes(graph)
    for subject in {s for s in graph.subjects(RDF.type) if str(s).startswith(AFN)}:
        classes = {str(c).removeprefix(AFN) for c in graph.objects(subject, RDF.type)}
        if not classes & _STATEMENTS:
            iri = f"{ONTOLOGY_IRI}/{homes.of_subject(subject)}"
            graph.add((subject, RDFS.isDefinedBy, URIRef(iri)))


def split(graph: Graph) -> dict[str, Graph]:
    """The modules' graphs by name; every statement of the whole is in exactly one.

    The whole's own header is in none; each module has a header of its own.
    """
    homes = _Homes(graph)
    parts = {module.name: Graph("SimpleMemory") for module in MODULES}
    whole = URIRef(ONTOLOGY_IRI)
    for subject, predicate, value in graph:
        if subject != whole:
            parts[homes.of_statement(subject, predicate, value)].add((subject, predicate, value))
    for module in MODULES:
        _add_module_header(parts[module.name], module)
    return parts


class _Homes:
    """Which module a subject belongs to, found once per subject."""

    def __init__(self, graph: Graph) -> None:
        self._graph = graph
        self._found: dict[Node, str] = {}
        self._of_class = {name: m.name for m in MODULES for name in m.classes}
        self._stated_in = {
            value: (subject, predicate)
            for subject, predicate, value in graph
            if isinstance(value, BNode)
        }

    def of_statement(self, subject: Node, predicate: Node, value: Node | None = None) -> str:
        if predicate == URIRef(AFN + "entityClass"):
            return MODULES[-1].name
        if predicate == OWL.disjointWith and value is not None:
            return max(self.of_subject(subject), self.of_subject(value), key=_ORDER.index)
        return self.of_subject(subject)

    def of_subject(self, subject: Node) -> str:
        if subject not in self._found:
            self._found[subject] = self._find(subject)
        return self._found[subject]

    def _find(self, subject: Node) -> str:
        if isinstance(subject, BNode):
            return self.of_statement(*self._stated_in[subject])
        if not str(subject).startswith(AFN):
            return MODULES[0].name
        name = str(subject).removeprefix(AFN)
        if name in _DEFINED_IN:
            return _DEFINED_IN[name]
        if (subject, RDF.type, OWL.AnnotationProperty) in self._graph:
            return MODULES[0].name
        about = [
            *self._graph.objects(subject, RDF.type),
            *self._graph.objects(subject, RDFS.domain),
        ]
        classes = (str(c).removeprefix(AFN) for c in about)
        homes = {self._of_class[c] for c in (name, *classes) if c in self._of_class}
        return min(homes, default=MODULES[-1].name)


def _add_module_header(graph: Graph, module: Module) -> None:
    title = f"AfNet/AfRob reconstruction: {module.name}"
    text = f"{module.about[0].upper()}{module.about[1:]}. {RECONSTRUCTION}"
    add_header(graph, module.iri, title, text)
    for name in module.imports:
        graph.add((URIRef(module.iri), OWL.imports, URIRef(f"{ONTOLOGY_IRI}/{name}")))


def write_modules(graph: Graph, folder: Path) -> list[Path]:
    """Write each module as RDF/XML, and a catalog by which Protégé finds them in the folder."""
    folder.mkdir(parents=True, exist_ok=True)
    written = []
    for name, part in split(graph).items():
        path = folder / f"{name}.owl"
        put_whole(path, to_rdfxml(part, PREFIXES))
        written.append(path)
    catalog = folder / CATALOG
    put_whole(catalog, _catalog())
    return [*written, catalog]


def _catalog() -> str:
    entries = [(ONTOLOGY_IRI, "../afnet.owl")]
    entries += [(module.iri, f"{module.name}.owl") for module in MODULES]
    lines = [
        f"  <uri name={quoteattr(name)} uri={quoteattr(file)}/>"
        for iri, file in entries
        for name in (iri, f"{iri}/{VERSION}")
    ]
    head = '<?xml version="1.0" encoding="UTF-8" standalone="no"?>'
    catalog = '<catalog prefer="public" xmlns="urn:oasis:names:tc:entity:xmlns:xml:catalog">'
    return "\n".join([head, catalog, *lines, "</catalog>", ""])
