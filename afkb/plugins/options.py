"""Options that a user gives a source, checked once, with one line that says what is wrong."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeVar

from pydantic import BaseModel, ValidationError

from afkb.errors import SourceError

Options = TypeVar("Options", bound=BaseModel)


def read_options(model: type[Options], uri: str, options: Mapping[str, str]) -> Options:
    """The options as `model`; `SourceError` names the option, its value and those that exist.

    Let the model forbid extra fields, so that a misspelt option is refused and not ignored.
    """
    try:
        return model.model_validate(dict(options))
    except ValidationError as error:
        first = error.errors()[0]
        name = str(first["loc"][0]) if first["loc"] else "options"
        known = ", ".join(sorted(model.model_fields)) or "none"
        if first["type"] == "extra_forbidden":
            reason = f"unknown option {name!r}"
        else:
            reason = f"option {name}={options.get(name, '')!r}: {first['msg']}"
        raise SourceError(f"{uri}: {reason}; this source takes: {known}") from error
