"""Shapes of nodes by the schema: objects with known keys, maps keyed by names, lists and scalars."""

from __future__ import annotations

import re
from collections.abc import Collection
from functools import cache
from typing import Final

from linkforge_compile.schema.json_types import LinkedSchema, Schema, branches, linked_part, mapping
from linkforge_compile.schema.patches import POSITION
from linkforge_compile.schema.registry import linked
from linkforge_compile.schema.repetition import LONG_FORM, RAW, WORDS, XML, has_names, is_list, is_plain, is_short_form


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
        return FREE


_UNIT = re.compile(r"number \[(\S+)\]")
"""The unit of a number in a schema's message, if there is only one: "[kg]", not "[rad or m]"."""

_EXPRESSION = r"\$\("
"""The pattern of a text that must be an expression."""


def _is_free_part(schema: Schema) -> bool:
    values = schema.get("additionalProperties")
    return is_plain(schema) or (isinstance(values, dict) and is_plain(values))


def _read_as(schema: Schema) -> str | None:
    """Return the first kind of scalar that a schema names; None if it allows only expressions."""
    kinds = schema.get("type")
    first = kinds[0] if isinstance(kinds, list) else kinds
    is_expression = first == "string" and schema.get("pattern") == _EXPRESSION
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
