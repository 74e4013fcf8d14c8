"""Apply `for` and `when`: yield a node as often as it occurs, each time with an evaluator that knows its names."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from typing import NamedTuple, TypeAlias

from linkforge_compile.diagnostics import Code, Diagnostic, Diagnostics, Note
from linkforge_compile.diagnostics.codes.expressions import TRUTH_AS_TEXT
from linkforge_compile.diagnostics.codes.modules import (
    CONDITION_KIND,
    FOR_KIND,
    FOR_NAME_TAKEN,
    INVALID_VARIABLE_NAME,
    KEY_WITHOUT_NAME,
    LONG_FORM,
    RESERVED_KEY,
    RESERVED_NAME,
)
from linkforge_compile.expand.evaluate import Evaluator
from linkforge_compile.expand.values import Setting, describe
from linkforge_compile.expressions import FAULT, RESERVED_NAMES, Fault, Value, as_one_expression
from linkforge_compile.limits import Limit
from linkforge_compile.schema.json_schema import WORDS
from linkforge_compile.schema.shapes import Shape
from linkforge_compile.source import Span
from linkforge_compile.source.provenance import Kind
from linkforge_compile.syntax import YamlEntry, YamlFault, YamlMap, YamlNode, YamlScalar, has_expression
from linkforge_compile.syntax.nodes import YAML_1_1_BOOLEANS

Occurrence: TypeAlias = tuple[Evaluator, YamlNode]
"""A node without its `for` and `when`, and an evaluator that knows the `for` names."""

_FOR_AND_WHEN = frozenset({"for", "when"})

_NAMES_ITS_JOINT = frozenset({"a frame", "a module"})
"""The titles of entries that have a joint named after them, unless `joint` gives it a name."""

_HINTS = {
    "for": "; it goes inside what it repeats: '{name}: {{for: …}}'",
    "when": "; it goes inside what it applies to: '{name}: {{when: …}}'",
}


def occurrences(
    node: YamlNode, shape: Shape, evaluator: Evaluator, *, key: YamlScalar | None = None, is_item: bool = False
) -> Iterator[Occurrence]:
    """Yield a node once for each combination of its `for` values for which `when` holds.

    An entry of a map of names has a `key`, which must mention all `for` names. An entry or list item (`is_item`) that
    is not an object uses the long form. A faulty `for` or `when` is reported, and yields a YamlFault once.
    """
    may_repeat = (shape.is_object or key is not None or is_item) and not shape.is_plain
    if not (may_repeat and isinstance(node, YamlMap) and _FOR_AND_WHEN & node.entries.keys()):
        yield evaluator, node
        return
    body = _body(node, shape, evaluator.sink)
    condition, names = node.get("when"), node.get("for")
    if body is None or isinstance(condition, YamlFault) or isinstance(names, YamlFault):
        yield evaluator, YamlFault(node.span)
        return
    entry = _Entry(key, shape.title) if key and shape.is_object and not shape.has_short_form else None
    if not isinstance(names, YamlMap):
        yield from _occur_once(body, condition, entry, evaluator)
    elif _are_valid_names(names, evaluator) and _key_mentions(key, names, evaluator):
        yield from _repeat(body, condition, names, entry, evaluator)
    else:
        yield evaluator, YamlFault(node.span)


def without_words(node: YamlMap, shape: Shape, evaluator: Evaluator) -> tuple[YamlMap, Evaluator]:
    """Return a map of names without misplaced words of repetition, which are reported, and its evaluator.

    The names of a misplaced `for` are faults to the evaluator, not unknown names.
    """
    entries = {name: entry for name, entry in node.entries.items() if name not in WORDS}
    example = next((name for name in entries if has_expression(name)), next(iter(entries), "…"))
    for word in (entry.key for entry in node if entry.name in WORDS):
        hint = _HINTS.get(word.text, "").format(name=example)
        evaluator.sink.report(RESERVED_KEY.at(word.span, name=word.text, owner=shape.things, way_out=hint))
    names = node.get("for")
    return YamlMap(entries, node.span), evaluator.with_faults(names.entries if isinstance(names, YamlMap) else {})


class _Entry(NamedTuple):
    """The key of an entry with a name, and the title of its schema."""

    key: YamlScalar
    title: str


def _body(node: YamlMap, shape: Shape, sink: Diagnostics) -> YamlNode | None:
    """Return what occurs; None for a malformed long form, which is reported."""
    if shape.is_object and not (shape.has_short_form and "value" in node.entries):
        return YamlMap({name: entry for name, entry in node.entries.items() if name not in _FOR_AND_WHEN}, node.span)
    others = [entry.key for entry in node if entry.name not in _FOR_AND_WHEN | {"value"}]
    if any(isinstance(entry.value, YamlFault) for entry in node):
        return None  # the schema reported it
    if others or "value" not in node.entries:
        where = others[0].span if others else next(iter(node)).key.span
        sink.report(LONG_FORM.at(where, found=f"'{others[0].text}'" if others else "no 'value'"))
        return None
    return node.entries["value"].value


def _occur_once(
    body: YamlNode, condition: YamlNode | None, entry: _Entry | None, evaluator: Evaluator
) -> Iterator[Occurrence]:
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
    evaluator.sink.report(_no_condition(value, condition, evaluator))
    return FAULT


def _no_condition(value: Value, condition: YamlNode, evaluator: Evaluator) -> Diagnostic:
    """Return the diagnostic for a condition that is neither true nor false, with a correction if there is one."""
    place = evaluator.place(condition)
    if isinstance(value, str) and (truth := YAML_1_1_BOOLEANS.get(value.lower())):
        return TRUTH_AS_TEXT.at(place, name=value, expected=truth)
    text = condition.text if isinstance(condition, YamlScalar) else ""
    expression = as_one_expression(text, condition.span, evaluator.scope)
    remedy = f"; write '{expression}'" if expression else ""
    return CONDITION_KIND.at(place, found=f"{describe(value)}{remedy}")


def _repeat(
    body: YamlNode, condition: YamlNode | None, names: YamlMap, entry: _Entry | None, evaluator: Evaluator
) -> Iterator[Occurrence]:
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


def _are_valid_names(names: YamlMap, evaluator: Evaluator) -> bool:
    """Whether expressions can use the `for` names and they are not taken; reports why not."""
    taken = set(evaluator.scope)
    faults = [(code, entry) for entry in names if (code := _fault_of_name(entry.name, taken))]
    for code, entry in faults:
        evaluator.sink.report(code.at(entry.key.span, name=entry.name, kind="value of 'for'"))
    return not faults


def _fault_of_name(name: str, taken: Collection[str]) -> Code | None:
    if not (name.isascii() and name.isidentifier()):
        return INVALID_VARIABLE_NAME
    if name in RESERVED_NAMES:
        return RESERVED_NAME
    return FOR_NAME_TAKEN if name in taken else None


def _key_mentions(key: YamlScalar | None, names: YamlMap, evaluator: Evaluator) -> bool:
    """Whether a key uses all `for` names, so that no two copies have the same; reports missing ones."""
    if key is None:
        return True
    if evaluator.sink.has_error_in(key.span):
        return False
    missing = [name for name in names.entries if name not in evaluator.names_in(key)]
    for name in missing:
        evaluator.sink.report(KEY_WITHOUT_NAME.at(key.span, name=name, example=f"{key.text}_$({name})"))
    return not missing


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
