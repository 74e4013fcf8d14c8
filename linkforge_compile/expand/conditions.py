"""`when` and `for`: whether a thing is there, and how often, each time in a scope of its own."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from linkforge_compile.diagnostics import Code, Diagnostic, Diagnostics
from linkforge_compile.diagnostics.codes.expressions import TRUTH_AS_TEXT
from linkforge_compile.diagnostics.codes.modules import INVALID_VARIABLE_NAME, RESERVED_NAME
from linkforge_compile.diagnostics.codes.repetition import (
    CONDITION_KIND,
    FOR_KIND,
    FOR_NAME_TAKEN,
    KEY_WITHOUT_NAME,
    LONG_FORM,
    RESERVED_KEY,
)
from linkforge_compile.expand.origins import Setting
from linkforge_compile.expand.values import describe
from linkforge_compile.expressions import FAULT, RESERVED_NAMES, Fault, Value, as_one_expression
from linkforge_compile.schema.repetition import WORDS
from linkforge_compile.schema.shapes import Shape
from linkforge_compile.syntax import YamlEntry, YamlFault, YamlMap, YamlNode, YamlScalar, has_expression
from linkforge_compile.syntax.scalars import TRUTHS_OF_YAML_1_1

if TYPE_CHECKING:
    from linkforge_compile.expand.evaluate_tree import TreeEvaluator

Occurrence: TypeAlias = "tuple[TreeEvaluator, YamlNode]"
"""A node without its `for` and `when`, and what computes it: in its scope are the `for` names with their values."""

_WORDS = frozenset({"for", "when"})


def occurrences(
    node: YamlNode, shape: Shape, tree: TreeEvaluator, *, key: YamlScalar | None = None, is_item: bool = False
) -> Iterator[Occurrence]:
    """Yield a node as often as its `for` and `when` say; once where it has neither.

    An entry of a map of names has a `key`, which must tell its copies apart. What is no object says so in the long
    form, as such an entry or as an item of a list (`is_item`). What is at fault is reported, and a YamlFault, once.
    """
    may_repeat = (shape.is_object or key is not None or is_item) and not shape.is_plain
    if not (may_repeat and isinstance(node, YamlMap) and _WORDS & node.entries.keys()):
        yield tree, node
        return
    body = _body(node, shape, tree.sink)
    condition, repeated = node.get("when"), node.get("for")
    if body is None or isinstance(condition, YamlFault) or isinstance(repeated, YamlFault):
        yield tree, YamlFault(node.span)
        return
    thing = _Thing(key, shape.title) if key and shape.is_object and not shape.has_short_form else None
    if not isinstance(repeated, YamlMap):
        yield from _once(body, condition, thing, tree)
    elif _are_names(repeated, tree) and _tells_apart(key, repeated, tree):
        yield from _repeated(body, condition, repeated, thing, tree)
    else:
        yield tree, YamlFault(node.span)


def without_words(node: YamlMap, shape: Shape, tree: TreeEvaluator) -> tuple[YamlMap, TreeEvaluator]:
    """Return a map of names without those that are words of repetition, which are reported, and what computes it.

    What such a `for` would have given a value is a fault to whoever uses it, and no unknown name.
    """
    names = {name: entry for name, entry in node.entries.items() if name not in WORDS}
    example = next((name for name in names if has_expression(name)), next(iter(names), "…"))
    for word in (entry.key for entry in node if entry.name in WORDS):
        way_out = _WAYS_OUT.get(word.text, "").format(name=example)
        tree.sink.report(RESERVED_KEY.at(word.span, name=word.text, owner=shape.things, way_out=way_out))
    repeated = node.get("for")
    lost = repeated.entries if isinstance(repeated, YamlMap) else {}
    scope = tree.scope.inside(dict.fromkeys(lost, FAULT))
    return YamlMap(names, node.span), replace(tree, scope=scope)


_WAYS_OUT = {
    "for": "; it goes inside what it repeats: '{name}: {{for: …}}'",
    "when": "; it goes inside what it applies to: '{name}: {{when: …}}'",
}


class _Thing(NamedTuple):
    """What has a name: its key, and the title of its schema."""

    key: YamlScalar
    title: str


def _body(node: YamlMap, shape: Shape, sink: Diagnostics) -> YamlNode | None:
    """Return what is there, once or more often; None where the long form says something else, which is reported."""
    if shape.is_object and not (shape.has_short_form and "value" in node.entries):
        return YamlMap({name: entry for name, entry in node.entries.items() if name not in _WORDS}, node.span)
    others = [entry.key for entry in node if entry.name not in _WORDS | {"value"}]
    if any(isinstance(entry.value, YamlFault) for entry in node):
        return None  # the schema has told of it
    if others or "value" not in node.entries:
        where = others[0].span if others else next(iter(node)).key.span
        sink.report(LONG_FORM.at(where, found=f"'{others[0].text}'" if others else "no 'value'"))
        return None
    return node.entries["value"].value


def _once(
    body: YamlNode, condition: YamlNode | None, thing: _Thing | None, tree: TreeEvaluator
) -> Iterator[Occurrence]:
    is_there = _is_there(condition, tree)
    if isinstance(is_there, Fault):
        yield tree, YamlFault(body.span)
    elif is_there:
        yield tree, body
    elif thing and condition:
        tree.disabled.add(thing.key, body, thing.title, condition.span, tree)


def _is_there(condition: YamlNode | None, tree: TreeEvaluator) -> bool | Fault:
    value = True if condition is None else tree.value(condition)
    if value is None or isinstance(value, bool | Fault):
        return True if value is None else value
    assert condition is not None, "without a condition, the value is True"
    tree.sink.report(_no_condition(value, condition, tree))
    return FAULT


def _no_condition(value: Value, condition: YamlNode, tree: TreeEvaluator) -> Diagnostic:
    """Tell of a value that is neither true nor false, and of what was meant where that shows."""
    place = tree.place(condition)
    if isinstance(value, str) and (meant := TRUTHS_OF_YAML_1_1.get(value.lower())):
        return TRUTH_AS_TEXT.at(place, name=value, meant=meant)
    names, text = tree.scope, condition.text if isinstance(condition, YamlScalar) else ""
    whole = as_one_expression(text, condition.span, names)
    way_out = f"; write '{whole}'" if whole else ""
    return CONDITION_KIND.at(place, found=f"{describe(value)}{way_out}")


def _repeated(
    body: YamlNode, condition: YamlNode | None, repeated: YamlMap, thing: _Thing | None, tree: TreeEvaluator
) -> Iterator[Occurrence]:
    """Yield a copy for each combination of the `for` values.

    A condition without `for` names is the same for all: where it fails, the `for` itself is not computed.
    A failing condition disables the `thing`, None for what has no name.
    """
    if condition is not None and not tree.names_in(condition) & repeated.entries.keys():
        is_there = _is_there(condition, tree)
        if is_there is False and thing:
            for copy in _copies(repeated, tree.silent, YamlFault(body.span)) or ():
                tree.disabled.add(thing.key, body, thing.title, condition.span, copy)
        if is_there is not True:
            yield from [(tree, YamlFault(body.span))] if is_there is FAULT else []
            return
        condition = None
    copies = _copies(repeated, tree, body)
    if copies is None:
        yield tree, YamlFault(body.span)
    for copy in copies or ():
        yield from _once(body, condition, thing, copy)


def _copies(repeated: YamlMap, tree: TreeEvaluator, body: YamlNode) -> list[TreeEvaluator] | None:
    """Return what computes each combination, the first name varying slowest; None for a fault, which is reported.

    `body` is what is repeated: of all copies together, and of their names, there is only so much.
    """
    combinations: list[tuple[dict[str, Value], dict[str, Setting]]] = [({}, {})]
    for number, entry in enumerate(repeated, start=1):
        written = body if number == len(repeated) else YamlFault(body.span)
        longer = []
        for names, settings in combinations:
            around = tree.inside(names, settings)
            values = _values(entry, around)
            if values is None:
                return None
            is_made = isinstance(values, range)
            for place, value in enumerate(values):
                tree.expressions.repeat(written, number, entry.key.span)
                setting = Setting("one of 'for'", entry.value, around, (place,), is_made)
                longer.append(({**names, entry.name: value}, {**settings, entry.name: setting}))
        combinations = longer
    return [tree.inside(*combination) for combination in combinations]


def _values(entry: YamlEntry, tree: TreeEvaluator) -> Sequence[Value] | None:
    """Return the values of a `for` name: the items of a list, or 0 and up for a number; None where it is neither."""
    value = tree.value(entry.value)
    match value:
        case Fault():
            return None
        case tuple():
            return value
        case int() | float() if not isinstance(value, bool) and value >= 0 and value == value // 1 < float("inf"):
            return range(int(value))
    tree.sink.report(FOR_KIND.at(tree.place(entry.value), name=entry.name, found=describe(value)))
    return None


def _are_names(repeated: YamlMap, tree: TreeEvaluator) -> bool:
    """Whether expressions can use the `for` names and nothing else has them; reports why not."""
    taken = set(tree.scope)
    faults = [(code, entry) for entry in repeated if (code := _fault_of_name(entry.name, taken))]
    for code, entry in faults:
        tree.sink.report(code.at(entry.key.span, name=entry.name, kind="value of 'for'"))
    return not faults


def _fault_of_name(name: str, taken: Collection[str]) -> Code | None:
    if not (name.isascii() and name.isidentifier()):
        return INVALID_VARIABLE_NAME
    if name in RESERVED_NAMES:
        return RESERVED_NAME
    return FOR_NAME_TAKEN if name in taken else None


def _tells_apart(key: YamlScalar | None, repeated: YamlMap, tree: TreeEvaluator) -> bool:
    """Whether a key mentions all `for` names; reports those that it does not."""
    if key is None:
        return True
    if tree.sink.has_error_in(key.span):
        return False
    missing = [name for name in repeated.entries if name not in tree.names_in(key)]
    for name in missing:
        tree.sink.report(KEY_WITHOUT_NAME.at(key.span, name=name, example=f"{key.text}_$({name})"))
    return not missing
