"""Schemas that offer, in an entry of `modules`, the parameters of what it uses and what an override of it reaches."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from linkforge_compile.expand.listing import ListedParameter
from linkforge_compile.schema.json_types import Schema


def entry_of(parameters: Sequence[ListedParameter], entries: Mapping[str, Sequence[str]]) -> Schema:
    """Return what to offer in an entry; `entries` are the module's own names by section."""
    override: Schema = {
        # By a union the server knows to put in a key with its colon.
        section: _keys_alone({name: {"anyOf": [{}]} for name in names})
        for section, names in entries.items()
    }
    return {"properties": {"with": _keys_alone(arguments_of(parameters)), "override": _keys_alone(override)}}


def where_used(use: str, offer: Schema) -> Schema:
    """Return an offer for the entries that use a file, as they name it."""
    return {"if": {"properties": {"use": {"const": use}}, "required": ["use"]}, "then": offer}


def arguments_of(parameters: Sequence[ListedParameter]) -> Schema:
    """Return the parameters as keys, each with what it means and its values."""
    return {parameter.name: _argument(parameter) for parameter in parameters}


def _keys_alone(properties: Schema) -> Schema:
    """Return what offers keys within a key of the language, which is offered itself elsewhere."""
    return {"doNotSuggest": True, "properties": properties}


def _argument(parameter: ListedParameter) -> Schema:
    """Return what a module's parameter means, what it takes and its values, those of its choice or the default."""
    unit = f" {parameter.unit}" if parameter.unit else ""
    facts = [f"type `{parameter.type}`"] if parameter.type else []
    facts.append("required" if parameter.default is None else f"default `{parameter.default}`")
    facts += [f"at least `{parameter.minimum}{unit}`"] if parameter.minimum is not None else []
    facts += [f"at most `{parameter.maximum}{unit}`"] if parameter.maximum is not None else []
    told = "\n\n".join(filter(None, (parameter.description, "; ".join(facts))))
    values = [f"{choice}{unit}" if unit else choice for choice in parameter.choices or ()]
    if not values and parameter.type == "boolean":
        values = [True, False]
    elif not values and parameter.value is not None and parameter.type not in ("list", "map", "vector"):
        values = [parameter.default if unit or isinstance(parameter.value, str) else parameter.value]
    offer: Schema = {"title": parameter.type or "a parameter", "description": told.replace("`", "'")}
    # By a union the server knows to put in a key with its colon where there are no examples.
    return offer | {"markdownDescription": told} | ({"examples": values} if values else {"anyOf": [{}]})
