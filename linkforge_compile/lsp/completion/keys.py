"""Complete keys: those of the language, names as keys, and new entries."""

from __future__ import annotations

import re
from collections.abc import Iterator

from linkforge_compile.editor.keys_by_type import keys_by_type
from linkforge_compile.lsp.completion.arguments import has_arguments
from linkforge_compile.lsp.completion.context import Context
from linkforge_compile.lsp.completion.items import (
    COMMON,
    KNOWN,
    LIKELY,
    REQUIRED,
    Kind,
    Offer,
    documented,
    expected_of,
    unique,
)
from linkforge_compile.lsp.completion.names import keys_that_name, written
from linkforge_compile.lsp.completion.snippets import entries_in_flow, escaped, in_block
from linkforge_compile.schema.descriptions import Described
from linkforge_compile.schema.json_schema import RAW, WORDS, Schema, is_list, mapping


def offer_keys(context: Context) -> list[Offer]:
    """Return the keys that the map at the position may have and does not have yet."""
    known = {*context.around, *context.cursor.siblings}
    offers = [offer for branch in context.branches for offer in _keys_of(branch, context)]
    offers += [_name(name, kind, context) for name, kind in keys_that_name(context)]
    new = unique(offer for offer in offers if offer.label not in known)
    # The example of an argument is none of this module.
    if context.after_word.lstrip().startswith(":") or has_arguments(context.cursor.path):
        return [*new]
    return [*new, *_snippets(context, is_empty=not known)]


def _keys_of(branch: Described, context: Context) -> Iterator[Offer]:
    useless = _useless(branch, context)
    for key, schema in branch.keys.items():
        if key not in useless:
            inner = branch.describe(schema)
            rank, text = _rank(key, inner, context), key_text(key, inner, context)
            offer = Offer(key, text, Kind.Property, rank, expected_of(inner), is_snippet=True)
            yield documented(offer, _whole(schema, inner))


def _whole(schema: Schema, inner: tuple[Described, ...]) -> Schema:
    """Return the schema of a property with the descriptions that it shares with its branches."""
    first = inner[0].schema if inner else {}
    words = [word for one in inner for word in _words(one.schema)]
    return {**first, **schema, **({"enum": [*words]} if words else {})}


def _words(schema: Schema) -> list[str]:
    words = schema.get("enum")
    return [str(word) for word in words if word is not None] if isinstance(words, list) else []


def _useless(branch: Described, context: Context) -> frozenset[str]:
    """Return the keys for which an object of its type has no use."""
    type_ = context.text_around.get("type")
    listed = keys_by_type().get(branch.definition, {})
    return frozenset(key for types, keys in listed.items() if type_ in types for key in keys)


def _rank(key: str, inner: tuple[Described, ...], context: Context) -> int:
    if key in {*WORDS, *RAW}:
        return COMMON
    type_ = context.text_around.get("type", "")
    return REQUIRED if any(_is_required(one.schema, type_) for one in inner) else LIKELY


def _is_required(schema: Schema, type_: str) -> bool:
    """Whether a key is required, be it in an object of a type only."""
    found = _REQUIRED.search(str(schema.get("description", "")))
    return found is not None and (found["types"] is None or type_ in found["types"].split())


_REQUIRED = re.compile(r"Required(?: for (?P<types>[^.]*))?\.$")


def _name(name: str, kind: str, context: Context) -> Offer:
    inner = tuple(part for branch in context.branches for part in branch.at(name))
    key = written(name, context)
    return Offer(name, key_text(key, inner, context), Kind.Reference, REQUIRED, kind, is_snippet=True)


def key_text(key: str, inner: tuple[Described, ...], context: Context) -> str:
    """Return a key as a snippet, with what begins its value; only the key where a `:` follows."""
    if context.after_word.lstrip().startswith(":"):
        return escaped(key)
    quote = context.before_word[-1:] if context.is_quoted and not context.after_word.startswith(("'", '"')) else ""
    key = escaped(key) + quote
    is_map = any("object" in one.kinds for one in inner) and not any(map(_is_short, inner))
    if context.is_flow:
        return _before_next(f"{key}: {{$0}}" if is_map else f"{key}: $0", context)
    if context.is_quoted or not context.cursor.is_own_line:
        return f"{key}: $0"
    return _before_next(_in_block(key, inner, context, is_map=is_map), context)


def _before_next(text: str, context: Context) -> str:
    """Return a key with what separates it from the next one."""
    indent = " " * (context.word.column - 1)
    return text + (", " if context.is_flow else f"\n{indent}") if context.precedes_key else text


def _in_block(key: str, inner: tuple[Described, ...], context: Context, *, is_map: bool) -> str:
    inside = " " * (context.word.column + 1)
    if is_map:
        return f"{key}:\n{inside}$0"
    is_list_of_maps = any(is_list(one.schema) and _has_maps(one) for one in inner)
    return f"{key}:\n{inside}- $0" if is_list_of_maps and not any(map(_is_short, inner)) else f"{key}: $0"


def _is_short(branch: Described) -> bool:
    """Whether a branch is a value that is written after the key."""
    if branch.is_free and "object" not in branch.kinds:
        return True
    if "array" in branch.kinds:
        return not _has_maps(branch)
    return "object" not in branch.kinds and branch.schema.get("title") != "an expression"


def _has_maps(branch: Described) -> bool:
    return any("object" in item.kinds and item.keys.keys() - {*WORDS} for item in branch.at(0))


def _snippets(context: Context, *, is_empty: bool) -> Iterator[Offer]:
    """Yield the snippets of a new entry, and of an empty object as a whole."""
    indent = context.word.column - 1
    for branch in context.branches:
        listed = branch.schema.get("defaultSnippets")
        for snippet in map(mapping, listed) if isinstance(listed, list) else ():
            body = snippet["body"]
            if not isinstance(body, dict) or not (branch.has_names or branch.is_free or is_empty):
                continue
            text = in_block(body, indent) if context.cursor.is_own_line else entries_in_flow(body)
            label, description = str(snippet["label"]), str(snippet["description"])
            rank = KNOWN if branch.has_names else LIKELY
            yield Offer(label, _before_next(text, context), Kind.Snippet, rank, description, is_snippet=True)
