"""Options that a user gives a plugin, checked once, with one line that says what is wrong."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeVar

from pydantic import BaseModel, ValidationError

from afkb.errors import AfkbError, SourceError

Options = TypeVar("Options", bound=BaseModel)


def read_options(
    model: type[Options],
    uri: str,
    options: Mapping[str, str],
    what: str = "source",
    error_type: type[AfkbError] = SourceError,
) -> Options:
    """The options as `model`; the error names the option, its value and those that exist.

    Let the model forbid extra fields, so that a misspelt option is refused and not ignored.
    `uri`: whose options they are: a recording, or a plugin's name. `what` they belong to.
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
        raise error_type(f"{uri}: {reason}; this {what} takes: {known}") from error
