"""Turn an error of jsonschema into diagnostics, with a function for each keyword."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.diagnostics import Diagnostic
from linkforge_compile.diagnostics.codes.schema import (
    MISSING_NAME,
    MISSING_VERSION,
    OTHER_VERSION,
    UNKNOWN_KEY,
    UNKNOWN_WORD,
    WRONG_KIND,
    WRONG_LENGTH,
)
from linkforge_compile.diagnostics.codes.syntax import SPACE_AFTER_COLON, TAB_INDENTATION, XACRO_EXPRESSION
from linkforge_compile.diagnostics.suggest import nearest
from linkforge_compile.schema.json_types import Schema, linked_part, mapping
from linkforge_compile.schema.key_hints import find_like_space, group_unknown_keys
from linkforge_compile.schema.number_hints import is_row
from linkforge_compile.schema.shapes import Shape, shape_of, shapes
from linkforge_compile.schema.value_hints import Path, SchemaMismatch, value_hint, word_hint
from linkforge_compile.schema.words import (
    expected,
    field,
    find_branch,
    found,
    shortened,
    words_of,
)
from linkforge_compile.source.characters import code_point
from linkforge_compile.syntax.entries import STUCK
from linkforge_compile.syntax.nodes import YamlFault, YamlList, YamlMap, YamlNode, YamlScalar, is_null
from linkforge_compile.syntax.scalars import xacro_facts

if TYPE_CHECKING:
    from jsonschema.exceptions import ValidationError


_MOST_COMPARED = 100
"""How many unknown keys are compared with a missing key; a hostile file has a hundred thousand."""


class Finding(NamedTuple):
    """A diagnostic and the path of the node that it is about, which a YamlFault replaces.

    `also` are the paths of further nodes with the same fault. `wrong_kind` identifies the schema of a scalar of the
    wrong kind, else it is 0.
    """

    diagnostic: Diagnostic
    path: Path
    also: tuple[Path, ...] = ()
    wrong_kind: int = 0


def explain(error: ValidationError, tree: YamlMap) -> Iterator[Finding]:
    """Yield the findings of one error; none for an empty field and for what the reader has reported."""
    path = tuple(error.absolute_path)
    node = _node_at(tree, path)
    if isinstance(node, YamlFault) or (is_null(node) and not isinstance(path[-1], int)):
        return
    if nameless := _object_without_name(tree, path):
        yield nameless
        return
    mismatch = SchemaMismatch(node, path, mapping(error.schema), tree)
    branch = None if error.validator != "anyOf" or _is_text(node) else find_branch(mismatch.schema, node)
    if branch is not None:
        for inner in error.context or ():
            if inner.schema_path[0] == branch:
                yield from explain(inner, tree)
    elif isinstance(node, YamlScalar) and _lacks_space(node, mismatch.schema):
        yield Finding(SPACE_AFTER_COLON.at(node.span, text=node.text), path)
    elif isinstance(node, YamlScalar) and (facts := xacro_facts(node.text)):
        for one in facts:
            yield Finding(XACRO_EXPRESSION.at(node.span, text=one["text"], ours=one["ours"]), path)
    else:
        yield from _EXPLAIN[str(error.validator)](mismatch)


def _lacks_space(node: YamlScalar, schema: Schema) -> bool:
    """Whether a text is a key and its value without a space, in place of an object that has the key."""
    key, _, value = node.text.partition(":")
    shape = shape_of(linked_part(schema))
    is_stuck = STUCK.fullmatch(node.text) and node.text == node.span.text and not value.startswith("//")
    return bool(is_stuck) and (shape.has_names or key in shape.keys)


def _unknown_keys(mismatch: SchemaMismatch) -> Iterator[Finding]:
    node, path, schema, _ = mismatch
    for entries, hint, near in group_unknown_keys(node, schema) if isinstance(node, YamlMap) else ():
        first, *others = entries
        hinted = f"; {hint}" if hint else ""
        fault = UNKNOWN_KEY.at(first.key.span, name=first.name, owner=schema["title"], hint=hinted, near=near)
        if space_like := find_like_space(first):
            fault = TAB_INDENTATION.at(space_like, found=f"{code_point(space_like.text or '')}, which looks like one")
        yield Finding(fault, (*path, first.name), tuple((*path, other.name) for other in others))


def _missing_keys(mismatch: SchemaMismatch) -> Iterator[Finding]:
    """Report all missing keys; the error does not name its own, and the sink drops repeated diagnostics."""
    node, path, schema, _ = mismatch
    required = schema["required"]
    if not isinstance(node, YamlMap) or not isinstance(required, list):
        return
    first = next((entry.key.span for entry in node), node.span)
    known = mapping(schema["properties"])
    unknown = [entry for entry in node if entry.name not in known]
    for name in map(str, required):
        # A misspelt key, or one in a map that should not be there, is reported as unknown.
        is_reported = any(
            entry.value.child(name) or nearest(entry.name, known) == name for entry in unknown[:_MOST_COMPARED]
        )
        if node.get(name) is None and not is_reported:
            code = MISSING_VERSION if name == "linkforge" else MISSING_NAME
            yield Finding(code.at(first), (*path, name))


def _other_version(mismatch: SchemaMismatch) -> Iterator[Finding]:
    yield Finding(OTHER_VERSION.at(mismatch.node.span, found=found(mismatch.node)), mismatch.path)


def _wrong_word(mismatch: SchemaMismatch) -> Iterator[Finding]:
    """Report a text that is none of the words; the keyword `type` reports other values."""
    node, path, schema, _ = mismatch
    if isinstance(node, YamlScalar) and isinstance(node.value, str):
        words = words_of(schema)
        hint = word_hint(mismatch, words)
        facts = {"field": field(path), "expected": expected(schema), "name": shortened(node.text), "hint": hint}
        yield Finding(UNKNOWN_WORD.at(node.span, near=() if hint else words, notes=(), **facts), path)


def _wrong_kind(mismatch: SchemaMismatch) -> Iterator[Finding]:
    node, path, schema, _ = mismatch
    actual = f"{found(node)}{value_hint(mismatch)}"
    fault = WRONG_KIND.at(node.span, field=field(path), expected=expected(schema), found=actual)
    yield Finding(fault, path, wrong_kind=id(schema) if isinstance(node, YamlScalar) else 0)


def _no_branch(mismatch: SchemaMismatch) -> Iterator[Finding]:
    word = _is_text(mismatch.node) and not is_row(mismatch.node) and words_of(mismatch.schema)
    yield from (_wrong_word if word else _wrong_kind)(mismatch)


def _wrong_length(mismatch: SchemaMismatch) -> Iterator[Finding]:
    node, path, schema, _ = mismatch
    # A row of numbers without commas is reported at its item.
    if isinstance(node, YamlList) and not any(map(is_row, node)):
        actual = f"{len(node)}{value_hint(mismatch)}"
        yield Finding(WRONG_LENGTH.at(node.span, field=field(path), expected=expected(schema), found=actual), path)


def _object_without_name(tree: YamlMap, path: Path) -> Finding | None:
    """Report an object in place of a map of such objects by name, as the only error in it."""
    node, shape = tree, shapes()
    # A node that an expression made is not in a file.
    for length, key in enumerate(path if "linkforge" in tree.entries else ()):
        entry = shape.under(str(key))
        if shape.has_names and _is_single_object(node, entry):
            field, first = path[length - 1], next(iter(node))
            known = next(one for one in node if one.name in entry.keys)
            name = "NAME" if first is known else first.name
            actual = f"the keys of a single one; write '{field}: {{{name}: {{{known.name}: …}}}}'"
            where = known.key.span
            return Finding(WRONG_KIND.at(where, field=f"'{field}'", expected=shape.title, found=actual), path[:length])
        inner = node.child(key)
        if not isinstance(inner, YamlMap):
            return None
        node, shape = inner, entry
    return None


def _is_single_object(node: YamlMap, shape: Shape) -> bool:
    """Whether a map has only keys of an object, apart from a first one without a value that may be its name."""
    first = next(iter(node), None)
    # The keys first: `all` stops early for a map with a hundred thousand names.
    has_keys = all(entry.name in shape.keys or (entry is first and is_null(entry.value)) for entry in node)
    return has_keys and not all(is_null(entry.value) or isinstance(entry.value, YamlMap) for entry in node)


_EXPLAIN: dict[str, Callable[[SchemaMismatch], Iterator[Finding]]] = {
    "additionalProperties": _unknown_keys,
    "required": _missing_keys,
    "const": _other_version,
    "enum": _wrong_word,
    "anyOf": _no_branch,
    "type": _wrong_kind,
    "pattern": _wrong_kind,
    "minItems": _wrong_length,
    "maxItems": _wrong_length,
}


def _node_at(tree: YamlMap, path: Path) -> YamlNode:
    node: YamlNode | None = tree
    for key in path:
        node = node.child(key) if node else None
    if node is None:
        raise LookupError(f"no node at {path}")
    return node


def _is_text(node: YamlNode) -> bool:
    return isinstance(node, YamlScalar) and isinstance(node.value, str)
