"""Find what the schema describes at a path in a file, with the descriptions of what refers to it."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from linkforge_compile.schema.json_schema import POSITION, Schema, has_names, is_plain, mapping, reference
from linkforge_compile.schema.registry import ROOT, whole_schema

_DESCRIBING = ("description", "markdownDescription", "examples", "defaultSnippets", "$comment")
"""Keys of a schema that describe all branches of its union."""


class Described(NamedTuple):
    """A branch of the schema at a path: what it refers to, with the descriptions of the reference.

    `definition` is the name of the definition that it is, or is a branch of.
    """

    schema: Schema
    definition: str = ""

    @property
    def kinds(self) -> tuple[str, ...]:
        """The JSON types that it allows; none for any."""
        kinds = self.schema.get("type", [])
        return tuple(map(str, kinds if isinstance(kinds, list) else [kinds]))

    @property
    def keys(self) -> dict[str, Schema]:
        """The schemas of the known keys."""
        return {key: mapping(part) for key, part in mapping(self.schema.get("properties", {})).items()}

    @property
    def has_names(self) -> bool:
        """Whether it is a map keyed by names."""
        return has_names(self.schema)

    @property
    def is_free(self) -> bool:
        """Whether its keys or items are the author's own."""
        return is_plain(self.schema)

    def describe(self, schema: Schema) -> tuple[Described, ...]:
        """Return the branches of a part of it."""
        return tuple(_branches(schema, self.definition))

    def at(self, key: str | int) -> tuple[Described, ...]:
        """Return the branches under a key or in an item; none for an unknown key."""
        if isinstance(key, int):
            items = self.schema.get("items")
            return self.describe(_as_item(self.schema, items)) if isinstance(items, dict) else ()
        if key in self.keys:
            return self.describe(self.keys[key])
        others = self.schema.get("additionalProperties")
        if isinstance(others, dict):
            return self.describe(others)
        positions = mapping(self.schema.get("patternProperties", {})).get(POSITION)
        if isinstance(positions, dict) and re.match(POSITION, key):
            return self.describe(positions)
        return ()


def described_at(path: Sequence[str | int]) -> tuple[Described, ...]:
    """Return the branches of the schema at a path of keys and indices; none where it describes nothing."""
    found = tuple(_branches({"$ref": f"#/definitions/{ROOT}"}))
    for key in path:
        found = tuple(inner for branch in found for inner in branch.at(key))
    return found


def _branches(schema: Schema, definition: str = "") -> Iterator[Described]:
    while (name := reference(schema)) is not None:
        own = {key: part for key, part in schema.items() if key != "$ref"}
        schema, definition = {**mapping(mapping(whole_schema()["definitions"])[name]), **own}, name
    union = schema.get("anyOf")
    if not isinstance(union, list):
        yield Described(schema, definition)
        return
    shared = {key: schema[key] for key in _DESCRIBING if key in schema}
    for branch in union:
        yield from _branches({**shared, **mapping(branch)}, definition)


def _as_item(listed: Schema, item: Schema) -> Schema:
    """Return the schema of an item, which has names of the kinds that its list says."""
    comment = str(listed.get("$comment", ""))
    return {"$comment": comment, **item} if comment.startswith("names: ") else item
