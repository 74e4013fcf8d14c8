"""What the schemas say of the shape of a tree: which objects it holds, which maps are keyed by names, which lists."""

from __future__ import annotations

import re
from collections.abc import Collection
from functools import cache
from typing import Final

from linkforge_compile.schema.json_types import Schema, branches, mapping
from linkforge_compile.schema.patches import POSITION
from linkforge_compile.schema.registry import linked
from linkforge_compile.schema.repetition import LONG_FORM, RAW, WORDS, XML, has_names, is_list, is_plain, is_short_form


class Shape:
    """What may stand at a place of the tree; a union is all of its branches at once.

    What the schema leaves to the author, free parts among it, has the shape FREE: no keys, no names, no items.
    """

    def __init__(self, schema: Schema) -> None:
        self.schema: Final = schema
        """What a value is judged by that stands here."""
        union = [] if is_plain(schema) else branches(schema)
        self._union = [part for part in union if part and not is_plain(part) and part.get("title") != LONG_FORM]
        self._names = next((part for part in self._union if has_names(part)), None)
        self._object = next((part for part in self._union if "properties" in part and not has_names(part)), None)
        self._list = next((part for part in self._union if is_list(part)), None)
        self._under: dict[str, Shape] = {}
        self.is_plain: Final = not self._union or any(part.get("additionalProperties") is True for part in self._union)
        """Whether all keys in it are the author's, `for` and `when` too."""
        self.is_free_part: Final = any(_is_free_part(part) for part in (schema, *branches(schema)))
        """Whether the author may write a part here that no field reads: nothing in it is a number to the compiler."""
        read_as = {kind for part in self._union if (kind := _read_as(part))}
        self.is_text: Final = "string" in read_as and "number" not in read_as
        """Whether a scalar that stands here is a name or other text, and no number."""
        self.is_xml: Final = any(part.get("title") == XML for part in self._union)
        """Whether raw XML may stand here."""
        self.has_names: Final = self._names is not None
        """Whether it may be a map keyed by names."""
        self.is_object: Final = self._object is not None and not self.has_names
        """Whether it may be an object whose keys the schema knows."""
        self.has_short_form: Final = self.is_object and any(map(is_short_form, self._union))
        """Whether a text or a list may stand in the place of the object: then an entry takes the long form as well."""
        self.may_repeat: Final = self.is_object and "for" in mapping((self._object or {}).get("properties", {}))
        """Whether it may be an object that takes `for`, since somewhere it is an entry or an item of a list."""

    @property
    def is_free(self) -> bool:
        """Whether the compiler knows no keys, names or items in it: it is one value, or plain."""
        return not (self.is_object or self.has_names or self._list)

    @property
    def keys(self) -> Collection[str]:
        """The keys of the object that it may be; none for what is no object whose keys the schema knows."""
        return mapping(self._object.get("properties", {})) if self._object else ()

    @property
    def title(self) -> str:
        """What the schema calls the object or the map: "a visual", "links by name"; empty for what is neither."""
        part = self._object or self._names
        return str(part["title"]) if part else ""

    @property
    def things(self) -> str:
        """What a map of names has: "links", "groups"."""
        return self.title.partition(" by name")[0]

    @property
    def word(self) -> str:
        """What the schema calls a scalar that may stand here: "a file name"; empty where none may."""
        scalars = (part for part in self._union if "object" not in str(part.get("type")))
        return next((str(part.get("title", "")) for part in scalars if "string" in str(part.get("type"))), "")

    @property
    def unit(self) -> str | None:
        """The SI unit of a bare number here, or of each in a list of them; None for none, or where that depends."""
        parts = (self.schema, *branches(self.schema))
        told = (
            str(each.get("patternErrorMessage")) for part in parts for each in (part, mapping(part.get("items", {})))
        )
        return next((found[1] for message in told if (found := _UNIT.search(message))), None)

    @property
    def item(self) -> Shape | None:
        """The shape of the items where it may be a list of things of their own, None where not."""
        return shape_of(mapping(self._list["items"])) if self._list else None

    def under(self, key: str) -> Shape:
        """Return the shape of what stands under a key or a name; FREE for a key that the schema does not know."""
        if self._names and not self.is_raw(key):
            return shape_of(mapping(self._names["additionalProperties"]))
        if key not in self._under:
            self._under[key] = self._find(key)
        return self._under[key]

    def is_raw(self, key: str) -> bool:
        """Whether a key says something raw in a map keyed by names, and is none."""
        return self._names is not None and key in RAW and key in mapping(self._names.get("properties", {}))

    def reserves(self, key: str) -> bool:
        """Whether a key in a map keyed by names is kept for repetition, and none can have it as a name."""
        return self._names is not None and key in WORDS and key not in mapping(self._names.get("properties", {}))

    def _find(self, key: str) -> Shape:
        keys = mapping((self._object or self._names or {}).get("properties", {}))
        if key in keys and key not in WORDS:
            return shape_of(mapping(keys[key]))
        for part in self._union:
            positions = mapping(part.get("patternProperties", {})).get(POSITION)
            if isinstance(positions, dict) and re.match(POSITION, key):
                return shape_of(positions)
        return FREE


_UNIT = re.compile(r"number \[(\S+)\]")
"""Where a schema's message says the unit of a number, if there is but one: "[kg]", not "[rad or m]"."""

_EXPRESSION = r"\$\("
"""The pattern of what is nothing but an expression."""


def _is_free_part(schema: Schema) -> bool:
    values = schema.get("additionalProperties")
    return is_plain(schema) or (isinstance(values, dict) and is_plain(values))


def _read_as(schema: Schema) -> str | None:
    """Return what a scalar is read as: the kind that its schema names first; None where none but expressions may."""
    kinds = schema.get("type")
    first = kinds[0] if isinstance(kinds, list) else kinds
    is_expression = first == "string" and schema.get("pattern") == _EXPRESSION
    return None if is_expression or first in ("object", "array") or first is None else str(first)


def shape_of(schema: Schema) -> Shape:
    """Return the shape that a linked schema describes, always the same one."""
    # The schemas are made once and stay, so their identity is theirs for ever.
    if id(schema) not in _SHAPES:
        _SHAPES[id(schema)] = Shape(schema)
    return _SHAPES[id(schema)]


_SHAPES: dict[int, Shape] = {}

FREE = Shape({})
"""The shape of what the compiler does not look into."""


@cache
def shapes() -> Shape:
    """Return the shape of a whole file."""
    return Shape(linked())
