"""What people write by mistake, or with an editor: refused with line and mend, or read."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from afkb.csv_rows import Row
from afkb.errors import KnowledgeError
from afkb.knowledge import AfNet
from afkb.knowledge.cache import cache_folder, cached, content_key
from afkb.ontology.counted_pairs import _scaled_up
from afkb.starters import write_starter
from extension_samples import HEAD, KIOSK, problems, table, yaml_file

_SLIPS = {
    "centimetres": (
        KIOSK.replace("[1.0, 1.5]", "[100, 150]"),
        "line 7: Kiosk: height 150 is above 6 m; write metres, not centimetres",
    ),
    "grams": (
        KIOSK + "    mass_kg: [20000, 30000]\n",
        "line 8: Kiosk: mass 30000 is above 20000 kg; write kilograms, not grams",
    ),
    "the ontology's namespace": (
        "iri: https://w3id.org/afkb/afnet#\n",
        "line 2: iri: https://w3id.org/afkb/afnet# is the ontology's own; choose one",
    ),
    "a name for a class": (
        KIOSK.replace("Kiosk", "KioskEntity"),
        "line 3: the name 'KioskEntity' ends as those of classes do",
    ),
    "a measure that is no name": (
        "features:\n  GrowAbility:\n    kind: structural\n    definition: d\n"
        '    parameters: {"<x>": [1, 2, 3, 4]}\n',
        "line 6: the measure '<x>' is not of that form; write it with its unit",
    ),
    "a control character": (
        'label: "a\\u0000b"\n',
        "line 2: a control character in the text; take it out",
    ),
    "a tag": (
        'label: !!python/object/apply:os.system ["true"]\n',
        "line 2: a tag (tag:yaml.org,2002:python/object/apply:os.system) is not understood",
    ),
    "a group for a category": (
        "afbits:\n  - Furniture > SupportAbility = 0.2\n",
        "line 3: Furniture is a group, no category; name a category",
    ),
    "an unknown key": (
        KIOSK + "    colour: red\n",
        "line 8: categories.Kiosk.colour: unknown key; known: afbits, broader,",
    ),
    "a word for a list": (
        KIOSK + "    materials: WoodMaterial\n",
        "line 8: categories.Kiosk.materials: input should be a valid list, not 'WoodMaterial'; "
        "write a list, as in [WoodMaterial]",
    ),
    "a count of nothing": (
        "evidence_classes:\n  Rack:\n    feature: SupportAbility\n    elsewhere: 0\n",
        "line 5: evidence_classes.Rack.elsewhere: input should be greater than 0, not 0; "
        "write 0.01",
    ),
}


@pytest.mark.parametrize("slip", _SLIPS)
def test_a_slip_in_yaml_is_one_line(tmp_path: Path, slip: str) -> None:
    body, expected = _SLIPS[slip]
    said = problems(yaml_file(tmp_path, body))
    assert any(line.startswith(f"home.yaml, {expected}") for line in said), said


_COLUMNS = ("name", "broader", "length_min_m", "length_max_m", "width_min_m", "width_max_m")


@pytest.mark.parametrize(
    ("header", "expected"),
    [
        (";".join(_COLUMNS), "columns are parted by ';'; part them by commas"),
        ("\t".join(_COLUMNS), "columns are parted by a tab; part them by commas"),
        (",".join((*_COLUMNS, "name")), "column name is there twice; take one out"),
    ],
)
def test_a_header_is_read_with_commas_and_once(tmp_path: Path, header: str, expected: str) -> None:
    said = problems(table(tmp_path, "categories.csv", header))
    assert f"categories.csv, line 1: {expected}" in said, said


_AFN = "https://w3id.org/afkb/afnet#"
_CHANGES = {
    "a number": (
        "<afn:expectedNumber>99</afn:expectedNumber>",
        "Mug",
        "Mug: expectedNumber is stated by the bundled ontology",
    ),
    "the broader term": (
        f'<skos:broader rdf:resource="{_AFN}Furniture"/>',
        "Mug",
        "Mug: broader is stated by the bundled ontology",
    ),
    "another kind of term": (
        f'<rdf:type rdf:resource="{_AFN}ObjectCategory"/>',
        "SupportAbility",
        "SupportAbility is a feature already",
    ),
    "a cyclic subclass": (
        '<rdfs:subClassOf rdf:resource="https://example.org/shop#TerrariumEntity"/>',
        "DecorationEntity",
        "DecorationEntity is a subclass of itself: "
        "DecorationEntity > TerrariumEntity > DecorationEntity",
    ),
    "no instance": (
        '<rdfs:subClassOf rdf:resource="http://www.w3.org/2002/07/owl#Nothing"/>',
        "MugEntity",
        "MugEntity is a subclass of owl:Nothing",
    ),
}


def _owl(folder: Path, more: str) -> Path:
    """The starter in OWL with more in it."""
    (path,) = write_starter(folder / "shop.owl")
    text = path.read_text(encoding="utf-8")
    path.write_text(text.replace("</rdf:RDF>", f"{more}\n</rdf:RDF>"), encoding="utf-8")
    return path


@pytest.mark.parametrize("change", _CHANGES)
def test_an_owl_file_changes_nothing_that_is_there(tmp_path: Path, change: str) -> None:
    body, name, expected = _CHANGES[change]
    path = _owl(tmp_path, f'<rdf:Description rdf:about="{_AFN}{name}">{body}</rdf:Description>')
    line = len(path.read_text(encoding="utf-8").splitlines()) - 1
    said = problems(path)
    assert any(s.startswith(f"shop.owl, line {line}: {expected}") for s in said), said


def test_an_individual_without_an_iri_is_told(tmp_path: Path) -> None:
    assert problems(_owl(tmp_path, "<afn:Afbit><afn:strength>0.9</afn:strength></afn:Afbit>")) == [
        "shop.owl: an individual of Afbit has no IRI, so nobody could read it; give it one"
    ]


def test_an_editors_translations_are_read(tmp_path: Path) -> None:
    german = '<rdfs:label xml:lang="de">{}</rdfs:label></rdf:Description>'
    own = '<rdf:Description rdf:about="https://example.org/shop#Terrarium">'
    mug = f'<rdf:Description rdf:about="{_AFN}Mug">'
    path = _owl(tmp_path, own + german.format("Glaskasten") + mug + german.format("Becher"))
    home = AfNet.load(extensions=[path])
    assert (home.categories["Terrarium"].label, home.categories["Mug"].label) == (
        "terrarium",
        "mug",
    )


def test_the_cache_outlives_damage_and_an_empty_setting(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("AFKB_CACHE", str(tmp_path))
    for damage in (b"", b"garbage", b"\x80\x05\x95", b"cos\nnope\n.", os.urandom(50)):
        (tmp_path / "some-key.pickle").write_bytes(damage)
        assert cached("some", "key", lambda: 3) == 3
    monkeypatch.setenv("AFKB_CACHE", "")
    assert cache_folder() != Path()


def test_folders_of_other_names_are_kept_apart(tmp_path: Path) -> None:
    for name in ("one", "two"):
        table(tmp_path, f"{name}/parameters.csv", "name,value", "Warmth,0.3")
    assert content_key([tmp_path / "one"]) != content_key([tmp_path / "two"])


def test_a_missing_extension_is_named(tmp_path: Path) -> None:
    with pytest.raises(Exception, match=r"nope\.yaml: no such ontology file; check the name"):
        AfNet(extensions=[tmp_path / "nope.yaml"]).statements_about("Mug")


def test_the_head_alone_is_an_extension(tmp_path: Path) -> None:
    assert "Mug" in AfNet.load(extensions=[yaml_file(tmp_path, "", head=HEAD)]).categories


def test_a_scale_that_no_table_has_is_told_with_its_row() -> None:
    rows = [Row("categories/a.csv", line, {"scale": s}) for line, s in ((2, "Small"), (3, "Huge"))]
    with pytest.raises(KnowledgeError, match=r"categories/a\.csv, line 3: scale 'Huge' is none"):
        _scaled_up(*rows)


@pytest.mark.skipif(sys.platform == "win32", reason="limits of files are POSIX")
def test_a_full_disk_leaves_nothing_half_written(tmp_path: Path) -> None:
    """A limit on the size of files stands for the disk that is full."""
    script = """
import resource, signal, sys
from pathlib import Path
from afkb.errors import KnowledgeError
from afkb.knowledge.cache import put
from afkb.starters import write_starter
from afkb.csv_rows import Row
from afkb.errors import KnowledgeError
from afkb.ontology.counted_pairs import _scaled_up
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))
folder = Path(sys.argv[1])
put(folder / "entry", b"." * 5000)
try:
    write_starter(folder / "home.yaml")
except KnowledgeError as error:
    print(error)
"""
    out = subprocess.run(
        [sys.executable, "-c", script, str(tmp_path)], capture_output=True, text=True, check=True
    )
    assert "home.yaml: can't be written: File too large" in out.stdout
    assert list(tmp_path.iterdir()) == []
