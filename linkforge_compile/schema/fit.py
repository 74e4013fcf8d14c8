"""Says yes to a tree that is shaped as its schema says; whoever wants the reasons for a no asks jsonschema.

Most files are right, and to say so takes a twentieth of the time of looking for all that is wrong.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from functools import cached_property
from math import inf
from typing import ClassVar, Final

from linkforge_compile.schema.json_types import Json, Schema, branches, mapping
from linkforge_compile.schema.repetition import WORDS
from linkforge_compile.schema.words import branch_meant
from linkforge_compile.syntax.nodes import (
    ScalarValue,
    YamlEntry,
    YamlList,
    YamlMap,
    YamlNode,
    YamlScalar,
)

_SCALARS: dict[str, frozenset[type]] = {
    "null": frozenset({type(None)}),
    "boolean": frozenset({bool}),
    "number": frozenset({int, float}),
    "integer": frozenset({int}),
    "string": frozenset({str}),
}

_COLLECTIONS = ("object", "array")

_KEYWORDS = frozenset(
    {"type", "properties", "patternProperties", "additionalProperties", "required", "enum", "const"}
    | {"items", "minItems", "maxItems", "pattern"}
)

_WORDS_OF_EDITORS = frozenset(
    {"title", "description", "markdownDescription", "examples", "default", "defaultSnippets", "$comment", "$schema"}
    | {"errorMessage", "patternErrorMessage", "enumDescriptions", "markdownEnumDescriptions"}
)


class Fit:
    """A linked schema as a judge that answers yes or no; `fit_of` makes it.

    A yes is certain: jsonschema then finds nothing that would be told. A no is not: 2.0 is a whole number to
    jsonschema alone, and a tree that holds a fault already is never let through.

    `heeds_null` is whether a field without a value is judged, as jsonschema does, and not passed over, as the
    language does.
    """

    _judged: ClassVar = _KEYWORDS

    def __init__(self, schema: Schema, *, heeds_null: bool = False) -> None:
        if unknown := schema.keys() - self._judged - _WORDS_OF_EDITORS:
            raise ValueError(f"a schema holds what is not judged: {sorted(unknown)}")
        # Words and constants are scalars, though their schemas need not say so.
        kinds = _texts(schema.get("type")) or [*_SCALARS, *(() if schema.keys() & {"enum", "const"} else _COLLECTIONS)]
        self._schema: Final = schema
        self._heeds_null = heeds_null
        self._takes_maps = "object" in kinds
        self._takes_lists = "array" in kinds
        self._scalars = frozenset[type]().union(*(_SCALARS[kind] for kind in kinds if kind not in _COLLECTIONS))
        self._words = frozenset(_words(schema["enum"])) if "enum" in schema else None
        self._pattern = re.compile(str(schema["pattern"])) if "pattern" in schema else None
        self._required = frozenset(_texts(schema.get("required")))
        self._shortest, self._longest = _bounds(schema)
        self._known = mapping(schema.get("properties", {}))
        self._patterns = {re.compile(text): part for text, part in mapping(schema.get("patternProperties", {})).items()}
        if any(pattern.search(name) for pattern in self._patterns for name in self._known):
            raise ValueError(f"a schema judges a key of '{schema.get('title')}' twice")
        # The classes of scalars all of which are taken, such as that of numbers: nobody need look at their values.
        self._certain = self._certainly_taken()
        self._passed = self._certain if heeds_null else self._certain | _SCALARS["null"]

    def takes(self, node: YamlNode) -> bool:
        """Whether a node, with all that is in it, is shaped as the schema says."""
        if isinstance(node, YamlScalar):
            return node.value.__class__ in self._certain or self._takes_value(node.value)
        if isinstance(node, YamlMap):
            return self._takes_maps and self._takes_entries(node.entries)
        return isinstance(node, YamlList) and self._takes_lists and self._takes_items(node.items)

    def _certainly_taken(self) -> frozenset[type]:
        if self._words is not None or "const" in self._schema:
            return frozenset()
        return self._scalars if self._pattern is None else self._scalars - {str}

    def _takes_value(self, value: ScalarValue) -> bool:
        if type(value) not in self._scalars:
            return False
        if self._pattern is not None and isinstance(value, str) and not self._pattern.search(value):
            return False
        if self._words is not None and value not in self._words:
            return False
        return "const" not in self._schema or not (isinstance(value, bool) or value != self._schema["const"])

    def _takes_entries(self, entries: Mapping[str, YamlEntry]) -> bool:
        if self._required and not self._required <= entries.keys():
            return False
        keys = self._keys
        for name, entry in entries.items():
            judge = keys.get(name) or self._other_key(name)
            if judge is None:
                return False
            value = entry.value
            if isinstance(value, YamlScalar) and value.value.__class__ in judge._passed:
                continue
            if not judge.takes(value):
                return False
        return True

    @cached_property
    def _keys(self) -> dict[str, Fit]:
        return {name: self._part(part) for name, part in self._known.items()}

    def _other_key(self, name: str) -> Fit | None:
        """Return what judges the value of a key that is not known; None where there may be no such key."""
        for pattern, part in self._patterns.items():
            if pattern.search(name):
                return self._part(part)
        return self._others

    @cached_property
    def _others(self) -> Fit | None:
        return self._part_or_none(self._schema.get("additionalProperties", True))

    def _takes_items(self, items: Sequence[YamlNode]) -> bool:
        judge = self._items
        if judge is None or not self._shortest <= len(items) <= self._longest:
            return False
        certain = judge._certain
        for item in items:
            if isinstance(item, YamlScalar) and item.value.__class__ in certain:
                continue
            if not judge.takes(item):
                return False
        return True

    @cached_property
    def _items(self) -> Fit | None:
        return self._part_or_none(self._schema.get("items", True))

    def _part(self, schema: Json) -> Fit:
        return fit_of(mapping(schema), heeds_null=self._heeds_null)

    def _part_or_none(self, schema: Json) -> Fit | None:
        """Return the judge of a schema that may be written as true or false; None for false."""
        return None if schema is False else self._part(_ANYTHING if schema is True else schema)


class _Union(Fit):
    """A schema that says nothing itself but between which others there is a choice."""

    _judged: ClassVar = frozenset({"anyOf"})

    def __init__(self, schema: Schema, *, heeds_null: bool = False) -> None:
        self._branches = [fit_of(branch, heeds_null=heeds_null) for branch in branches(schema)]
        self._meant: dict[tuple[type, bool], Fit | None] = {}
        super().__init__(schema, heeds_null=heeds_null)

    def takes(self, node: YamlNode) -> bool:
        """Whether jsonschema finds a branch for the node, or would tell nothing of the one by which it is judged."""
        if isinstance(node, YamlScalar):
            return node.value.__class__ in self._certain or self._takes_value(node.value)
        if self._heeds_null:
            return any(branch.takes(node) for branch in self._branches)
        meant = self._branch_meant(node)
        return (meant is not None and meant.takes(node)) or fit_of(self._schema, heeds_null=True).takes(node)

    def _branch_meant(self, node: YamlNode) -> Fit | None:
        # Lists are judged alike, and so are maps but for those that repeat.
        kind = (node.__class__, isinstance(node, YamlMap) and not _REPEATING.isdisjoint(node.entries))
        if kind not in self._meant:
            position = branch_meant(self._schema, node)
            self._meant[kind] = None if position is None else self._branches[position]
        return self._meant[kind]

    def _certainly_taken(self) -> frozenset[type]:
        return frozenset[type]().union(*(branch._certain for branch in self._branches))

    def _takes_value(self, value: ScalarValue) -> bool:
        return any(branch._takes_value(value) for branch in self._branches)


def fit_of(schema: Schema, *, heeds_null: bool = False) -> Fit:
    """Return the judge of a linked schema, always the same one; each is made when a tree first leads to it."""
    # The schemas are made once and stay, so their identity is theirs for ever.
    key = (id(schema), heeds_null)
    if key not in _FITS:
        _FITS[key] = (_Union if "anyOf" in schema else Fit)(schema, heeds_null=heeds_null)
    return _FITS[key]


_FITS: dict[tuple[int, bool], Fit] = {}

_ANYTHING: Schema = {}

_REPEATING = frozenset(WORDS)


def _bounds(schema: Schema) -> tuple[float, float]:
    """Return how many items a list has at least and at most."""
    shortest, longest = schema.get("minItems", 0), schema.get("maxItems", inf)
    assert isinstance(shortest, int)
    assert isinstance(longest, int | float)
    return shortest, longest


def _texts(said: Json) -> list[str]:
    return [str(one) for one in said] if isinstance(said, list) else [] if said is None else [str(said)]


def _words(listed: Json) -> list[str | None]:
    words = listed if isinstance(listed, list) else []
    if not all(word is None or isinstance(word, str) for word in words):
        raise ValueError(f"an enum of more than words is not judged: {words}")
    return [None if word is None else str(word) for word in words]
