"""Says yes to a tree that is shaped as its schema says; whoever wants the reasons for a no asks jsonschema.

Most files are right, and to say so takes a seventh of the time of looking for all that is wrong.
"""

from __future__ import annotations

import re
from functools import cached_property
from math import inf
from typing import Final

from linkforge_compile.schema.json_types import Json, Schema, branches, mapping
from linkforge_compile.schema.words import branch_meant
from linkforge_compile.syntax.nodes import (
    ScalarValue,
    YamlList,
    YamlMap,
    YamlNode,
    YamlScalar,
    is_null,
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
    {"type", "properties", "patternProperties", "additionalProperties", "required", "enum", "const", "anyOf"}
    | {"items", "minItems", "maxItems", "pattern"}
)

_WORDS_OF_EDITORS = frozenset(
    {"title", "description", "markdownDescription", "examples", "default", "defaultSnippets", "$comment", "$schema"}
    | {"errorMessage", "patternErrorMessage", "enumDescriptions", "markdownEnumDescriptions"}
)


class Fit:
    """A linked schema as a judge that answers yes or no.

    A yes is certain: jsonschema then finds nothing that would be told. A no is not: 2.0 is a whole number to
    jsonschema alone, and a tree that holds a fault already is never let through.
    """

    def __init__(self, schema: Schema) -> None:
        if unknown := schema.keys() - _KEYWORDS - _WORDS_OF_EDITORS:
            raise ValueError(f"a schema holds what is not judged: {sorted(unknown)}")
        # Words and constants are scalars, though their schemas need not say so.
        kinds = _texts(schema.get("type")) or [*_SCALARS, *(() if schema.keys() & {"enum", "const"} else _COLLECTIONS)]
        self._schema: Final = schema
        self._takes_map = "object" in kinds
        self._takes_list = "array" in kinds
        self._scalars = frozenset[type]().union(*(_SCALARS[kind] for kind in kinds if kind not in _COLLECTIONS))
        self._words = frozenset(_words(schema["enum"])) if "enum" in schema else None
        self._pattern = re.compile(str(schema["pattern"])) if "pattern" in schema else None
        self._is_constant = "const" in schema
        self._union = [fit_of(branch) for branch in branches(schema)] if "anyOf" in schema else None
        self._required = frozenset(_texts(schema.get("required")))
        self._known = mapping(schema.get("properties", {}))
        self._patterns = {re.compile(text): part for text, part in mapping(schema.get("patternProperties", {})).items()}
        if any(pattern.search(name) for pattern in self._patterns for name in self._known):
            raise ValueError(f"a schema judges a key of '{schema.get('title')}' twice")

    def takes(self, node: YamlNode, *, heeds_null: bool = False) -> bool:
        """Whether a node, with all that is in it, is shaped as the schema says.

        `heeds_null` is whether a field without a value is judged, as jsonschema does, and not passed over, as the
        language does.
        """
        if isinstance(node, YamlScalar):
            return node.value.__class__ in self._certain or self._takes_value(node.value)
        if isinstance(node, YamlMap):
            return self._takes_map and self._takes_union(node, heeds_null) and self._takes_entries(node, heeds_null)
        if isinstance(node, YamlList):
            return self._takes_list and self._takes_union(node, heeds_null) and self._takes_items(node, heeds_null)
        return False

    @cached_property
    def _certain(self) -> frozenset[type]:
        """The classes of scalars all of which are taken, such as that of numbers: nobody need look at their values."""
        if self._words is not None or self._is_constant:
            return frozenset()
        taken = self._scalars if self._pattern is None else self._scalars - {str}
        return taken if self._union is None else taken & frozenset().union(*(branch._certain for branch in self._union))

    def _takes_value(self, value: ScalarValue) -> bool:
        if type(value) not in self._scalars:
            return False
        if self._pattern is not None and isinstance(value, str) and not self._pattern.search(value):
            return False
        if self._words is not None and value not in self._words:
            return False
        if self._is_constant and (isinstance(value, bool) or value != self._schema["const"]):
            return False
        return self._union is None or any(branch._takes_value(value) for branch in self._union)

    def _takes_union(self, node: YamlMap | YamlList, heeds_null: bool) -> bool:
        """Whether jsonschema finds a branch for the node, or would tell nothing of the one by which it is judged."""
        if self._union is None:
            return True
        meant = None if heeds_null else self._meant(node)
        if meant is not None and self._union[meant].takes(node):
            return True
        return any(branch.takes(node, heeds_null=True) for branch in self._union)

    def _meant(self, node: YamlMap | YamlList) -> int | None:
        # Of lists all are judged alike; of a map its keys may tell.
        return branch_meant(self._schema, node) if isinstance(node, YamlMap) else self._meant_by_lists

    @cached_property
    def _meant_by_lists(self) -> int | None:
        fits = (branch._takes_list or "type" not in branch._schema for branch in self._union or ())
        return next((position for position, is_taken in enumerate(fits) if is_taken), None)

    def _takes_entries(self, node: YamlMap, heeds_null: bool) -> bool:
        entries = node.entries
        if self._required and not self._required <= entries.keys():
            return False
        for name, entry in entries.items():
            judge = self._keys.get(name) or self._other_key(name)
            if judge is None:
                return False
            value = entry.value
            if isinstance(value, YamlScalar) and value.value.__class__ in judge._certain:
                continue
            if not judge.takes(value, heeds_null=heeds_null) and (heeds_null or not is_null(value)):
                return False
        return True

    @cached_property
    def _keys(self) -> dict[str, Fit]:
        return {name: fit_of(mapping(part)) for name, part in self._known.items()}

    def _other_key(self, name: str) -> Fit | None:
        """Return what judges the value of a key that is not known; None where there may be no such key."""
        for pattern, part in self._patterns.items():
            if pattern.search(name):
                return fit_of(mapping(part))
        return self._others

    @cached_property
    def _others(self) -> Fit | None:
        return _fit(self._schema.get("additionalProperties", True))

    def _takes_items(self, node: YamlList, heeds_null: bool) -> bool:
        shortest, longest = self._bounds
        if not shortest <= len(node.items) <= longest or self._items is None:
            return False
        takes, certain = self._items.takes, self._items._certain
        return all(
            (isinstance(item, YamlScalar) and item.value.__class__ in certain) or takes(item, heeds_null=heeds_null)
            for item in node.items
        )

    @cached_property
    def _bounds(self) -> tuple[float, float]:
        shortest, longest = self._schema.get("minItems", 0), self._schema.get("maxItems", inf)
        assert isinstance(shortest, int)
        assert isinstance(longest, int | float)
        return shortest, longest

    @cached_property
    def _items(self) -> Fit | None:
        return _fit(self._schema.get("items", True))


def fit_of(schema: Schema) -> Fit:
    """Return the judge of a linked schema, always the same one; each is made when a tree first leads to it."""
    # The schemas are made once and stay, so their identity is theirs for ever.
    if id(schema) not in _FITS:
        _FITS[id(schema)] = Fit(schema)
    return _FITS[id(schema)]


_FITS: dict[int, Fit] = {}

_ANYTHING: Schema = {}


def _fit(schema: Json) -> Fit | None:
    """Return the judge of a schema that may be written as true or false; None for false."""
    if schema is False:
        return None
    return fit_of(_ANYTHING if schema is True else mapping(schema))


def _texts(said: Json) -> list[str]:
    return [str(one) for one in said] if isinstance(said, list) else [] if said is None else [str(said)]


def _words(listed: Json) -> list[str | None]:
    words = listed if isinstance(listed, list) else []
    if not all(word is None or isinstance(word, str) for word in words):
        raise ValueError(f"an enum of more than words is not judged: {words}")
    return [None if word is None else str(word) for word in words]
