"""Shapes of nodes by the schema, and how messages describe schemas and nodes."""

from __future__ import annotations

import math
import re
from collections.abc import Collection, Sequence
from functools import cache
from typing import Final, NamedTuple, TypeAlias

from linkforge_compile.diagnostics.enumerations import alternatives
from linkforge_compile.schema.json_schema import (
    EXPRESSION,
    LONG_FORM,
    POSITION,
    RAW,
    WORDS,
    XML,
    LinkedSchema,
    Schema,
    branches,
    has_names,
    is_for_plugins,
    is_list,
    is_plain,
    is_short_form,
    linked_part,
    mapping,
)
from linkforge_compile.schema.registry import linked
from linkforge_compile.syntax.entries import kind_of
from linkforge_compile.syntax.nodes import YamlFault, YamlList, YamlMap, YamlNode, YamlScalar, scalar_value


class Shape:
    """What a node may be at one place of the tree; for a union, all of its branches at once.

    Nodes of the author's own have the shape FREE: no known keys, names or items.
    """

    def __init__(self, schema: LinkedSchema) -> None:
        self.schema: Final = schema
        """The schema that a node here is validated by."""
        union = [] if is_plain(schema) else branches(schema)
        self._union = [part for part in union if part and not is_plain(part) and part.get("title") != LONG_FORM]
        self._names = next((part for part in self._union if has_names(part)), None)
        self._object = next((part for part in self._union if "properties" in part and not has_names(part)), None)
        self._list = next((part for part in self._union if is_list(part)), None)
        self._under: dict[str, Shape] = {}
        self.is_plain: Final = not self._union or any(part.get("additionalProperties") is True for part in self._union)
        """Whether all keys are the author's own, even `for` and `when`."""
        self.is_for_plugins: Final = any(map(is_for_plugins, (schema, *branches(schema))))
        """Whether `for` and `when` are the author's own keys only with values that they could not have elsewhere."""
        self.has_elements: Final = self.is_for_plugins and schema.get("additionalProperties") is True
        """Whether its entries are elements, so that a list repeats a tag."""
        has_texts = self.is_for_plugins and isinstance(schema.get("additionalProperties"), dict)
        self.own_words: Final = frozenset[str]() if has_texts else frozenset({"when"})
        """The words of repetition that the value of a field can have; among texts by name they are names."""
        self.is_free_part: Final = any(_is_free_part(part) for part in (schema, *branches(schema)))
        """Whether it may be data of the author's own, in which the compiler reads no numbers."""
        read_as = {kind for part in self._union if (kind := _read_as(part))}
        self.is_text: Final = "string" in read_as and "number" not in read_as
        """Whether a scalar here is a name or other text, not a number."""
        self.is_xml: Final = any(part.get("title") == XML for part in self._union)
        """Whether it may be raw XML."""
        self.has_names: Final = self._names is not None
        """Whether it may be a map keyed by names."""
        self.is_object: Final = self._object is not None and not self.has_names
        """Whether it may be an object whose keys the schema knows."""
        self.has_short_form: Final = self.is_object and any(map(is_short_form, self._union))
        """Whether it may be a text or a list instead of an object; then an entry may have the long form as well."""
        self.may_repeat: Final = self.is_object and "for" in mapping((self._object or {}).get("properties", {}))
        """Whether it may be an object with `for`, because it is an entry or an item of a list."""

    @property
    def is_free(self) -> bool:
        """Whether it has no known keys, names or items."""
        return not (self.is_object or self.has_names or self._list)

    @property
    def keys(self) -> Collection[str]:
        """The known keys of the object that it may be."""
        return mapping(self._object.get("properties", {})) if self._object else ()

    @property
    def title(self) -> str:
        """The schema's title of the object or map: "a visual", "links by name"; "" for neither."""
        part = self._object or self._names
        return str(part["title"]) if part else ""

    @property
    def things(self) -> str:
        """What a map of names holds: "links", "groups"."""
        return self.title.partition(" by name")[0]

    @property
    def word(self) -> str:
        """The schema's title of a scalar: "a file name"; "" if it may not be one."""
        scalars = (part for part in self._union if "object" not in str(part.get("type")))
        return next((str(part.get("title", "")) for part in scalars if "string" in str(part.get("type"))), "")

    @property
    def unit(self) -> str | None:
        """The SI unit of a bare number, or of each in a list; None if there is none or it depends on other fields."""
        parts = (self.schema, *branches(self.schema))
        messages = (
            str(each.get("patternErrorMessage")) for part in parts for each in (part, mapping(part.get("items", {})))
        )
        return next((found[1] for message in messages if (found := _UNIT.search(message))), None)

    @property
    def item(self) -> Shape | None:
        """The shape of the items if it may be a list of any length, else None."""
        return shape_of(linked_part(self._list["items"])) if self._list else None

    def under(self, key: str) -> Shape:
        """Return the shape of the value of a key or a name; FREE for an unknown key."""
        if self._names and not self.is_raw(key):
            return shape_of(linked_part(self._names["additionalProperties"]))
        if key not in self._under:
            self._under[key] = self._find(key)
        return self._under[key]

    def is_raw(self, key: str) -> bool:
        """Whether a key of a map keyed by names is no name but one of RAW."""
        return self._names is not None and key in RAW and key in mapping(self._names.get("properties", {}))

    def reserves(self, key: str) -> bool:
        """Whether a key of a map keyed by names is reserved for repetition and cannot be a name."""
        return self._names is not None and key in WORDS and key not in mapping(self._names.get("properties", {}))

    def _find(self, key: str) -> Shape:
        keys = mapping((self._object or self._names or {}).get("properties", {}))
        if key in keys and key not in WORDS:
            return shape_of(linked_part(keys[key]))
        for part in self._union:
            positions = mapping(part.get("patternProperties", {})).get(POSITION)
            if positions is not None and re.match(POSITION, key):
                return shape_of(linked_part(positions))
            others = part.get("additionalProperties")
            if isinstance(others, dict) and is_for_plugins(others):
                return shape_of(linked_part(others))
        return self if self.is_for_plugins else FREE


