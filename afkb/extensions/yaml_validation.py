"""Checks an extension in YAML against its model; what is wrong is said with line and mend."""

from __future__ import annotations

from typing import Any

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from afkb.extensions.problems import Problems, nearest_of
from afkb.extensions.yaml_model import SECTIONS, Extension
from afkb.extensions.yaml_reading import Document

_MENDS = {
    "list_type": "write a list, as in [0.2, 0.4]",
    "greater_than": "write 0.01 for what is very rare",
    "too_short": "write as many numbers as the format has",
    "too_long": "write as many numbers as the format has",
    "float_type": "write a number, with a point and without a unit",
    "finite_number": "write a number, with a point and without a unit",
    "string_type": "write a text; put it in quotes if it looks like a number",
    "string_too_short": "fill it, or leave the key out",
    "missing": "fill it",
    "literal_error": "write one of them",
    "dict_type": "write keys and values below it",
    "model_type": "write keys and values below it",
}
_LISTS_OF_WORDS = {
    "materials": "[WoodMaterial]",
    "traits": "[FlatTop]",
    "afbits": "[SupportAbility = 0.9]",
    "homes": "[my-rooms.csv]",
    "examples": "[the bench below the window]",
}
_PATTERNS = {
    "license": "write its address, as in https://creativecommons.org/licenses/by/4.0/",
    "extension": "write a name of letters, digits, - and _, as in my-home",
    "iri": "write a namespace that ends in # or /, as in https://example.org/my-home#",
}


def validated(document: Document, problems: Problems) -> Extension | None:
    """The extension that a document holds; what is wrong goes to `problems`, then None."""
    if "extension" not in document.data:
        known = ", ".join(sorted(document.data)[:5]) or "nothing"
        problems.add(
            document.place(),
            f"no extension: the key `extension` is missing, and there is {known}; "
            "start the file with `extension: my-home`",
        )
        return None
    try:
        return Extension.model_validate(_with_spelled_out_parameters(document.data))
    except ValidationError as error:
        for details in error.errors():
            problems.add(document.place(*details["loc"]), _problem(details))
        return None


def _with_spelled_out_parameters(data: dict[str, Any]) -> dict[str, Any]:
    """`Warmth: 0.3` as `Warmth: {value: 0.3}`; sections that are left empty are left out."""
    filled = {key: value for key, value in data.items() if value is not None or key == "extension"}
    parameters = filled.get("parameters")
    if isinstance(parameters, dict):
        filled["parameters"] = {
            name: value if isinstance(value, dict) else {"value": value}
            for name, value in parameters.items()
        }
    return filled


def _problem(details: ErrorDetails) -> str:
    loc, kind = details["loc"], details["type"]
    where = ".".join(str(part) for part in loc)
    if kind == "extra_forbidden":
        return f"{where}: unknown key; {nearest_of(str(loc[-1]), _keys_beside(loc))}"
    if kind == "missing":
        return f"{where} is missing; fill it"
    if kind == "string_pattern_mismatch":
        mend = _PATTERNS.get(str(loc[-1]), "write a name without spaces")
        return f"{where}: {details['input']!r} is not of that form; {mend}"
    said = details["msg"][:1].lower() + details["msg"][1:]
    given = details["input"]
    mend = _MENDS.get(kind, "mend the value")
    if kind == "list_type" and loc[-1] in _LISTS_OF_WORDS:
        mend = f"write a list, as in {_LISTS_OF_WORDS[str(loc[-1])]}"
    shown = "" if isinstance(given, dict | list) else f", not {given!r}"
    return f"{where}: {said}{shown}; {mend}"


def _keys_beside(loc: tuple[int | str, ...]) -> list[str]:
    model: type[BaseModel] = SECTIONS[str(loc[0])] if len(loc) > 1 else Extension
    return list(model.model_fields)
