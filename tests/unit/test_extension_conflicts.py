"""What is wrong in an extension in YAML is said with file, line, what and mend."""

from __future__ import annotations

from pathlib import Path

import pytest

from afkb.knowledge import AfNet, bundled_ontology
from extension_samples import HEAD, KIOSK, problems, yaml_file

STALL = KIOSK.replace("categories:\n", "").replace("Kiosk", "Stall")
CONFLICTS = {
    "a bundled category": (
        KIOSK.replace("Kiosk", "Mug"),
        "home.yaml, line 3: Mug is stated a second time, after the bundled ontology "
        "(categories/kitchenware.csv, line {mug}); rename this one, or add afbits to that one: "
        "`afbits:`",
    ),
    "the same afbit twice": (
        KIOSK + "    afbits:\n      - HangAbility = 0.4\n      - HangAbility = 0.5\n",
        "home.yaml, line 10: Kiosk.HangAbility is stated a second time, after home.yaml, line 9; "
        "keep one, or rename this one",
    ),
    "a probability above 1": (
        KIOSK + "    matching_weight: 1.4\n",
        "home.yaml, line 8: Kiosk: matchingWeight 1.4 is not in 0..1; write a probability",
    ),
    "a strength above 1": (
        KIOSK + "    afbits:\n      - HangAbility = 1.4\n",
        "home.yaml, line 9: 'Kiosk > HangAbility = 1.4': strength 1.4 is not in 0..1",
    ),
    "no afbit": (
        KIOSK + "    afbits: [holds things]\n",
        "home.yaml, line 8: 'Kiosk > holds things' is no afbit; write it as in "
        "`Mug > ContainAbility = 0.95` or "
        "`Mug/HandlePart > MediumWrapGrasp @ UprightPose, Small = 0.8`",
    ),
    "an unknown affordance": (
        KIOSK + "    afbits:\n      - SuportAbility = 0.9\n",
        "home.yaml, line 9: feature SuportAbility is not in the ontology; "
        "did you mean SupportAbility",
    ),
    "an unknown category": (
        "afbits:\n  - Mugg > HangAbility = 0.5\n",
        "home.yaml, line 3: category Mugg is not in the ontology; did you mean Mug",
    ),
    "an unknown broader term": (
        KIOSK.replace("Furniture", "Furnitur"),
        "home.yaml, line 4: category Furnitur is not in the ontology; did you mean Furniture",
    ),
    "an unknown scale": (
        KIOSK + "    scale: Larg\n",
        "home.yaml, line 8: scale Larg is not in the ontology; did you mean Large?",
    ),
    "an unknown shape": (
        KIOSK + "    shape: Box\n",
        "home.yaml, line 8: Box is a category, no shape; did you mean BoxShape?",
    ),
    "an unknown material": (
        KIOSK + "    materials: [Wood]\n",
        "home.yaml, line 8: material Wood is not in the ontology; did you mean WoodMaterial?",
    ),
    "an unknown trait": (
        KIOSK + "    traits: [FlatTopp]\n",
        "home.yaml, line 8: trait FlatTopp is not in the ontology; did you mean FlatTop?",
    ),
    "an unknown part": (
        KIOSK + "    afbits:\n      - /HandelPart > MediumWrapGrasp = 0.5\n",
        "home.yaml, line 9: part HandelPart is not in the ontology; did you mean HandlePart",
    ),
    "an unknown pose": (
        KIOSK + "    afbits:\n      - HangAbility @ Upright = 0.5\n",
        "home.yaml, line 9: pose Upright is not in the ontology; did you mean UprightPose?",
    ),
    "an unknown evidence class": (
        "rooms:\n  Den:\n    definition: A room.\n    holds: {BedSuport: 1}\n",
        "home.yaml, line 5: evidence class BedSuport is not in the ontology; "
        "did you mean BedSupport",
    ),
    "a cycle": (
        KIOSK.replace("Furniture", "Stall")
        + KIOSK.replace("categories:\n", "")
        .replace("Kiosk", "Stall")
        .replace("Furniture", "Kiosk"),
        "home.yaml, line 4: Kiosk is broader than itself: Kiosk > Stall > Kiosk; "
        "change one `broader` of these",
    ),
    "an empty range": (
        KIOSK.replace("[0.4, 0.8]", "[0.8, 0.4]"),
        "home.yaml, line 5: Kiosk: length from 0.8 to 0.4 is empty; swap them",
    ),
    "a length of nothing": (
        KIOSK.replace("[0.4, 0.8]", "[0, 0.4]"),
        "home.yaml, line 5: Kiosk: length 0 is not above 0; write metres or kilograms",
    ),
    "a fuzzy range that falls": (
        "features:\n  AbAbility:\n    kind: material\n    definition: It.\n"
        "    parameters:\n      mass_kg: [0, 3, 2, 4]\n",
        "home.yaml, line 7: AbAbility.mass_kg: 0, 3, 2, 4 do not rise; "
        "write where the membership is 0, 1, 1, 0",
    ),
    "a word for a number": (
        KIOSK.replace("[0.4, 0.8]", "[wide, 0.8]"),
        "home.yaml, line 5: categories.Kiosk.length_m.0: input should be a valid number, not "
        "'wide'; write a number, with a point and without a unit",
    ),
    "one number for two": (
        KIOSK.replace("[0.4, 0.8]", "0.8"),
        "home.yaml, line 5: categories.Kiosk.length_m: input should be a valid list, not 0.8; "
        "write a list, as in [0.2, 0.4]",
    ),
    "a key left out": (
        KIOSK.replace("    broader: Furniture\n", ""),
        "home.yaml, line 3: categories.Kiosk.broader is missing; fill it",
    ),
    "an unknown key": (
        KIOSK + "    widht_m: [0.3, 0.5]\n",
        "home.yaml, line 8: categories.Kiosk.widht_m: unknown key; did you mean width_m",
    ),
    "an unknown section": (
        KIOSK.replace("categories", "catgories"),
        "home.yaml, line 2: catgories: unknown key; did you mean categories?",
    ),
    "a key twice": (
        KIOSK + "    width_m: [0.3, 0.6]\n",
        "home.yaml, line 8: width_m is given a second time, after line 6; keep one, or rename this",
    ),
    "a category twice": (
        KIOSK + KIOSK.replace("categories:\n", ""),
        "home.yaml, line 8: Kiosk is given a second time, after line 3; keep one, or rename this",
    ),
    "a name with a space": (
        KIOSK.replace("Kiosk", "ice kiosk"),
        "home.yaml, line 3: the name 'ice kiosk' is not of that form; write 'IceKiosk': letters "
        "and digits, a capital first",
    ),
    "a word that is none of few": (
        KIOSK + "    moved: Sometimes\n",
        "home.yaml, line 8: categories.Kiosk.moved: input should be 'Fixed', 'Rarely', 'Often' or "
        "'Carried', not 'Sometimes'; write one of them",
    ),
    "homes that are not there": (
        "homes: [rooms.csv]\n",
        "home.yaml, line 2: homes: no file rooms.csv beside this one",
    ),
    "a bad namespace": (
        "iri: example.org/home\n",
        "home.yaml, line 2: iri: 'example.org/home' is not of that form; write a namespace that "
        "ends in # or /, as in https://example.org/my-home#",
    ),
    "a pair of nothing": (
        "co_occurrences:\n  Pair: {feature: SupportAbility, strength: 0.5, size_m: [1, 1], "
        "evidence_category: Chair}\n",
        "home.yaml, line 3: Pair names neither two evidence classes nor two categories; "
        "name two of a kind",
    ),
    "an alias": (
        KIOSK.replace("[0.4, 0.8]", "&a [0.4, 0.8]").replace("[0.3, 0.5]", "*a"),
        "home.yaml, line 6: an alias (`*name`) is not understood here; write it out",
    ),
}


