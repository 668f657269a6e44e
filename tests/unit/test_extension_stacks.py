"""Conflicts between files, in OWL files as editors save them, and in tables."""

from __future__ import annotations

from pathlib import Path

import pytest

from afkb.extensions import extension_homes
from afkb.knowledge import AfNet
from extension_samples import KIOSK, problems, table, yaml_file

PROTEGE = """<?xml version="1.0"?>
<!DOCTYPE rdf:RDF [ <!ENTITY afn "https://w3id.org/afkb/afnet#"> ]>
<rdf:RDF xmlns="https://example.org/shop#" xml:base="https://example.org/shop"
     xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#"
     xmlns:owl="http://www.w3.org/2002/07/owl#"
     xmlns:rdfs="http://www.w3.org/2000/01/rdf-schema#"
     xmlns:skos="http://www.w3.org/2004/02/skos/core#"
     xmlns:afn="https://w3id.org/afkb/afnet#">
    <owl:Ontology rdf:about="https://example.org/shop"/>

    <!-- https://example.org/shop#Kiosk -->

    <owl:NamedIndividual rdf:about="https://example.org/shop#Kiosk">
        <rdf:type rdf:resource="https://w3id.org/afkb/afnet#ObjectCategory"/>
        <skos:broader rdf:resource="https://w3id.org/afkb/afnet#Furniture"/>
        <afn:scale rdf:resource="&afn;Large"/>
        <afn:movability rdf:resource="&afn;Static"/>
        <afn:matchingWeight>0.8</afn:matchingWeight>
        <afn:expectedNumber>1</afn:expectedNumber>
        <afn:lengthMin>0.4</afn:lengthMin>
        <afn:lengthMax>0.8</afn:lengthMax>
        <afn:widthMin>0.3</afn:widthMin>
        <afn:widthMax>0.5</afn:widthMax>
        <afn:heightMin>1.0</afn:heightMin>
        <afn:heightMax>1.5</afn:heightMax>
    </owl:NamedIndividual>

    <!-- https://example.org/shop#Kiosk.HangAbility -->

    <owl:NamedIndividual rdf:about="#Kiosk.HangAbility">
        <rdf:type rdf:resource="https://w3id.org/afkb/afnet#Afbit"/>
        <afn:ofCategory rdf:resource="#Kiosk"/>
        <afn:ofFeature rdf:resource="https://w3id.org/afkb/afnet#HangAbility"/>
        <afn:strength rdf:datatype="http://www.w3.org/2001/XMLSchema#double">0.4</afn:strength>
    </owl:NamedIndividual>
</rdf:RDF>
"""


def owl_file(folder: Path, *changes: tuple[str, str], name: str = "shop.owl") -> Path:
    text = PROTEGE
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def test_a_file_that_an_editor_saved_is_read(tmp_path: Path) -> None:
    kiosk = AfNet(extensions=[owl_file(tmp_path)]).categories["Kiosk"]
    assert kiosk.iri == "https://example.org/shop#Kiosk"
    assert kiosk.afbits["HangAbility"] == 0.4


AFN = "https://w3id.org/afkb/afnet#"
IN_OWL = {
    "a bundled name": (
        [("shop#Kiosk", "shop#Mug"), ("#Kiosk", "#Mug")],
        "shop.owl, line 13: Mug is stated a second time, after the bundled ontology",
    ),
    "a strength above 1": (
        [(">0.4</afn:strength>", ">1.4</afn:strength>")],
        "shop.owl, line 34: Kiosk.HangAbility: strength 1.4 is not in 0..1; write a probability",
    ),
    "an unknown affordance": (
        [(f"{AFN}HangAbility", f"{AFN}HangAbilty")],
        "shop.owl, line 33: feature HangAbilty is not in the ontology; did you mean HangAbility",
    ),
    "a name of another namespace": (
        [(f"{AFN}HangAbility", "https://example.org/shop#HangAbility")],
        "shop.owl, line 33: feature HangAbility is not in that namespace; write <https:",
    ),
    "an unknown scale": (
        [("&afn;Large", "&afn;Largish")],
        "shop.owl, line 16: scale Largish is not in the ontology; did you mean Large?",
    ),
    "a cycle": (
        [(f"{AFN}Furniture", "https://example.org/shop#Kiosk")],
        "shop.owl, line 15: Kiosk is broader than itself: Kiosk > Kiosk; change one `broader`",
    ),
    "an empty range": (
        [(">0.4</afn:lengthMin>", ">0.9</afn:lengthMin>")],
        "shop.owl, line 20: Kiosk: length from 0.9 to 0.8 is empty; swap them",
    ),
    "a word for a number": (
        [(">0.8</afn:matchingWeight>", ">much</afn:matchingWeight>")],
        "shop.owl, line 18: Kiosk: matchingWeight 'much' is no number; write one, with a point",
    ),
    "a number left out": (
        [("        <afn:heightMax>1.5</afn:heightMax>\n", "")],
        "shop.owl, line 13: Kiosk: heightMax is missing; add it",
    ),
    "broken XML": (
        [("</owl:NamedIndividual>\n\n    <!-- https://example.org/shop#Kiosk.", "<!-- ")],
        "shop.owl, line 34: not readable as RDF/XML: ",
    ),
}


