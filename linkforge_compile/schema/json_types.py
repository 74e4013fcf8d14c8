"""What a schema is while we read it: JSON, and JSON objects above all."""

from __future__ import annotations

from typing import TypeAlias

Json: TypeAlias = None | bool | int | float | str | list["Json"] | dict[str, "Json"]
Schema: TypeAlias = dict[str, Json]


def mapping(node: object) -> Schema:
    """Return a node that is an object by the make of our schemas; raises TypeError where it is not."""
    if not isinstance(node, dict):
        raise TypeError(f"expected a JSON object, found {node!r}")
    return node


def branches(schema: Schema) -> list[Schema]:
    """Return what the schema may be: its `anyOf`, else itself."""
    union = schema.get("anyOf")
    return [mapping(branch) for branch in union] if isinstance(union, list) else [schema]


def reference(schema: Schema) -> str | None:
    """Return the name of the definition that a schema stands for, None where it stands for itself."""
    target = schema.get("$ref")
    return target.rpartition("#/definitions/")[2] if isinstance(target, str) else None
