"""Describe in words what a schema accepts and what a node is."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence

from linkforge_compile.schema.json_types import Schema, branches, mapping
from linkforge_compile.schema.repetition import LONG_FORM, RAW, WORDS
from linkforge_compile.syntax.entries import kind_of
from linkforge_compile.syntax.nodes import YamlFault, YamlList, YamlMap, YamlNode, YamlScalar
from linkforge_compile.syntax.scalars import scalar_value

COMMON_KEYS = frozenset({*WORDS, *RAW})
"""Keys that most objects have, so that messages do not list them."""

_SHOWN_KEYS = 4
_SHOWN_TEXT = 40
_SHOWN_ITEMS = 6

_SCALAR_KINDS = {type(None): "null", str: "string", bool: "boolean", int: "number", float: "number"}


def alternatives(words: Sequence[str], last: str = "or") -> str:
    """Return "a", "a or b", "a, b or c"."""
    return f"{', '.join(words[:-1])} {last} {words[-1]}" if len(words) > 1 else words[0]


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