@pytest.mark.parametrize("what", IN_OWL)
def test_it_is_said_with_the_line_of_the_owl_file(tmp_path: Path, what: str) -> None:
    changes, expected = IN_OWL[what]
    said = problems(owl_file(tmp_path, *changes))
    assert any(line.startswith(expected) for line in said), said


def test_turtle_is_told_by_line_too(tmp_path: Path) -> None:
    path = tmp_path / "shop.ttl"
    path.write_text(
        f"@prefix : <https://example.org/shop#> .\n@prefix afn: <{AFN}> .\n\n"
        ":A a afn:Afbit ; afn:ofCategory afn:Mug ; afn:ofFeature afn:HangAbility ;\n"
        "  afn:strength 3 .\n",
        encoding="utf-8",
    )
    assert problems(path) == ["shop.ttl, line 4: A: strength 3 is not in 0..1; write a probability"]


def test_naming_a_bundled_term_again_defines_nothing(tmp_path: Path) -> None:
    mug = (
        f'<owl:NamedIndividual rdf:about="{AFN}Mug"><rdf:type rdf:resource="{AFN}ObjectCategory"/>'
    )
    path = owl_file(tmp_path, ("</rdf:RDF>", f"{mug}</owl:NamedIndividual></rdf:RDF>"))
    assert "Kiosk" in AfNet(extensions=[path]).categories


def test_a_category_of_two_files_is_told_with_both_places(tmp_path: Path) -> None:
    first = yaml_file(tmp_path, KIOSK, "a.yaml")
    second = yaml_file(tmp_path, "\n" + KIOSK, "b.yaml")
    third = owl_file(tmp_path)
    assert problems(first, second, third) == [
        "b.yaml, line 4: Kiosk is stated a second time, after a.yaml, line 3; "
        "rename this one, or add afbits to that one: `afbits:`",
        "shop.owl, line 13: Kiosk is stated a second time, after a.yaml, line 3; "
        "rename this one, or add afbits to that one: `afbits:`",
    ]


def test_an_afbit_of_two_files_is_told(tmp_path: Path) -> None:
    first = owl_file(tmp_path)
    second = yaml_file(tmp_path, "afbits: [Kiosk > HangAbility = 0.2]\n")
    assert problems(first, second) == [
        "home.yaml, line 2: Kiosk > HangAbility is stated a second time, after "
        "shop.owl, line 30; keep one"
    ]


def test_a_later_file_s_names_are_not_known_yet(tmp_path: Path) -> None:
    first = yaml_file(tmp_path, "afbits: [Kiosk > HangAbility = 0.2]\n", "a.yaml")
    (said,) = problems(first, yaml_file(tmp_path, KIOSK, "b.yaml"))
    assert said.startswith("a.yaml, line 2: category Kiosk is not in the ontology; ")


def test_problems_of_all_files_are_said_at_once(tmp_path: Path) -> None:
    first = yaml_file(
        tmp_path, KIOSK.replace("[0.4, 0.8]", "[0.8, 0.4]").replace("Kiosk", "Stall"), "a.yaml"
    )
    second = owl_file(tmp_path, (">0.4</afn:strength>", ">1.4</afn:strength>"))
    files = [line.split(",")[0] for line in problems(first, second)]
    assert files == ["a.yaml", "shop.owl"]


