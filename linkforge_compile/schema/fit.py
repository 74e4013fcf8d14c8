"""Says yes to a tree that is shaped as its schema says; whoever wants the reasons for a no asks jsonschema.

Most files are right, and to say so takes a fiftieth of the time of looking for all that is wrong.
"""

from __future__ import annotations

import re
from typing import Final

from linkforge_compile.schema.json_types import Json, Schema, branches, mapping
from linkforge_compile.schema.words import branch_meant
from linkforge_compile.syntax.nodes import (
    ScalarValue,
    YamlEntry,
    YamlFault,
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
        self._union = [fit_of(branch) for branch in branches(schema)] if "anyOf" in schema else None
        self._required = _texts(schema.get("required"))
        self._known = mapping(schema.get("properties", {}))
        self._patterns = {re.compile(text): part for text, part in mapping(schema.get("patternProperties", {})).items()}
        if any(pattern.search(name) for pattern in self._patterns for name in self._known):
            raise ValueError(f"a schema judges a key of '{schema.get('title')}' twice")

    def takes(self, node: YamlNode, *, heeds_null: bool = False) -> bool:
        """Whether a node, with all that is in it, is shaped as the schema says.

        `heeds_null` is whether a field without a value is judged, as jsonschema does, and not passed over, as the
        language does.
        """
        match node:
            case YamlScalar(value=value):
                return self._takes_value(value)
            case YamlMap():
                return self._takes_map and self._takes_union(node, heeds_null) and self._takes_entries(node, heeds_null)
            case YamlList():
                return self._takes_list and self._takes_union(node, heeds_null) and self._takes_items(node, heeds_null)
            case YamlFault():
                return False

    def _takes_value(self, value: ScalarValue) -> bool:
        if type(value) not in self._scalars:
            return False
        if self._pattern is not None and isinstance(value, str) and not self._pattern.search(value):
            return False
        if self._words is not None and value not in self._words:
            return False
        if "const" in self._schema and (isinstance(value, bool) or value != self._schema["const"]):
            return False
        return self._union is None or any(branch._takes_value(value) for branch in self._union)

    def _takes_union(self, node: YamlMap | YamlList, heeds_null: bool) -> bool:
        """Whether jsonschema finds a branch for the node, or would tell nothing of the one by which it is judged."""
        if self._union is None:
            return True
        meant = None if heeds_null else branch_meant(self._schema, node)
        if meant is not None and self._union[meant].takes(node):
            return True
        return any(branch.takes(node, heeds_null=True) for branch in self._union)

    def _takes_entries(self, node: YamlMap, heeds_null: bool) -> bool:
        return all(name in node.entries for name in self._required) and all(
            self._takes_entry(entry, heeds_null) for entry in node
        )

    def _takes_entry(self, entry: YamlEntry, heeds_null: bool) -> bool:
        judge = self._under(entry.name)
        if judge is None:
            return False
        return (not heeds_null and is_null(entry.value)) or judge.takes(entry.value, heeds_null=heeds_null)

    def _under(self, name: str) -> Fit | None:
        """Return what judges the value of a key; None where there may be no such key."""
        if name in self._known:
            return _fit(self._known[name])
        for pattern, part in self._patterns.items():
            if pattern.search(name):
                return _fit(part)
        return _fit(self._schema.get("additionalProperties", True))

    def _takes_items(self, node: YamlList, heeds_null: bool) -> bool:
        shortest, longest = self._schema.get("minItems", 0), self._schema.get("maxItems", len(node))
        assert isinstance(shortest, int)
        assert isinstance(longest, int)
        if not shortest <= len(node) <= longest:
            return False
        judge = _fit(self._schema.get("items", True))
        return judge is not None and all(judge.takes(item, heeds_null=heeds_null) for item in node)


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
