"""Compute every expression and repetition of a tree: each becomes a node of its value, in the same place."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.diagnostics.codes.expressions import UNKNOWN_NAME
from linkforge_compile.diagnostics.codes.modules import COMPUTED_REPETITION
from linkforge_compile.diagnostics.suggest import nearest
from linkforge_compile.expand.evaluate import Evaluator, report_interpolated_number
from linkforge_compile.expand.repeat import occurrences, without_words
from linkforge_compile.expand.values import node_of, with_final_paths
from linkforge_compile.expressions import FAULT, Value
from linkforge_compile.schema import validate_computed
from linkforge_compile.schema.json_schema import WORDS
from linkforge_compile.schema.shapes import FREE, Shape
from linkforge_compile.syntax import YamlEntry, YamlFault, YamlList, YamlMap, YamlNode, YamlScalar, has_expression
from linkforge_compile.syntax.nodes import to_fault


def expand_node(
    node: YamlNode, evaluator: Evaluator, shape: Shape = FREE, *, key: str = "", is_free: bool = False
) -> YamlNode:
    """Return the tree with all expressions and repetitions computed; a tree without any is returned as it is.

    Faulty parts become YamlFaults; an entry with a faulty key keeps it as written. `shape` says where `for` and
    `when` are more than keys, and with `key` what a computed value may be. `is_free` if nothing here is read as a
    number.
    """
    if not evaluator.expressions.is_computed(node):
        return node
    is_free = is_free or shape.is_free_part
    match node:
        case YamlScalar():
            return _validated(_expand_scalar(node, evaluator, shape, is_free), key, shape, evaluator.sink)
        case YamlList():
            item_shape = shape.item or (shape if shape.is_object else FREE)
            items = (
                expand_node(copy, inner, item_shape, key=key, is_free=is_free)
                for item in node
                for inner, copy in occurrences(item, item_shape, evaluator, is_item=True)
            )
            return YamlList(tuple(items), node.span)
        case YamlMap():
            entries: dict[str, YamlEntry] = {}
            for inner, entry in expand_entries(node, evaluator, shape):
                _add_entry(entries, entry, inner, shape, is_free)
            return YamlMap(entries, node.span)
    return node


def expand_part(node: YamlNode, evaluator: Evaluator, shape: Shape, key: str) -> YamlNode | None:
    """Return the computed value of a key of an object, None if its `when` removes it."""
    found = occurrences(node, shape, evaluator)
    return next((expand_node(copy, inner, shape, key=key) for inner, copy in found), None)


def expand_entries(node: YamlMap, evaluator: Evaluator, shape: Shape) -> Iterator[tuple[Evaluator, YamlEntry]]:
    """Yield each entry of a map as often as it occurs, still as written, with the evaluator for it."""
    if shape.has_names and node.entries.keys() & WORDS:
        node, evaluator = without_words(node, shape, evaluator)
    for entry in node:
        value = entry.value
        if shape.has_names and has_expression(entry.name):
            inner = _with_missing_for(entry, evaluator, shape)
            if inner is not evaluator:
                yield inner, entry
                continue
        if not evaluator.expressions.is_computed(value):
            yield evaluator, entry
            continue
        value_shape = shape.under(entry.name)
        if not shape.has_names and value_shape.may_repeat and isinstance(value, YamlMap) and "for" in value.entries:
            # A single object with `for` is an item of the list that may be written in its place.
            yield evaluator, YamlEntry(entry.key, YamlList((value,), value.span))
            continue
        key = entry.key if shape.has_names else None
        for inner, copy in occurrences(value, value_shape, evaluator, key=key):
            yield inner, entry if copy is value else YamlEntry(entry.key, copy)


def _with_missing_for(entry: YamlEntry, evaluator: Evaluator, shape: Shape) -> Evaluator:
    """Return the evaluator for an entry; if its key uses unknown names, report the missing `for` once.

    In the returned evaluator these names are faults, because the same `for` is missing wherever else they are used.
    """
    if isinstance(entry.value, YamlFault) or (isinstance(entry.value, YamlMap) and "for" in entry.value.entries):
        return evaluator
    unknown = sorted(name for name in evaluator.names_in(entry.key) if name not in evaluator.scope)
    if not unknown or any(nearest(name, evaluator.scope) for name in unknown):
        return evaluator
    if not _has_misspelled_for(entry.value):
        example = f"for: {{{', '.join(f'{name}: …' for name in unknown)}}}"
        hint = f"; to repeat {shape.things}, write '{example}' in the entry"
        evaluator.sink.report(UNKNOWN_NAME.at(entry.key.span, name=unknown[0], hint=hint))
    return evaluator.with_faults(dict.fromkeys(unknown))


def _has_misspelled_for(node: YamlNode) -> bool:
    """Whether an entry has a key such as `fro`, which was reported."""
    entries = node.entries if isinstance(node, YamlMap) else {}
    return any(isinstance(entry.value, YamlFault) and nearest(name, ("for",)) for name, entry in entries.items())


def _add_entry(
    entries: dict[str, YamlEntry], entry: YamlEntry, evaluator: Evaluator, around: Shape, is_free: bool
) -> None:
    """Compute an entry and add it; the second of two with the same key is reported."""
    # A faulty entry keeps its key as written, since its names may be those of the faulty `for`.
    key = entry.key if isinstance(entry.value, YamlFault) else evaluator.key(entry.key)
    if key is None or isinstance(entry.value, YamlFault):
        entries.setdefault(entry.name, YamlEntry(entry.key, to_fault(entry.value)))
    elif key.text in entries:
        evaluator.report_same_key(key, entries[key.text])
    else:
        value: YamlNode = entry.value
        if evaluator.expressions.is_computed(value):
            value = expand_node(value, evaluator, around.under(entry.name), key=key.text, is_free=is_free)
        is_unchanged = key is entry.key and value is entry.value
        entries[key.text] = entry if is_unchanged else YamlEntry(key, value)


def _expand_scalar(scalar: YamlScalar, evaluator: Evaluator, shape: Shape, is_free: bool) -> YamlNode:
    value = evaluator.scalar(scalar, is_xml=shape.is_xml)
    if value is FAULT:
        return YamlFault(scalar.span)
    expressions, names = evaluator.expressions, evaluator.scope_of(scalar)
    is_text = is_free or shape.is_text
    if not is_text and report_interpolated_number(scalar, value, expressions, names, evaluator.sink):
        return YamlFault(scalar.span)
    if not expressions.charge_value(value, scalar.span, evaluator.sink):
        return YamlFault(scalar.span)
    return node_of(_with_final_paths(value, shape, is_free), evaluator.place(scalar))


def _with_final_paths(value: Value, shape: Shape, is_free: bool) -> Value:
    """Return a value whose paths in free parts are as the compiled file would write them; no later stage sees them."""
    if is_free or shape.is_free_part or shape.is_xml:
        return with_final_paths(value)
    match value:
        case Mapping():
            return {name: _with_final_paths(item, shape.under(name), is_free) for name, item in value.items()}
        case tuple() if shape.item:
            item_shape = shape.item
            return tuple(_with_final_paths(item, item_shape, is_free) for item in value)
    return value


def _validated(node: YamlNode, key: str, shape: Shape, sink: Diagnostics) -> YamlNode:
    """Return a computed list or map without what the schema forbids there; scalars are checked by their readers."""
    if not isinstance(node, YamlMap | YamlList) or not shape.schema or shape.is_free_part:
        return node
    word = next(_computed_words(node, shape), None)
    if word:
        sink.report(COMPUTED_REPETITION.at(node.span, name=word))
        return YamlFault(node.span)
    return validate_computed(node, key, shape, sink)


def _computed_words(node: YamlNode, shape: Shape) -> Iterator[str]:
    """Yield each computed `for` and `when` that would repeat something had it been written out."""
    match node:
        case YamlList():
            for item in node:
                yield from _computed_words(item, shape.item or (shape if shape.is_object else FREE))
        case YamlMap() if not shape.is_plain:
            for entry in node:
                if entry.name in ("for", "when") and not shape.has_names:
                    yield entry.name
                yield from _computed_words(entry.value, shape.under(entry.name))