HEADER = "name,broader,length_min_m,length_max_m,width_min_m,width_max_m,height_min_m,height_max_m"
STALL = "Stall,Furniture,1,2,1,1.5,2,3"


def test_a_single_table_is_told_by_its_columns(tmp_path: Path) -> None:
    path = table(tmp_path, "mine.csv", f"{HEADER},moved", f"{STALL},Fixed")
    stall = AfNet(extensions=[path]).categories["Stall"]
    assert (stall.iri, stall.moved) == ("https://example.org/mine#Stall", "Fixed")
    assert stall.place.endswith("mine.csv, line 2")


def test_a_folder_of_tables_may_hold_any_of_them(tmp_path: Path) -> None:
    table(tmp_path, "shop/categories/stalls.csv", HEADER, STALL)
    table(tmp_path, "shop/afbits.csv", "category,feature,strength", "Stall,HangAbility,0.6")
    table(tmp_path, "shop/features.csv", "name,kind,definition", "SellAbility,structural,It sells.")
    table(tmp_path, "shop/homes/flat.csv", "building,room,category,objects")
    base = AfNet(extensions=[tmp_path / "shop"])
    assert base.categories["Stall"].afbits["HangAbility"] == 0.6
    assert base.features["SellAbility"].definition == "It sells."
    assert extension_homes(tmp_path / "shop") == [tmp_path / "shop" / "homes" / "flat.csv"]


IN_TABLES = {
    "an unknown column": (
        [HEADER.replace("broader", "broder"), STALL],
        "categories.csv, line 1: unknown column 'broder'; did you mean broader?",
    ),
    "an empty cell": (
        [HEADER, STALL.replace("Furniture", "")],
        "categories.csv, line 2: Stall: broader is missing; fill it",
    ),
    "a word for a number": (
        [HEADER, STALL.replace(",2,3", ",high,3")],
        "categories.csv, line 2: height_min_m 'high' is no number",
    ),
    "a row twice": (
        [HEADER, STALL, STALL],
        "categories.csv, line 3: Stall is stated a second time, after categories.csv, line 2",
    ),
    "an odd word": (
        [f"{HEADER},moved", f"{STALL},Fixd"],
        "categories.csv, line 2: moved 'Fixd' is none of: Fixed, Rarely, Often, Carried, "
        "RarelyMoved; did you mean Fixed?",
    ),
    "an unknown name": (
        [f"{HEADER},traits", f"{STALL},FlatTop|Wheel"],
        "categories.csv, line 2: trait Wheel is not in the ontology; did you mean Wheels?",
    ),
    "too many cells": (
        [HEADER, f"{STALL},1,2"],
        "categories.csv, line 2: more cells than the header has columns",
    ),
    "an empty table": ([""], "categories.csv: empty; start it with the columns of one"),
}


@pytest.mark.parametrize("what", IN_TABLES)
def test_it_is_said_with_the_line_of_the_table(tmp_path: Path, what: str) -> None:
    lines, expected = IN_TABLES[what]
    said = problems(table(tmp_path, "categories.csv", *lines))
    assert any(line.startswith(expected) for line in said), said


def test_a_table_that_none_knows_is_refused(tmp_path: Path) -> None:
    (said,) = problems(table(tmp_path, "prices.csv", "thing,price", "cup,3"))
    assert said.startswith("prices.csv: no extension: neither its name nor its columns tell")


def test_an_empty_folder_is_refused(tmp_path: Path) -> None:
    (tmp_path / "shop").mkdir()
    (said,) = problems(tmp_path / "shop")
    assert said.startswith("shop: no extension: no table in this folder; name its files after")


@pytest.mark.parametrize("name", ["home.yaml", "copy.yaml"])
def test_a_file_that_is_given_again_is_read_once(tmp_path: Path, name: str) -> None:
    first, again = yaml_file(tmp_path, KIOSK), yaml_file(tmp_path, KIOSK, name)
    assert "Kiosk" in AfNet(extensions=[first, again]).categories
