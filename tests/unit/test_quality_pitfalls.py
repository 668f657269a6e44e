from __future__ import annotations

from pathlib import Path

import pytest

from afkb.quality.checked import Checked
from afkb.quality.pitfalls import PITFALLS, check_pitfalls, findings_of
from quality_samples import broken, told

CLASS = 'rdfs:label "{0}"@en ; skos:definition "Said well."@en ; skos:example "one"@en .'
TRIPS = {
    "a property called `is`": (
        "", ":isA a owl:ObjectProperty .", "isA: P03 says what a type or subclass says"),
    "a term that nothing uses": (
        ":hasTrait :OpenTop", ":hasTrait :Clay", "OpenTop: P04 no statement names it; use it"),
    "inverse properties whose domain and range do not match": (
        "", ":x a owl:ObjectProperty ; rdfs:domain :Mug ; owl:inverseOf :shape .",
        "x: P05 goes from Mug; its inverse shape to Shape; let"),
    "a cycle in a hierarchy": (
        "", ":Tableware skos:broader :Mug .", "Mug: P06 is broader itself, by way of Tableware"),
    "no label, definition or example": (
        ':Afbit a owl:Class ; rdfs:label "Afbit"@en ; ', ":Afbit a owl:Class ; ",
        "Afbit: P08 label is missing; state its label"),
    "no disjointness": (
        ":Affordance owl:disjointWith :ObjectCategory .", "",
        "afnet: P10 no two classes are disjoint; say which"),
    "a property without domain or range": (
        "", ":x a owl:ObjectProperty ; rdfs:range :Mug .", "x: P11 domain is missing; name its"),
    "two properties of one label": (
        ':z2 a owl:DatatypeProperty ; rdfs:domain owl:Thing ; rdfs:range xsd:double ; '
        'rdfs:label "z2"@en',
        ':z2 a owl:DatatypeProperty ; rdfs:domain owl:Thing ; rdfs:range xsd:double ; '
        'rdfs:label "z1"@en', "z2: P12 z1 has the same label; make them one"),
    "several domains or ranges, which all hold at once": (
        "", ":shape rdfs:range :Pose .", "shape: P19 every range is Pose and Shape at once; name"),
    "label and definition mixed up": (
        'rdfs:label "Clay as such"@en ; skos:definition "What it is, said well."@en',
        'rdfs:label "Clay as such"@en ; skos:definition "A clay."@en',
        "Clay: P20 the definition says no more than the label; say what tells it"),
    "a name of another style": (
        "", f":white_clay a :Material ; {CLASS.format('white clay')}",
        "white_clay: P22 the name is not UpperCamelCase; rename it"),
    "a definition that defines by the term itself": (
        'rdfs:label "Clay as such"@en ; skos:definition "What',
        'rdfs:label "clay"@en ; skos:definition "Clay is what',
        "Clay: P24 the definition begins with the term; say it in other words"),
    "a property that is its own inverse": (
        "", ":shape owl:inverseOf :shape .", "shape: P25 is its own inverse; declare it symm"),
    "a symmetric property with an inverse": (
        "", ":shape a owl:SymmetricProperty ; owl:inverseOf :pose .",
        "shape: P26 is symmetric and has the inverse pose; take one"),
    "two terms of one label": (
        ':Tableware a :CategoryGroup ; rdfs:label "Tableware as such"',
        ':Tableware a :CategoryGroup ; rdfs:label "mug as such"',
        "Tableware: P32 Mug is called 'mug as such', too; let labels differ"),
    "a property chain of one property": (
        "", ":shape owl:propertyChainAxiom ( :pose ) .", "shape: P33 a chain has one property"),
    "a class that is not declared": (
        "", ":Pot rdfs:subClassOf :Mugs .", "Pot: P34 Mugs is used as a class and not declared"),
    "a property that is not declared": (
        ":value 3.0e-2", ":valeu 3.0e-2", "Leak: P35 valeu is used as a property and not decl"),
    "a file's suffix in an IRI": (
        "", "<https://example.org/my.owl#Pot> a :Material .", "Pot: P36 the IRI https://exam"),
    "no ontology header": (
        "<https://w3id.org/afkb/afnet> a owl:Ontology ;", "<https://w3id.org/afkb/afnet>",
        "sample.ttl: P38 no owl:Ontology is declared; declare it with its IRI"),
    "an ontology without an IRI": (
        "<https://w3id.org/afkb/afnet> a owl:Ontology ;", "[] a owl:Ontology ;",
        "P39 the ontology has no IRI; give it one by rdf:about"),
    "statements about others' terms": (
        "", 'skos:broader rdfs:label "above" .', "broader: P40 label is said of others' term"),
    "no licence": ("dcterms:license <", "rdfs:seeAlso <", "afnet: P41 no licence; state dcterms:"),
    "no version, title, description, author or date": (
        'dcterms:title "sample" ;', "", "afnet: dcterms:title is missing in the header; state it"),
    "a class that is disjoint with itself or with a broader one": (
        "", ":Dual owl:disjointWith :Relationship .",
        "Dual: is disjoint with Relationship, which it is a kind of; take"),
    "a term that is named and not stated": (
        ":madeOf :Clay", ":madeOf :Caly", "Mug: madeOf names Caly, which nothing states; mend"),
    "an individual without a class": (
        "", ':Thing rdfs:label "thing" .', "Thing: is of no class; say what it is by rdf:type"),
    "a property that is never used": (
        "", ":glaze a owl:ObjectProperty ; rdfs:domain :Afbit .", "glaze: no statement uses it"),
}  # fmt: skip


def test_a_sound_ontology_falls_into_no_pitfall(tmp_path: Path) -> None:
    assert told(check_pitfalls(broken(tmp_path, "", ""))) == ""


@pytest.mark.parametrize("pitfall", PITFALLS, ids=lambda p: p.name)
def test_every_pitfall_is_tripped_by_a_broken_sample(tmp_path: Path, pitfall) -> None:  # type: ignore[no-untyped-def]
    old, new, message = TRIPS[pitfall.name]
    assert message in told(list(findings_of(pitfall, broken(tmp_path, old, new))))


def test_a_finding_names_file_line_and_mend(tmp_path: Path) -> None:
    checked = broken(tmp_path, "", ":shape rdfs:range :Pose .")
    line = next(
        n
        for n, text in enumerate((tmp_path / "sample.ttl").read_text().splitlines(), 1)
        if text.startswith(":shape ")
    )
    assert told(check_pitfalls(checked)) == (
        f"{tmp_path}/sample.ttl, line {line}: shape: P19 every range is Pose and Shape at once; "
        "name one class, or the union of them"
    )


def test_what_is_told_of_the_ontology_is_advice_for_an_extension(tmp_path: Path) -> None:
    broken(tmp_path, "", "")
    home = tmp_path / "home.ttl"
    home.write_text(
        "@prefix afn: <https://w3id.org/afkb/afnet#> .\n"
        "<https://example.org/home#tea_bowl> a afn:ObjectCategory ; afn:madeOf afn:Caly .\n"
    )
    findings = check_pitfalls(Checked.of_files([home], [tmp_path / "sample.ttl"]))
    assert [str(f) for f in findings if not f.advice] == [
        f"{home}, line 2: tea_bowl: madeOf names Caly, which nothing states; "
        "mend the name, or state it"
    ]
    assert {f.what for f in findings if f.advice} == {
        "P38 no owl:Ontology is declared", "P22 the name is not UpperCamelCase",
    }  # fmt: skip
