"""What a schema takes and what a node is, in words: the parts of sentences about faults."""

from __future__ import annotations

import math
from collections.abc import Sequence

from linkforge_compile.schema.json_types import Schema, branches, mapping
from linkforge_compile.schema.repetition import LONG_FORM, RAW, WORDS
from linkforge_compile.syntax.entries import kind_of
from linkforge_compile.syntax.nodes import YamlFault, YamlList, YamlMap, YamlNode, YamlScalar
from linkforge_compile.syntax.scalars import scalar_value

COMMON_KEYS = frozenset({*WORDS, *RAW})
"""What stands in most objects, so no sentence about one of them lists it."""

_SHOWN_KEYS = 4
_SHOWN_TEXT = 40
_SHOWN_ITEMS = 6

_SCALAR_KINDS = {type(None): "null", str: "string", bool: "boolean", int: "number", float: "number"}


def alternatives(words: Sequence[str], last: str = "or") -> str:
    """Return "a", "a or b", "a, b or c"."""
    return f"{', '.join(words[:-1])} {last} {words[-1]}" if len(words) > 1 else words[0]


def branch_meant(schema: Schema, node: YamlNode) -> int | None:
    """Return which branch of a union a node is judged by: a map by the one of maps, a list by the one of lists.

    None where no branch takes its kind. Text is judged by all branches together, since a word, a quantity and an
    expression are all text: for others only.
    """
    return next((position for position, branch in enumerate(branches(schema)) if _takes(branch, node)), None)


def _takes(schema: Schema, node: YamlNode) -> bool:
    """Tell whether the schema, itself no union, takes this kind of node, whatever it says of what is within."""
    if schema.get("title") == LONG_FORM and isinstance(node, YamlMap) and not node.entries.keys() & set(WORDS):
        return False  # a map of other keys was never meant as one
    kinds = schema.get("type")
    return kinds is None or _kind(node) in (kinds if isinstance(kinds, list) else [kinds])


def _kind(node: YamlNode) -> str | None:
    """Return JSON Schema's word for what the node is, None for a fault."""
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
    """Return what the schema takes: "a number [kg] or a quantity such as '3 kg'", "'x', 'y' or three numbers".

    That any value may be an expression, and any item repeated, goes without saying.
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
    """Return the words of the enum that the schema is, or holds as a branch; in a patch, null goes without saying."""
    listed = [branch.get("enum") for branch in branches(schema)]
    return [str(word) for words in listed if isinstance(words, list) for word in words if word is not None]


def found(node: YamlNode) -> str:
    """Return what stands there: "a map", "a list", "3", "'three'", "the text '3'"."""
    match node:
        case YamlFault():
            raise TypeError("a fault is not judged")
        case YamlScalar(text=text, value=str()):
            return f"the text '{text}'" if is_number(text) else f"'{shortened(text)}'"
        case YamlScalar(text=text, value=value) if value is not None:
            return text
    return kind_of(node)


def shortened(text: str) -> str:
    """Return the text as it fits in a sentence: its first line, not too long."""
    line = text.partition("\n")[0]
    return line if line == text and len(line) <= _SHOWN_TEXT else f"{line[:_SHOWN_TEXT].rstrip()}…"


def shown(node: YamlNode) -> str:
    """Return a value as it may be written on one line, "…" for one that is too long for a sentence."""
    match node:
        case YamlScalar(text=text):
            written = text
        case YamlList(items=items) if len(items) <= _SHOWN_ITEMS:
            written = f"[{', '.join(map(shown, items))}]"
        case _:
            return "…"
    return "…" if len(written) > _SHOWN_TEXT or "\n" in written else written


def field(path: Sequence[str | int]) -> str:
    """Return the name of a place: "'xyz'", "item 2 of 'xyz'"."""
    name = next(key for key in reversed(path) if isinstance(key, str))
    return f"item {path[-1] + 1} of '{name}'" if isinstance(path[-1], int) else f"'{name}'"


def is_number(text: str) -> bool:
    """Whether the text is read as a number, and not as infinity, where it stands without quotes."""
    value = scalar_value(text)
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
