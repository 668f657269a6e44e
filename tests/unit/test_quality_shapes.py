from __future__ import annotations

from pathlib import Path

import pytest
from rdflib import Graph

from afkb.knowledge import bundled_ontology
from afkb.quality.checked import Checked
from afkb.quality.shape_check import check_shapes, read_shapes
from quality_samples import broken, sound, told

UNIT = "write a number from 0 to 1"
BROKEN = [
    # What every individual has.
    ('rdfs:label "Clay as such"@en ; ', "", "Clay: label is missing; give it"),
    (":Large a :Scale ; rdfs:label", ":Large a :Scale ; skos:note", "Large: label is missing"),
    ('"Clay as such"@en', '"Clay as such"@en, "clay"@en', "label is given twice in the language"),
    (':RoundShape a :Shape ; rdfs:label "RoundShape as such"@en ; skos:definition',
     ':RoundShape a :Shape ; rdfs:label "RoundShape as such"@en ; skos:note',
     "RoundShape: definition is missing; define it in one sentence"),
    # One for every shape, by class.
    (':groundingStatus "stated"', ':groundingStatus "sure"', "'sure' is none of the known ones"),
    (':grounding "a bar"@en ; ', "", "HookGrasp: grounding is missing; say in words"),
    ("skos:broader :SupportAbility", "skos:broader :Mug", "broader Mug is no Affordance"),
    (":n2 2.0e0", ":n2 2.0e1", "ContainAbility.depth_m: n2 20.0 is above z2; let z1, n1, n2"),
    (':parameterName "depth_m"', ':parameterName "Depth"', "parameterName 'Depth' does not fit"),
    (':groundedBy "detector"', ':groundedBy "magic"', "write one of: detector, measures"),
    (':groundedOn "opening"', ':groundedOn "lid"', "write one of: body, surface"),
    (":groundingStrength 8.0e-1", ":groundingStrength 8.0e0", "groundingStrength 8.0 is above 1.0"),
    (':measureName "depth_m"', ':measureName "Depth"', "measureName 'Depth' does not fit"),
    (':measureOf "opening" ;', "", "DepthMeasure: measureOf is missing; say what has it"),
    (":extentMax 3.5e-1", ":extentMax -1.0e0", "Small: extentMax -1.0 is not above 0.0"),
    (":whole true", ':whole "yes"', "TopPart: whole 'yes' is no boolean; write yes or no"),
    ("skos:broader :Tableware", "skos:broader :Small", "name one broader category or group"),
    (":entityClass :MugEntity", ":entityClass :Small", "entityClass Small is no Class"),
    (':standsOn "Support"', ':standsOn "Table"', "standsOn 'Table' is none of the known ones"),
    (":lengthMax 1.5e-1", ":lengthMax 7.5e-2", "lengthMin 0.08 is above lengthMax"),
    (":widthMax 1.1e-1", ":widthMax 2.1e-1", "width is the shorter horizontal extent: swap"),
    (":heightMin 8.0e-2", ":heightMin 0.0e0", "heightMin 0.0 is not above 0.0"),
    (":heightMin 8.0e-2", ':heightMin "high"', "heightMin 'high' is no double"),
    (":heightMin 8.0e-2 ; ", "", "heightMin is missing; give heightMin and heightMax in m"),
    (" ; :topMax 2.0e-1", "", "one end of a range alone: topMin without topMax"),
    (":massMin 1.0e-1 ; ", "", "one end of a range alone: massMin without massMax"),
    (":scale :Small ; :standsOn", ":scale :Small, :Large ; :standsOn", "scale is stated more than"),
    (":moved :Carried", ":moved :Clay", "moved Clay is no MovingHabit"),
    (":Dynamic ; :moved :Carried", ":Dynamic", "moved is missing; fill the column moved"),
    (":matchingWeight 3.0e-1", ":matchingWeight 3.0e0", "matchingWeight 3.0 is above 1.0; write"),
    (":expectedNumber 4.0e0", ":expectedNumber 0.0e0", "expectedNumber 0.0 is not above 0.0"),
    (":madeOf :Clay", ":madeOf :Porcelain", "madeOf Porcelain is no Material"),
    (":strength 9.5e-1", ":strength 9.5e0", f"strength 9.5 is above 1.0; {UNIT}"),
    (":strength 9.5e-1", ":strength -9.5e0", f"strength -9.5 is below 0.0; {UNIT}"),
    (":independentSources 2", ":independentSources 1", "stands on one source alone"),
    (":pose :UprightPose ; :scale", ":scale", "Mug.ContainAbility: pose is missing"),
    (":byRule :OpenTopContains", ":byRule :Mug", "byRule Mug is no AfbitRule"),
    (":strength 9.0e-1", ":strength 2.0e0", "OpenTopContains: strength 2.0 is above 1.0"),
    (':relation "below"', ':relation "under"', "ContainBelow: relation 'under' is none of"),
    (":evidence :ContainAbility", ":evidence :Mug", "evidence Mug is no Affordance; name the one"),
    (":sizeYTypical 8.0e-1", ":sizeYTypical 8.0e0", "sizeYTypical 8.0 is above sizeXTypical"),
    (":predictedClass :Seats ; ", "", "LargerNear: names neither two evidence classes nor two"),
    (":dataSuccesses 3.0e0", ":dataSuccesses 5.0e0", "dataSuccesses 5.0 is above dataTrials"),
    (":dispersion 2.0e0", ":dispersion 0.0e0", "Seats: dispersion 0.0 is not above 0.0"),
    (":expectedNumber 1.0e0", ":expectedNumber -1.0e0", "Kitchen: expectedNumber -1.0 is not"),
    (":expectedCount 4.0e0", ":expectedCount 0.0e0", "Kitchen.Seats: expectedCount 0.0 is not"),
    (":value 3.0e-2", ":value 3.0e-2, 4.0e-2", "Leak: value is stated more than once; give one"),
    (":meanNumber 1.5e0", ":meanNumber -1.5e0", "Mug.Kitchen: meanNumber -1.5 is below 0.0"),
    (":ofRoom :Kitchen ; :prob", ":ofRoom :Mug ; :prob", "ofRoom Mug is no RoomCategory"),
    (":Mug.On a :ObjectOnSupport ;", ":Mug.On a :ObjectOnSupport ; :givenCategory :Kitchen ;",
     "Mug.On: givenCategory Kitchen is no ObjectCategory"),
    (":rate 1.0e-1", ":rate 1.1e0", "Mug.Rate: rate 1.1 is above 1.0; write one number"),
    ("", ":Mug.Mug :successes 9.0e0 .", "Mug.Mug: successes 9.0 is above trials; count in how"),
    ("", ':Clay :status "surely" .', "Clay: status 'surely' is none of the known ones; write one"),
    ("", ":Tableware skos:broader :Mug .", "Tableware: broader Mug is no CategoryGroup"),
]  # fmt: skip


