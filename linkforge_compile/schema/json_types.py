"""Types of schemas: JSON, and the linked schema, whose references are replaced by what they refer to."""

from __future__ import annotations

from typing import TypeAlias

Json: TypeAlias = None | bool | int | float | str | list["Json"] | dict[str, "Json"]
Schema: TypeAlias = dict[str, Json]


class LinkedSchema(dict[str, Json]):
    """A part of the linked schema; `source` is the same part with its `$ref`s.

    Hashed and compared by identity: schemas that contain themselves cannot be compared by content.
    """

    def __init__(self, source: Schema) -> None:
        super().__init__(source)
        self.source = source

    # dict has no hash, as it is mutable; a linked schema is never changed.
    def __hash__(self) -> int:  # type: ignore[override]
        return id(self)

    def __eq__(self, other: object) -> bool:
        return self is other

    def __ne__(self, other: object) -> bool:
        return self is not other


def mapping(node: object) -> Schema:
    """Return a node as an object; raise TypeError if it is not one, which our schemas rule out."""
    if not isinstance(node, dict):
        raise TypeError(f"expected a JSON object, found {node!r}")
    return node


def linked_part(node: object) -> LinkedSchema:
    """Return a part of the linked schema; raise TypeError for anything else."""
    if not isinstance(node, LinkedSchema):
        raise TypeError(f"expected a part of the linked schema, found {node!r}")
    return node


def branches(schema: Schema) -> list[Schema]:
    """Return the branches of the schema's `anyOf`, or the schema itself."""
    union = schema.get("anyOf")
    return [mapping(branch) for branch in union] if isinstance(union, list) else [schema]


def reference(schema: Schema) -> str | None:
    """Return the name of the definition that a schema refers to; None for one without `$ref`."""
    target = schema.get("$ref")
    return target.rpartition("#/definitions/")[2] if isinstance(target, str) else None
