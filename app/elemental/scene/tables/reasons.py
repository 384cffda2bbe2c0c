"""Why a value does not fit its place in a table, in the program's own words."""

from __future__ import annotations

from typing import Any

REASONS = {
    "extra_forbidden": "is an unknown key",
    "missing": "is missing",
    "too_short": "needs {min_length} items or more, not {actual_length}",
    "too_long": "needs {max_length} items or fewer, not {actual_length}",
    "string_type": "should be a text",
    "string_too_short": "should not be empty",
    "string_too_long": "should have {max_length} characters or fewer",
    "string_pattern_mismatch": "should be one line of text",
    "float_type": "should be a number",
    "finite_number": "should be a finite number",
    "int_type": "should be a whole number",
    "int_from_float": "should be a whole number",
    "bool_type": "should be true or false",
    "list_type": "should be a list",
    "dict_type": "should be a table",
    "model_type": "should be a table",
    "literal_error": "should be {expected}",
    "greater_than": "should be greater than {gt:g}",
    "greater_than_equal": "should be {ge:g} or more",
    "less_than": "should be less than {lt:g}",
    "less_than_equal": "should be {le:g} or less",
    "value_error": "{error}",
}
"""By the kind of a pydantic error; the braces are filled from its context."""


def reason(kind: str, context: dict[str, Any]) -> str:
    """The reason that stands for an error of this kind."""
    return REASONS.get(kind, "has a value that can't be here").format_map(context)


def field(place: tuple[int | str, ...]) -> str:
    """("lights", 0, "kind") as lights[0].kind."""
    name = ""
    for step in place:
        name += f"[{step}]" if isinstance(step, int) else f".{step}" if name else step
    return name