_UNIT = re.compile(r"number \[(\S+)\]")
"""The unit of a number in a schema's message, if there is only one: "[kg]", not "[rad or m]"."""


def _is_free_part(schema: Schema) -> bool:
    values = schema.get("additionalProperties")
    return is_plain(schema) or (isinstance(values, dict) and is_plain(values))


def _read_as(schema: Schema) -> str | None:
    """Return the first kind of scalar that a schema names; None if it allows only expressions."""
    kinds = schema.get("type")
    first = kinds[0] if isinstance(kinds, list) else kinds
    is_expression = first == "string" and schema.get("pattern") == EXPRESSION
    return None if is_expression or first in ("object", "array") or first is None else str(first)


@cache
def shape_of(schema: LinkedSchema) -> Shape:
    """Return the shape that a part of the linked schema describes, always the same object."""
    return Shape(schema)


FREE = Shape(LinkedSchema({}))
"""The shape of a node that the compiler does not look into."""


@cache
def shapes() -> Shape:
    """Return the shape of a whole file."""
    return Shape(linked())


Path: TypeAlias = tuple[str | int, ...]


class SchemaMismatch(NamedTuple):
    """A node, the path to it in its file, and the schema that it does not match."""

    node: YamlNode
    path: Path
    schema: Schema
    file: YamlMap

    @property
    def field(self) -> str | int:
        """The key or index of the node; "" for the whole file."""
        return self.path[-1] if self.path else ""

    @property
    def shape(self) -> Shape:
        """The shape that the schema describes."""
        return shape_of(linked_part(self.schema))

    @property
    def titles(self) -> set[str]:
        """The titles of the schema's branches."""
        return {str(branch.get("title")) for branch in branches(self.schema)}

    def accepts_kind(self, kind: str) -> bool:
        """Whether the schema accepts nodes of a JSON type."""
        return any(kind in str(branch.get("type")) for branch in branches(self.schema))


COMMON_KEYS = frozenset({*WORDS, *RAW})
"""Keys that most objects have, so that messages do not list them."""

_SHOWN_KEYS = 4
_SHOWN_TEXT = 40
_SHOWN_ITEMS = 6

_SCALAR_KINDS = {type(None): "null", str: "string", bool: "boolean", int: "number", float: "number"}


def find_branch(schema: Schema, node: YamlNode) -> int | None:
    """Return the index of the first branch of a union that accepts the kind of a node, None if none does.

    Not for text, which may match several branches: words, quantities and expressions are all text.
    """
    return next((position for position, branch in enumerate(branches(schema)) if _accepts_kind_of(branch, node)), None)