@pytest.mark.parametrize("what", CONFLICTS)
def test_it_is_said_with_file_line_and_mend(tmp_path: Path, what: str) -> None:
    body, expected = CONFLICTS[what]
    assert any(
        said.startswith(expected.format(mug=_line_of_mug()))
        for said in problems(yaml_file(tmp_path, body))
    ), problems(yaml_file(tmp_path, body))


def test_an_afbit_that_the_ontology_has_is_refused(tmp_path: Path) -> None:
    afbit = next(a for a in AfNet().afbits if a.category == "Mug" and a.part is None)
    said = problems(yaml_file(tmp_path, f"afbits:\n  - Mug > {afbit.feature} = 0.5\n"))
    assert said == [
        f"home.yaml, line 3: Mug > {afbit.feature} is stated a second time, after the bundled "
        "ontology; keep one"
    ]


FILES = {
    "an empty file": (
        "",
        "home.yaml: empty; write a starter with `afkb ontology new` and fill that in",
    ),
    "comments only": ("# soon\n", "home.yaml: empty; write a starter with `afkb ontology new`"),
    "a list": ("- a\n- b\n", "home.yaml, line 1: no extension: it holds no keys; start it with"),
    "something else": (
        "recipe: soup\nserves: 4\n",
        "home.yaml, line 1: no extension: the key `extension` is missing, and there is recipe, "
        "serves; start the file with `extension: my-home`",
    ),
    "a tab": (
        f"{HEAD}categories:\n\tKiosk:\n",
        "home.yaml, line 3: a tab where YAML wants spaces; indent with spaces",
    ),
    "broken YAML": (f"{HEAD}categories: [a, b\n", "home.yaml, line 3: not YAML: "),
    "two documents": (f"{HEAD}---\nx: 1\n", "home.yaml, line 2: not YAML: "),
    "a name with a slash": (
        "extension: my/home\n",
        "home.yaml, line 1: extension: 'my/home' is not of that form; write a name of letters",
    ),
}


@pytest.mark.parametrize("what", FILES)
def test_a_file_that_is_no_extension_is_refused(tmp_path: Path, what: str) -> None:
    text, expected = FILES[what]
    (said,) = problems(yaml_file(tmp_path, "", head=text))
    assert said.startswith(expected)


def test_bytes_that_are_no_text_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "home.yaml"
    path.write_bytes(b"extension: caf\xe9\n")
    assert problems(path) == ["home.yaml: not UTF-8 (byte 14); save it as UTF-8"]


def test_a_file_of_another_kind_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "home.docx"
    path.write_bytes(b"")
    (said,) = problems(path)
    assert said.startswith("home.docx: no extension: files of an ontology end in .yaml, .yml, .csv")


def test_everything_is_said_at_once(tmp_path: Path) -> None:
    body = KIOSK.replace("[0.4, 0.8]", "[0.8, 0.4]") + "    scale: Hugely\n    shape: Boxx\n"
    lines = [said.split(": ")[0] for said in problems(yaml_file(tmp_path, body))]
    assert lines == ["home.yaml, line 5", "home.yaml, line 8", "home.yaml, line 9"]


def _line_of_mug() -> int:
    table = bundled_ontology().parent / "tables" / "categories" / "kitchenware.csv"
    lines = table.read_text(encoding="utf-8").splitlines()
    return next(n for n, line in enumerate(lines, 1) if line.startswith("Mug,"))
