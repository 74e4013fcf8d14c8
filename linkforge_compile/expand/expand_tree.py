"""Compute every expression of a tree, and apply `for` and `when`: each node occurs as often as they say."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from linkforge_compile.diagnostics import Note
from linkforge_compile.diagnostics.codes.expressions import TRUTH_AS_TEXT, UNKNOWN_NAME
from linkforge_compile.diagnostics.codes.modules import (
    CONDITION_KIND,
    FOR_KIND,
    FOR_NAME_TAKEN,
    INVALID_VARIABLE_NAME,
    KEY_WITHOUT_NAME,
    RESERVED_KEY,
    RESERVED_NAME,
)
from linkforge_compile.diagnostics.suggest import nearest
from linkforge_compile.expand.evaluate import Evaluator, report_interpolated_number
from linkforge_compile.expand.values import Setting, describe, node_of, with_final_paths
from linkforge_compile.expressions import FAULT, RESERVED_NAMES, Fault, Value, as_one_expression
from linkforge_compile.limits import Limit
from linkforge_compile.schema import validate_computed
from linkforge_compile.schema.json_schema import WORDS
from linkforge_compile.schema.repetition_words import FOR_AND_WHEN, repetition_words, without_words
from linkforge_compile.schema.shapes import FREE, Shape
from linkforge_compile.source import Span
from linkforge_compile.source.provenance import Kind
from linkforge_compile.syntax import YamlEntry, YamlFault, YamlList, YamlMap, YamlNode, YamlScalar, has_expression
from linkforge_compile.syntax.nodes import YAML_1_1_BOOLEANS, to_fault

_NAMES_ITS_JOINT = frozenset({"a frame", "a module"})
"""The titles of entries that have a joint named after them, unless `joint` gives it a name."""


def expand_node(
    node: YamlNode,
    evaluator: Evaluator,
    shape: Shape = FREE,
    *,
    key: str = "",
    is_free: bool = False,
    is_entry: bool = False,
) -> YamlNode:
    """Return the tree with all expressions and repetitions computed; a tree without any is returned as it is.

    Faulty parts become YamlFaults; an entry with a faulty key keeps it as written. `shape` says where `for` and
    `when` are more than keys, and with `key` what a computed value may be. `is_free` if nothing here is read as a
    number; `is_entry` as for `repetition_words`.
    """
    if not evaluator.expressions.is_computed(node):
        return node
    is_free = is_free or shape.is_free_part
    match node:
        case YamlScalar():
            computed = _expand_scalar(node, evaluator, shape, is_free)
            return validate_computed(computed, key, shape, evaluator.sink, is_entry=is_entry)
        case YamlList():
            item_shape = shape.item or (shape if shape.is_object or shape.is_for_plugins else FREE)
            items = (
                expand_node(copy, inner, item_shape, key=key, is_free=is_free, is_entry=True)
                for item in node
                for inner, copy in _occurrences(item, item_shape, evaluator, is_item=True)
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
    found = _occurrences(node, shape, evaluator)
    return next((expand_node(copy, inner, shape, key=key) for inner, copy in found), None)


def expand_entries(node: YamlMap, evaluator: Evaluator, shape: Shape) -> Iterator[tuple[Evaluator, YamlEntry]]:
    """Yield each entry of a map as often as it occurs, still as written, with the evaluator for it."""
    if shape.has_names and node.entries.keys() & WORDS:
        node, evaluator = _without_misplaced_words(node, shape, evaluator)
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
        is_item = (
            not shape.has_names and value_shape.may_repeat and isinstance(value, YamlMap) and "for" in value.entries
        )
        if is_item or _repeats_tag(entry, shape, evaluator):
            # A single object with `for` is an item of the list that may be written in its place.
            yield evaluator, YamlEntry(entry.key, YamlList((value,), value.span))
            continue
        key = entry.key if shape.has_names or shape.is_for_plugins else None
        for inner, copy in _occurrences(value, value_shape, evaluator, key=key):
            yield inner, entry if copy is value else YamlEntry(entry.key, copy)


def _repeats_tag(entry: YamlEntry, around: Shape, evaluator: Evaluator) -> bool:
    """Whether an entry of what a plugin reads stands for a list: its `for` has no name that is in its key."""
    node = entry.value
    is_repeated = around.has_elements and "for" in repetition_words(node, around, is_entry=True)
    names = node.child("for") if is_repeated else None
    return isinstance(names, YamlMap) and evaluator.names_in(entry.key).isdisjoint(names.entries)


def _with_missing_for(entry: YamlEntry, evaluator: Evaluator, shape: Shape) -> Evaluator:
    """Return the evaluator for an entry; if its key uses unknown names, report the missing `for` once.

    In the returned evaluator these names are faults, because the same `for` is missing wherever else they are used.
    """
    fields = entry.value.entries if isinstance(entry.value, YamlMap) else {}
    if isinstance(entry.value, YamlFault) or "for" in fields:
        return evaluator
    unknown = sorted(name for name in evaluator.names_in(entry.key) if name not in evaluator.scope)
    if not unknown or any(nearest(name, evaluator.scope) for name in unknown):
        return evaluator
    # A key such as `fro` was reported.
    if not any(isinstance(field.value, YamlFault) and nearest(name, ("for",)) for name, field in fields.items()):
        example = f"for: {{{', '.join(f'{name}: …' for name in unknown)}}}"
        hint = f"; to repeat {shape.things}, write '{example}' in the entry"
        evaluator.sink.report(UNKNOWN_NAME.at(entry.key.span, name=unknown[0], hint=hint))
    return evaluator.with_faults(dict.fromkeys(unknown))


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
            shape, is_entry = around.under(entry.name), around.has_names or around.is_for_plugins
            value = expand_node(value, evaluator, shape, key=key.text, is_free=is_free, is_entry=is_entry)
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
    return node_of(with_final_paths(value, shape, is_free), evaluator.place(scalar), is_free)


def _occurrences(
    node: YamlNode, shape: Shape, evaluator: Evaluator, *, key: YamlScalar | None = None, is_item: bool = False
) -> Iterator[tuple[Evaluator, YamlNode]]:
    """Yield a node once for each combination of its `for` values for which `when` holds, without these two words.

    The evaluator that comes with it knows the `for` names.
    An entry of a map of names has a `key`, which must mention all `for` names. An entry or list item (`is_item`) that
    is not an object uses the long form. A faulty `for` or `when` is reported, and yields a YamlFault once.
    """
    words = repetition_words(node, shape, is_entry=key is not None or is_item)
    if not words or not isinstance(node, YamlMap):
        yield evaluator, node
        return
    body = without_words(node, words, shape, evaluator.sink)
    condition, names = (node.get(word) if word in words else None for word in ("when", "for"))
    if body is None or isinstance(condition, YamlFault) or isinstance(names, YamlFault):
        yield evaluator, YamlFault(node.span)
        return
    entry = _Entry(key, shape.title) if key and shape.is_object and not shape.has_short_form else None
    if not isinstance(names, YamlMap):
        yield from _occur_once(body, condition, entry, evaluator)
    elif _is_valid_for(names, key, evaluator):
        yield from _repeat(body, condition, names, entry, evaluator)
    else:
        yield evaluator, YamlFault(node.span)


def _without_misplaced_words(node: YamlMap, shape: Shape, evaluator: Evaluator) -> tuple[YamlMap, Evaluator]:
    """Return a map of names without misplaced words of repetition, which are reported, and its evaluator.

    The names of a misplaced `for` are faults to the evaluator, not unknown names.
    """
    entries = {name: entry for name, entry in node.entries.items() if name not in WORDS}
    example = next((name for name in entries if has_expression(name)), next(iter(entries), "…"))
    for word in (entry.key for entry in node if entry.name in WORDS):
        hint = f"; it goes inside the entry: '{example}: {{{word.text}: …}}'" if word.text in FOR_AND_WHEN else ""
        evaluator.sink.report(RESERVED_KEY.at(word.span, name=word.text, owner=shape.things, way_out=hint))
    names = node.get("for")
    return YamlMap(entries, node.span), evaluator.with_faults(names.entries if isinstance(names, YamlMap) else {})


class _Entry(NamedTuple):
    """The key of an entry with a name, and the title of its schema."""

    key: YamlScalar
    title: str


def _occur_once(
    body: YamlNode, condition: YamlNode | None, entry: _Entry | None, evaluator: Evaluator
) -> Iterator[tuple[Evaluator, YamlNode]]:
    holds = _holds(condition, evaluator)
    if isinstance(holds, Fault):
        yield evaluator, YamlFault(body.span)
    elif holds:
        yield evaluator, body
    elif entry and condition:
        _disable(entry, body, condition.span, evaluator.silent)


def _holds(condition: YamlNode | None, evaluator: Evaluator) -> bool | Fault:
    value = True if condition is None else evaluator.value(condition)
    if value is None or isinstance(value, bool | Fault):
        return True if value is None else value
    assert condition is not None, "without a condition, the value is True"
    place = evaluator.place(condition)
    if isinstance(value, str) and (truth := YAML_1_1_BOOLEANS.get(value.lower())):
        evaluator.sink.report(TRUTH_AS_TEXT.at(place, name=value, expected=truth))
        return FAULT
    text = condition.text if isinstance(condition, YamlScalar) else ""
    expression = as_one_expression(text, condition.span, evaluator.scope)
    remedy = f"; write '{expression}'" if expression else ""
    fault = CONDITION_KIND.at(place, found=f"{describe(value)}{remedy}")
    evaluator.sink.report(fault.replacing(text, expression, is_safe=True, is_whole=True) if expression else fault)
    return FAULT


def _repeat(
    body: YamlNode, condition: YamlNode | None, names: YamlMap, entry: _Entry | None, evaluator: Evaluator
) -> Iterator[tuple[Evaluator, YamlNode]]:
    """Yield an occurrence for each combination of the `for` values.

    A condition without `for` names is evaluated once, first; if it fails, the `for` is not, except to list the names
    of the disabled `entry`, None for what has no name.
    """
    if condition is not None and not evaluator.names_in(condition) & names.entries.keys():
        holds = _holds(condition, evaluator)
        if holds is False and entry:
            for inner in _rounds(names, evaluator.silent, YamlFault(body.span)) or ():
                _disable(entry, body, condition.span, inner)
        if holds is not True:
            yield from [(evaluator, YamlFault(body.span))] if holds is FAULT else []
            return
        condition = None
    rounds = _rounds(names, evaluator, body)
    if rounds is None:
        yield evaluator, YamlFault(body.span)
    for inner in rounds or ():
        yield from _occur_once(body, condition, entry, inner)


def _rounds(names: YamlMap, evaluator: Evaluator, body: YamlNode) -> list[Evaluator] | None:
    """Return an evaluator for each combination, the first name varying slowest; None after a reported error.

    The budget is charged for each copy of the `body` and for its names.
    """
    budget = evaluator.expressions.budget
    combinations: list[tuple[dict[str, Value], dict[str, Setting]]] = [({}, {})]
    for number, entry in enumerate(names, start=1):
        copied = body if number == len(names) else YamlFault(body.span)
        longer = []
        for values, settings in combinations:
            around = evaluator.inside(values, settings)
            items = _values(entry, around)
            if items is None:
                return None
            is_made = isinstance(items, range)
            for place, item in enumerate(items):
                budget.spend(Limit.ROUNDS, 1, entry.key.span)
                evaluator.expressions.charge_copy(copied, entry.key.span, number)
                setting = Setting(Kind.REPETITION, entry.value, around, path=(place,), is_made=is_made)
                longer.append(({**values, entry.name: item}, {**settings, entry.name: setting}))
        combinations = longer
    return [evaluator.inside(*combination) for combination in combinations]


def _values(entry: YamlEntry, evaluator: Evaluator) -> Sequence[Value] | None:
    """Return the values of a `for` name: the items of a list, or 0 to n - 1; None after a reported error."""
    value = evaluator.value(entry.value)
    match value:
        case Fault():
            return None
        case tuple():
            return value
        case int() | float() if not isinstance(value, bool) and value >= 0 and value == value // 1 < float("inf"):
            return range(int(value))
    evaluator.sink.report(FOR_KIND.at(evaluator.place(entry.value), name=entry.name, found=describe(value)))
    return None


def _is_valid_for(names: YamlMap, key: YamlScalar | None, evaluator: Evaluator) -> bool:
    """Whether expressions can use the `for` names, and a key uses all of them, so that no two copies have the same."""
    faults = []
    for entry in names:
        if not (entry.name.isascii() and entry.name.isidentifier()):
            faults.append(INVALID_VARIABLE_NAME.at(entry.key.span, name=entry.name, kind="value of 'for'"))
        elif entry.name in RESERVED_NAMES:
            faults.append(RESERVED_NAME.at(entry.key.span, name=entry.name, kind="value of 'for'"))
        elif entry.name in set(evaluator.scope):  # `in` the scope is what a faulty section may declare, too
            faults.append(FOR_NAME_TAKEN.at(entry.key.span, name=entry.name))
    if key is not None and not faults:
        if evaluator.sink.has_error_in(key.span):
            return False
        missing = [name for name in names.entries if name not in evaluator.names_in(key)]
        faults = [
            KEY_WITHOUT_NAME.at(key.span, name=name, key=key.text, example=f"{key.text}_$({name})") for name in missing
        ]
    evaluator.sink.report_all(faults)
    return not faults


def _disable(entry: _Entry, body: YamlNode, where: Span, silent: Evaluator) -> None:
    """Record the names that the `when` at a place removes: those of an entry, its joint and its module."""
    name = silent.key(entry.key)
    if name is None:
        return
    note = Note(f"'{name.text}' is disabled by 'when' here", where)
    silent.disabled.setdefault(name.text, note)
    if entry.title in _NAMES_ITS_JOINT:
        joint = body.get("joint") if isinstance(body, YamlMap) else None
        text = _text(joint, "name", silent) if isinstance(joint, YamlMap) else _text(body, "joint", silent)
        silent.disabled.setdefault(f"{name.text}_joint" if text is None else text, note)
    if entry.title == "a module":
        prefix = _text(body, "prefix", silent)
        silent.disabled_prefixes.setdefault(f"{name.text}_" if prefix is None else prefix, note)


def _text(body: YamlNode, field: str, evaluator: Evaluator) -> str | None:
    node = body.get(field) if isinstance(body, YamlMap) else None
    key = evaluator.key(node) if isinstance(node, YamlScalar) else None
    return key.text if key else None
