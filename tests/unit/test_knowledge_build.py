import shutil
from pathlib import Path

import pytest
from rdflib import Graph, URIRef
from rdflib.namespace import DCTERMS, OWL, RDF, RDFS, SKOS

from afkb.errors import KnowledgeError
from afkb.knowledge import AFN, bundled_ontology
from afkb.ontology.build import build_ontology, write_ontology
from afkb.ontology.names import STATUSES
from afkb.ontology.schema import property_of
from afkb.quality.reading import read_graph

TABLES = Path(__file__).parents[2] / "ontology" / "tables"
STATUS = URIRef(AFN + "status")

pytestmark = pytest.mark.xdist_group("build")


@pytest.fixture(scope="session")
def graph() -> Graph:
    return read_graph(bundled_ontology())


def named(graph: Graph) -> list[URIRef]:
    return sorted({s for s in graph.subjects() if str(s).startswith(AFN)})


@pytest.fixture(scope="session")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("ontology")
    write_ontology(TABLES, folder / "afnet.owl", folder / "modules")
    return folder


def test_the_same_tables_give_the_same_bytes(built: Path) -> None:
    committed = bundled_ontology().parent
    files = ["afnet.owl", *(f"modules/{p.name}" for p in (built / "modules").iterdir())]
    assert sorted(p.name for p in (committed / "modules").iterdir()) == sorted(
        Path(f).name for f in files[1:]
    )
    for name in files:
        assert (built / name).read_bytes() == (committed / name).read_bytes(), name


def test_every_term_has_a_label_and_every_named_one_a_definition(graph: Graph) -> None:
    assert [s for s in named(graph) if (s, RDFS.label, None) not in graph] == []
    undefined = [s for s in named(graph) if (s, SKOS.definition, None) not in graph]
    assert [s for s in undefined if "." not in s.removeprefix(AFN)] == []


def test_every_statement_carries_a_status_and_a_source(graph: Graph) -> None:
    individuals = set(graph.subjects(RDF.type, OWL.NamedIndividual))
    for individual in sorted(individuals):
        assert str(graph.value(individual, STATUS)) in STATUSES, individual
        assert (individual, DCTERMS.source, None) in graph, individual


def test_the_68_features_say_how_much_of_them_is_reconstruction(graph: Graph) -> None:
    kinds = {"StructuralAffordance": 25, "MaterialAffordance": 10, "GraspAffordance": 33}
    for kind, count in kinds.items():
        assert len(list(graph.subjects(RDF.type, URIRef(AFN + kind)))) == count
    assert str(graph.value(URIRef(AFN + "PassAbility"), STATUS)) == "proposed"
    assert str(graph.value(URIRef(AFN + "SupportAbility"), STATUS)) == "stated"
    assert str(graph.value(URIRef(AFN + "LateralGrasp"), STATUS)) == "published taxonomy"


def test_no_name_is_both_class_and_individual(graph: Graph) -> None:
    classes = set(graph.subjects(RDF.type, OWL.Class))
    assert classes & set(graph.subjects(RDF.type, OWL.NamedIndividual)) == set()


def test_map_vocabulary_is_declared(graph: Graph) -> None:
    node = URIRef(AFN + "MapNode")
    for name in ("RobotPlace", "ObservedEntity", "DualPrediction", "CoOccurrencePrediction"):
        assert (URIRef(AFN + name), RDFS.subClassOf, node) in graph
    for name in ("x", "y", "z", "sizeX", "sizeY", "sizeZ", "yaw", "existence", "observations"):
        assert (URIRef(AFN + name), RDF.type, OWL.DatatypeProperty) in graph


@pytest.mark.parametrize(
    ("table", "old", "new", "message"),
    [
        ("duals", "below,0.7,", "below,seven,", "duals.csv, line 2: strength 'seven' is no number"),
        ("rooms", "stated", "surely", "rooms.csv, line 2: status 'surely' is none of"),
        ("duals", ",Large,stated", ",Huge,stated", "duals.csv, line 2: Huge is named here, and no"),
        ("afbits", "Cup,BasinPart,Contain", "Cup,BasinPart,Hold", "line 2: feature HoldAbility is"),
        ("scales", "Medium,", "Small,", "line 3: Small is stated a second time, after scales.csv"),
    ],
)
def test_a_bad_row_is_refused_with_its_place(
    tmp_path: Path, table: str, old: str, new: str, message: str
) -> None:
    copied = shutil.copytree(TABLES, tmp_path / "tables")
    path = copied / f"{table}.csv"
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(KnowledgeError, match=message):
        build_ontology(copied)


def test_a_missing_table_is_named(tmp_path: Path) -> None:
    with pytest.raises(KnowledgeError, match=r"vocabulary\.csv: no such table"):
        build_ontology(tmp_path)


def test_columns_state_properties_in_si_units() -> None:
    assert property_of("length_min_m") == URIRef(AFN + "lengthMin")
    assert property_of("strength") == URIRef(AFN + "strength")