def _accepts_kind_of(schema: Schema, node: YamlNode) -> bool:
    """Whether a schema that is no union accepts the kind of a node, whatever the node contains."""
    if schema.get("title") == LONG_FORM and isinstance(node, YamlMap) and not node.entries.keys() & set(WORDS):
        return False  # a map without these keys is not intended as the long form
    kinds = schema.get("type")
    return kinds is None or _kind(node) in (kinds if isinstance(kinds, list) else [kinds])


def _kind(node: YamlNode) -> str | None:
    """Return the JSON type of a node, None for a fault."""
    match node:
        case YamlMap():
            return "object"
        case YamlList():
            return "array"
        case YamlScalar(value=value):
            return _SCALAR_KINDS.get(type(value))
        case _:
            return None


def expected(schema: Schema) -> str:
    """Return what the schema accepts: "a number [kg] or a quantity such as '3 kg'", "'x', 'y' or three numbers".

    Expressions and repetition are not mentioned, because any value may be one.
    """
    if "anyOf" in schema:
        return alternatives([word for branch in branches(schema) for word in _nouns(branch)])
    sentence = schema.get("patternErrorMessage")
    return str(sentence).removeprefix("expected ") if sentence else alternatives(_nouns(schema))


def _nouns(schema: Schema) -> list[str]:
    if "enum" in schema:
        return [f"'{word}'" for word in words_of(schema)]
    if schema.get("title") in {"an expression", LONG_FORM}:
        return []
    keys = [key for key in mapping(schema.get("properties", {})) if key not in COMMON_KEYS]
    return [f"a map ({', '.join(keys)})"] if 0 < len(keys) <= _SHOWN_KEYS else [str(schema["title"])]


def words_of(schema: Schema) -> list[str]:
    """Return the words of the enums of a schema and its branches, without the null of patches."""
    listed = [branch.get("enum") for branch in branches(schema)]
    return [str(word) for words in listed if isinstance(words, list) for word in words if word is not None]


def found(node: YamlNode) -> str:
    """Return what a node is: "a map", "a list", "3", "'three'", "the text '3'"."""
    match node:
        case YamlFault():
            raise TypeError("a fault has been reported already")
        case YamlScalar(text=text, value=str()):
            return f"the text '{text}'" if is_number(text) else f"'{shortened(text)}'"
        case YamlScalar(text=text, value=value) if value is not None:
            return text
    return kind_of(node)


def shortened(text: str) -> str:
    """Return the first line of a text, shortened to fit into a message."""
    line = text.partition("\n")[0]
    return line if line == text and len(line) <= _SHOWN_TEXT else f"{line[:_SHOWN_TEXT].rstrip()}…"


def shown(node: YamlNode) -> str:
    """Return a value as it may be written on one line, "…" if it is too long for a message."""
    match node:
        case YamlScalar(text=text):
            written = text
        case YamlList(items=items) if len(items) <= _SHOWN_ITEMS:
            written = f"[{', '.join(map(shown, items))}]"
        case _:
            return "…"
    return "…" if len(written) > _SHOWN_TEXT or "\n" in written else written


def field(path: Sequence[str | int]) -> str:
    """Return the name of the field at a path: "'xyz'", "item 2 of 'xyz'"."""
    name = next(key for key in reversed(path) if isinstance(key, str))
    return f"item {path[-1] + 1} of '{name}'" if isinstance(path[-1], int) else f"'{name}'"


def is_number(text: str) -> bool:
    """Whether a text without quotes is a finite number."""
    value = scalar_value(text)
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def split_path(key: str) -> Sequence[str]:
    """Return the keys of a path written as one key, `limits/effort`; the key itself if it is none."""
    return re.split(r"[/.]", key)


def nested(keys: Sequence[str], value: str) -> str:
    """Return a value under a path of keys on one line: `limits: {effort: 20}`."""
    first, *steps = keys
    inside = "".join(f"{{{step}: " for step in steps)
    return f"{first}: {inside}{value}{'}' * len(steps)}"


def is_text(node: YamlNode) -> bool:
    """Whether a node is a scalar whose value is text."""
    return isinstance(node, YamlScalar) and isinstance(node.value, str)


def node_at(tree: YamlNode, path: Path) -> YamlNode | None:
    """Return the node at a path, None if there is none."""
    node: YamlNode | None = tree
    for key in path:
        node = node.child(key) if node else None
    return node


def shape_at(path: Path) -> Shape:
    """Return the shape of what is at a path of a file."""
    shape = shapes()
    for key in path:
        shape = shape.under(key) if isinstance(key, str) else shape.item or FREE
    return shape
