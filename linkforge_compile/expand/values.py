"""Convert between nodes and values of expressions, and trace where a value was written."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import NamedTuple, Protocol

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.expressions import (
    FAULT,
    Fault,
    Scope,
    Template,
    Value,
    ValuePath,
    as_text,
    forgotten_expression,
    passed_on,
    seen_from_compiled,
)
from linkforge_compile.expressions.operators import AXES
from linkforge_compile.limits import Limit
from linkforge_compile.schema.shapes import FREE, Shape
from linkforge_compile.source import Key, Origin, Span, TracedSpan
from linkforge_compile.source.provenance import Kind
from linkforge_compile.syntax import (
    ScalarValue,
    YamlEntry,
    YamlFault,
    YamlList,
    YamlMap,
    YamlNode,
    YamlScalar,
    has_expression,
)
from linkforge_compile.units import Quantity, parse_quantity


def plain_value(node: YamlNode) -> Value | Fault:
    """Return the value of a node without computing `$(...)`; text such as `3 kg` is a quantity. FAULT for a fault."""
    match node:
        case YamlScalar(value=str() as text):
            return parse_quantity(text) or text
        case YamlScalar():
            return node.value
        case YamlList():
            items = tuple(plain_value(item) for item in node)
            return FAULT if FAULT in items else tuple(item for item in items if item is not FAULT)
        case YamlMap():
            values = {entry.name: plain_value(entry.value) for entry in node}
            sound = {name: value for name, value in values.items() if value is not FAULT}
            return sound if len(sound) == len(values) else FAULT
    return FAULT


def node_of(value: Value, span: Span, is_free: bool = False) -> YamlNode:
    """Return a value as a tree; every node gets the span of the expression, as a part of it.

    The text of a scalar is that of `as_text`, of null empty. In free parts (`is_free`), a number or truth value that
    was not computed is as its author wrote it, because plugins read text.
    """
    if isinstance(value, tuple):
        return YamlList(tuple(node_of(item, span.inside(place), is_free) for place, item in enumerate(value)), span)
    if isinstance(value, Mapping):
        entries = {
            name: YamlEntry(_scalar(name, span.inside(Key(name))), node_of(item, span.inside(name), is_free))
            for name, item in value.items()
        }
        return YamlMap(entries, span)
    if is_free and isinstance(value, int | float) and isinstance(span, TracedSpan):
        spelling = span.trace.spelling(span.path, value) if isinstance(span.trace, ExpressionTrace) else None
        return _scalar(value, span) if spelling is None else YamlScalar(spelling, value, span)
    return _scalar(value, span)


def _scalar(value: ScalarValue, span: Span) -> YamlScalar:
    return YamlScalar(as_text(value) or "", value, span)


def with_final_paths(value: Value, shape: Shape, is_free: bool) -> Value:
    """Return a value whose paths in free parts are as the compiled file would write them; no later stage sees them."""
    is_free = is_free or shape.is_free_part or shape.is_xml
    match value:
        case str() if is_free:
            return seen_from_compiled(value)
        case Mapping():
            return {name: with_final_paths(item, shape.under(name), is_free) for name, item in value.items()}
        case tuple() if is_free or shape.item:
            item_shape = shape.item or FREE
            return tuple(with_final_paths(item, item_shape, is_free) for item in value)
    return value


def size_of(value: Value, max_nodes: int) -> tuple[int, int, int]:
    """Return how many nodes (keys and tags of raw XML included) and characters a value has, and its nesting depth.

    Counting stops after `max_nodes` nodes: values share parts, so that ten short variables can make a billion nodes.
    """
    nodes = characters = depth = 0
    waiting = [(value, 0)]
    while waiting and nodes <= max_nodes:
        part, level = waiting.pop()
        nodes, depth = nodes + 1, max(depth, level)
        if isinstance(part, str):
            characters += len(part)
            nodes += part.count("<")
        elif isinstance(part, tuple):
            waiting.extend((item, level + 1) for item in part)
        elif isinstance(part, Mapping):
            nodes, characters = nodes + len(part), characters + sum(map(len, part))
            waiting.extend((item, level + 1) for item in part.values())
    return nodes, characters, depth


def describe(value: Value) -> str:
    """Return a value as messages quote it."""
    if isinstance(value, tuple):
        return f"a list of {len(value)}"
    if isinstance(value, Mapping):
        return "a map"
    if value is None:
        return "nothing"
    return f"'{value if isinstance(value, Quantity) else as_text(value)}'"


def describe_node(node: YamlNode) -> str:
    """Return a node as messages quote it."""
    if isinstance(node, YamlScalar):
        return f"'{node.text}'"
    return "a list" if isinstance(node, YamlList) else "a map"


_MOST_STEPS = 10_000
_LONGEST_TEXT = 60


class Evaluation(Protocol):
    """The part of an evaluator that is needed to trace a value."""

    @property
    def scope(self) -> Scope: ...

    @property
    def settings(self) -> Mapping[str, Setting]: ...

    def scope_of(self, scalar: YamlScalar) -> Scope: ...

    def template(self, scalar: YamlScalar, sink: Diagnostics) -> Template | None: ...


@dataclass(frozen=True, eq=False)
class Setting:
    """What gives a name its value.

    - `kind`, `name`: what that is, as in a chain of provenance.
    - `node`, `path`: the value is the part at this path of the node.
    - `tree`: evaluates the node; None for plain data, where `$(` is text.
    - `is_made`: whether the value is written nowhere, such as a number that a `for` counts.
    - `is_normalized`: whether a type decides how the value is written, as `true` for `True` and `3` for `03`.
    - `named_by`: the node that names the data file which holds `node`.
    - `instead_of`: the settings that this one overrides, the next in line first.
    """

    kind: Kind
    node: YamlNode
    tree: Evaluation | None = None
    name: str = ""
    path: ValuePath = ()
    is_made: bool = False
    is_normalized: bool = False
    named_by: YamlNode | None = None
    instead_of: tuple[Setting, ...] = ()


@dataclass(frozen=True, eq=False)
class ExpressionTrace:
    """An expression and the evaluator that computed it, to trace its value."""

    scalar: YamlScalar
    tree: Evaluation

    def origin(self, path: ValuePath) -> Origin | None:
        """Return where the part at a path of the value was written, None if the expression made it."""
        written = _written(self.scalar, self.tree, path)
        node, key = written.node, written.key
        if node is self.scalar or isinstance(node, YamlFault):
            return None
        return Origin((node.key_span(key) if key else None) or node.span, written.is_data)

    def spelling(self, path: ValuePath, value: int | float) -> str | None:
        """Return how the number or truth value at a path was written, None if it was computed or is not finite."""
        written = _written(self.scalar, self.tree, path)
        self.tree.scope.budget.spend(Limit.STEPS, written.steps, self.scalar.span)
        node = written.node
        if written.is_normalized or not isinstance(node, YamlScalar) or not math.isfinite(value):
            return None
        return node.text if type(node.value) is type(value) and node.value == value else None

    def forgotten_expression(self, path: ValuePath) -> str | None:
        """Return the expression that the text at a path lacks only the `$(` to be, None for other text."""
        written = _written(self.scalar, self.tree, path)
        node, tree = written.node, written.tree
        if tree is None or written.key or not isinstance(node, YamlScalar) or has_expression(node.text):
            return None
        return forgotten_expression(node.text, node.span, tree.scope) if isinstance(node.value, str) else None


class NameOrigin(NamedTuple):
    """How a name got its value; `names` are those from which the value was computed."""

    name: str
    value: str
    setting: Setting
    names: tuple[NameOrigin, ...]


def find_name_origins(node: YamlNode) -> tuple[NameOrigin, ...]:
    """Return the origin of each name used by the expressions that computed a node; each name appears once."""
    return tuple(_names_of(node, None, set()))


def find_name_origin(name: str, tree: Evaluation) -> NameOrigin | None:
    """Return the origin of a name in the scope of an evaluator; None if nothing sets it."""
    return _name_origin(name, tree, set())


def _names_of(node: YamlNode, writer: Evaluation | None, seen: set[Setting]) -> Iterator[NameOrigin]:
    for name, tree in _names_in(node, writer):
        if origin := _name_origin(name, tree, seen):
            yield origin


def _name_origin(name: str, tree: Evaluation, seen: set[Setting]) -> NameOrigin | None:
    """Return the origin of a name; None if nothing sets it, and for one of the settings `seen`, which grow."""
    setting = tree.settings.get(name)
    if setting is None or setting in seen:
        return None
    seen.add(setting)
    value = tree.scope.lookup(name, Diagnostics())
    shown = "unknown" if value is FAULT else describe(value)
    if isinstance(value, str):
        shown = shown if len(shown) < _LONGEST_TEXT else f"{shown[:_LONGEST_TEXT]}…'"
    else:
        shown = shown.strip("'")
    within = tuple(_names_of(setting.named_by or setting.node, setting.tree, seen))
    return NameOrigin(name, shown, setting, within)


def _names_in(node: YamlNode, tree: Evaluation | None) -> Iterator[tuple[str, Evaluation]]:
    """Yield the names that the expressions in a node use, in order, each with its evaluator."""
    if computed := _expression_of(node):
        node, tree = computed[0].scalar, computed[0].tree
    match node:
        case YamlScalar() if tree:
            template = tree.template(node, Diagnostics()) if has_expression(node.text) else None
            yield from ((name, tree) for name in (template.names_in_order if template else ()))
        case YamlList():
            for item in node:
                yield from _names_in(item, tree)
        case YamlMap():
            for entry in node:
                yield from _names_in(entry.value, tree)


class _Written(NamedTuple):
    """Where a value is written: a node, or its `key` if that is set. `tree` as in Setting.

    `is_normalized` if a setting on the way there is; `steps` is the length of the way.
    """

    node: YamlNode
    is_data: bool
    key: Key | None
    tree: Evaluation | None
    is_normalized: bool
    steps: int


def _written(node: YamlNode, tree: Evaluation | None, path: ValuePath) -> _Written:
    """Follow a value through the names that pass it on, to where it was written or computed."""
    is_data = is_normalized = False
    key: Key | None = None
    steps = 0
    while steps < _MOST_STEPS:
        steps += 1
        if computed := _expression_of(node):
            node, tree, path = computed[0].scalar, computed[0].tree, (*computed[1], *path)
        elif isinstance(node, YamlScalar) and tree and has_expression(node.text):
            template = tree.template(node, Diagnostics())
            taken = passed_on(template, tree.scope_of(node), path) if template else None
            setting = tree.settings.get(taken[0]) if taken else None
            if taken is None or setting is None or setting.is_made:
                break
            node, tree, path = setting.node, setting.tree, (*setting.path, *taken[1])
            is_data = is_data or setting.named_by is not None
            is_normalized = is_normalized or setting.is_normalized
        elif not path:
            break
        elif isinstance(path[0], Key):
            key = path[0]
            break
        else:
            inner = _part(node, path[0])
            if inner is None:
                break
            node, path = inner, path[1:]
    return _Written(node, is_data, key, tree, is_normalized, steps)


def _expression_of(node: YamlNode) -> tuple[ExpressionTrace, ValuePath] | None:
    """Return the expression that computed a node and the path in its value; None if an override changed it."""
    span = node.span
    if isinstance(span, TracedSpan) and isinstance(span.trace, ExpressionTrace) and not span.changes:
        return span.trace, span.path
    return None


def _part(node: YamlNode, key: str | int) -> YamlNode | None:
    """Return the part of a node under a key, by the rules of expressions."""
    if isinstance(node, YamlMap):
        return node.child(str(key))
    if isinstance(node, YamlList):
        position = AXES.get(key) if isinstance(key, str) else key
        if position is not None and -len(node) <= position < len(node):
            return node.items[position]
    return None
