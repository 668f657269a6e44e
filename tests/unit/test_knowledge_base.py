import subprocess
import sys
from pathlib import Path

import pytest

from afkb.errors import KnowledgeError
from afkb.knowledge import AfNet, bundled_ontology
from ontology_samples import Copy, extension

SAMOVAR = """
<owl:NamedIndividual rdf:about="https://example.org/home#Samovar">
 <rdf:type rdf:resource="https://w3id.org/afkb/afnet#ObjectCategory"/>
 <rdfs:label xml:lang="en">samovar</rdfs:label>
 <afn:scale rdf:resource="https://w3id.org/afkb/afnet#Small"/>
 <afn:movability rdf:resource="https://w3id.org/afkb/afnet#Dynamic"/>
 <afn:matchingWeight>0.3</afn:matchingWeight><afn:expectedNumber>1</afn:expectedNumber>
 <afn:lengthMin>0.2</afn:lengthMin><afn:lengthMax>0.3</afn:lengthMax>
 <afn:widthMin>0.13</afn:widthMin><afn:widthMax>0.18</afn:widthMax>
 <afn:heightMin>0.12</afn:heightMin><afn:heightMax>0.2</afn:heightMax>
</owl:NamedIndividual>
<afn:Afbit rdf:about="https://example.org/home#Samovar.{feature}">
 <afn:ofCategory rdf:resource="https://example.org/home#Samovar"/>
 <afn:ofFeature rdf:resource="https://w3id.org/afkb/afnet#{feature}"/>
 <afn:strength>{strength}</afn:strength>
</afn:Afbit>
"""


@pytest.fixture(scope="module")
def base() -> AfNet:
    return AfNet()


def test_reads_what_the_paper_states(base: AfNet) -> None:
    assert base.categories["Mug"].afbits["ContainAbility"] > 0.9
    assert base.categories["Mug"].movability == "Dynamic"
    assert base.categories["Mug"].matching_weight == pytest.approx(0.3)
    strengths = {(d.evidence, d.predicted): d.strength for d in base.duals}
    assert strengths["ContainAbility", "SupportAbility"] == pytest.approx(0.7)
    rules = [c for c in base.co_occurrences if c.is_rule]
    assert [r.strength for r in rules] == [pytest.approx(0.65)]
    assert {"Kitchen", "LivingRoom", "Bedroom", "Bathroom", "UnknownRoom"} <= set(base.rooms)


def test_duals_are_directional(base: AfNet) -> None:
    strengths = {(d.evidence, d.predicted): d.strength for d in base.duals}
    there = strengths["DisplayAbility", "EngraveAbility"]
    back = strengths["EngraveAbility", "DisplayAbility"]
    assert there > 2 * back


def test_closed_containers_contain(base: AfNet) -> None:
    assert base.features["IntrinsicContainAbility"].broader == "ContainAbility"


def test_scales_follow_the_largest_extent(base: AfNet) -> None:
    assert base.scale_of((0.08, 0.09, 0.1)) == "Small"
    assert base.scale_of((0.45, 0.45, 0.02)) == "Medium"
    assert base.scale_of((1.2, 0.8, 0.02)) == "Large"


def test_groundings_have_fuzzy_ranges_in_si_units(base: AfNet) -> None:
    seat = base.features["SitAbility"].parameters["height_m"]
    assert seat(0.45) == 1.0
    assert seat(0.73) == 0.0
    assert 0 < seat(0.35) < 1


def test_terms_have_their_iri(base: AfNet) -> None:
    assert base.iri("Mug") == "https://w3id.org/afkb/afnet#Mug"
    with pytest.raises(KnowledgeError, match="no term named 'Unicorn'"):
        base.iri("Unicorn")


def test_an_extension_adds_a_category(tmp_path: Path, base: AfNet) -> None:
    path = extension(tmp_path, SAMOVAR.format(feature="ContainAbility", strength=0.9))
    extended = base.extended([path])
    assert extended.categories["Samovar"].afbits == {"ContainAbility": 0.9}
    assert extended.iri("Samovar") == "https://example.org/home#Samovar"
    assert extended.files == (bundled_ontology(), path)
    assert "Samovar" not in base.categories


@pytest.mark.parametrize(
    ("feature", "strength", "message"),
    [
        ("HoverAbility", 0.9, "feature HoverAbility is not in the ontology"),
        ("ContainAbility", 1.9, "strength 1.9 is not in 0..1"),
        ("ContainAbility", "much", "strength 'much' is no number"),
    ],
)
def test_a_bad_extension_is_refused_with_its_file(
    tmp_path: Path, base: AfNet, feature: str, strength: object, message: str
) -> None:
    path = extension(tmp_path, SAMOVAR.format(feature=feature, strength=strength))
    with pytest.raises(KnowledgeError, match=f"home.owl, line [0-9]+: .*{message}"):
        _ = base.extended([path]).categories


def test_an_extension_may_not_state_another_number(tmp_path: Path, base: AfNet) -> None:
    mug = '<rdf:Description rdf:about="https://w3id.org/afkb/afnet#Mug">'
    body = mug + "<afn:matchingWeight>0.9</afn:matchingWeight></rdf:Description>"
    with pytest.raises(KnowledgeError, match=r"home\.owl, line 6: Mug: matchingWeight is stated"):
        _ = base.extended([extension(tmp_path, body)]).categories


def test_an_extension_may_not_turn_the_features_round(tmp_path: Path, base: AfNet) -> None:
    contain = '<rdf:Description rdf:about="https://w3id.org/afkb/afnet#ContainAbility">'
    narrower = "https://w3id.org/afkb/afnet#IntrinsicContainAbility"
    body = f'{contain}<skos:broader rdf:resource="{narrower}"/></rdf:Description>'
    with pytest.raises(KnowledgeError, match="ContainAbility: broader is stated by"):
        _ = base.extended([extension(tmp_path, body)]).features


@pytest.mark.parametrize("content", [b"", b"<rdf:RDF", b"\x00\x01\x02", b"hello", b"{}"])
def test_bad_files_are_named(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "broken.owl"
    path.write_bytes(content)
    with pytest.raises(KnowledgeError, match=r"broken\.owl"):
        _ = AfNet(extensions=[path]).features


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(KnowledgeError, match=r"nowhere\.owl: no such ontology file"):
        _ = AfNet(tmp_path / "nowhere.owl").features


def test_an_ontology_without_what_the_network_needs_is_refused(tmp_path: Path) -> None:
    with pytest.raises(KnowledgeError, match="AfbitLeak"):
        _ = Copy().delete("AfbitLeak").load(tmp_path).features


def test_nothing_is_read_before_the_first_question(tmp_path: Path) -> None:
    AfNet(tmp_path / "nowhere.owl").extended([tmp_path / "neither.owl"])


def test_two_bases_do_not_share_a_world(tmp_path: Path, base: AfNet) -> None:
    changed = Copy().delete("ContainPredictsSupportBelow").load(tmp_path)
    assert len(changed.duals) == len(base.duals) - 1
    assert len(AfNet().duals) == len(base.duals)


def test_importing_the_knowledge_loads_no_heavy_library() -> None:
    code = "import sys, afkb.knowledge, afkb.inference, afkb_filtrations as _;" + (
        "print([m for m in ('owlready2', 'rdflib', 'pgmpy') if m in sys.modules])"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == "[]"