@pytest.fixture(scope="module")
def shapes() -> Graph:
    return read_shapes(bundled_ontology().parent / "shapes")


def test_a_sound_ontology_fits_all_shapes(tmp_path: Path, shapes: Graph) -> None:
    assert told(check_shapes(broken(tmp_path, "", ""), shapes)) == ""


@pytest.mark.parametrize(("old", "new", "message"), BROKEN)
def test_what_does_not_fit_is_told_with_its_mend(
    tmp_path: Path, shapes: Graph, old: str, new: str, message: str
) -> None:
    assert message in told(check_shapes(broken(tmp_path, old, new), shapes))


def test_a_finding_names_the_row_else_file_and_line(tmp_path: Path, shapes: Graph) -> None:
    row = told(check_shapes(broken(tmp_path, ":heightMin 8.0e-2", ":heightMin 1.0e0"), shapes))
    assert row.startswith("categories/cups.csv, line 7: Mug: heightMin 1.0 is above heightMax; ")
    line = next(n for n, text in enumerate(sound().splitlines(), 1) if text.startswith(":Leak "))
    found = told(check_shapes(broken(tmp_path, ":value 3.0e-2", ":value true"), shapes))
    assert found.startswith(f"{tmp_path}/sample.ttl, line {line}: Leak: value 'true' is no double")


def test_an_extension_is_advised_and_only_its_own_terms_are_looked_at(
    tmp_path: Path, shapes: Graph
) -> None:
    broken(tmp_path, ":value 3.0e-2", ":value true")
    home = tmp_path / "home.ttl"
    home.write_text(
        "@prefix afn: <https://w3id.org/afkb/afnet#> .\n"
        "@prefix home: <https://example.org/home#> .\n"
        "home:Teddy.Support a afn:Afbit ; afn:ofCategory afn:Mug ;\n"
        "  afn:ofFeature afn:SupportAbility ; afn:strength 2.0e0 .\n"
    )
    findings = check_shapes(Checked.of_files([home], [tmp_path / "sample.ttl"]), shapes)
    assert {f.name for f in findings} == {"Teddy.Support"}
    assert [f.what for f in findings if not f.advice] == ["strength 2.0 is above 1.0"]
    assert {f.what for f in findings if f.advice} == {
        "label is missing", "source is missing", "status is missing",
    }  # fmt: skip
    assert all(f.place == f"{home}, line 3" for f in findings)


def test_every_shape_says_the_mend(shapes: Graph) -> None:
    asked = """SELECT ?path WHERE { ?shape sh:path ?path ; sh:minCount|sh:maxCount|sh:in ?any
        FILTER NOT EXISTS { ?shape sh:message ?mend } FILTER NOT EXISTS { ?l rdf:first ?up .
        ?up sh:property ?shape } }"""
    assert [str(row[0]) for row in shapes.query(asked)] == []
