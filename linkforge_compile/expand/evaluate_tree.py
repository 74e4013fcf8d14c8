"""Computes the expressions of a tree: each becomes a node of its value, where the expression stands."""

from __future__ import annotations

from collections import ChainMap
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace

from linkforge_compile.diagnostics import Diagnostics, Note
from linkforge_compile.diagnostics.codes.expressions import UNKNOWN_NAME
from linkforge_compile.diagnostics.codes.modules import COMPUTED_KEY, SAME_KEY, TREE_TOO_LARGE
from linkforge_compile.diagnostics.suggest import nearest
from linkforge_compile.expand.changing import Changing
from linkforge_compile.expand.computed import judge_computed
from linkforge_compile.expand.conditions import occurrences, without_words
from linkforge_compile.expand.disabled import Disabled
from linkforge_compile.expand.made_number import tell_made_number
from linkforge_compile.expand.origins import ExpressionTrace, Setting
from linkforge_compile.expand.values import node_of, passed_on, plain_value, size_of
from linkforge_compile.expressions import (
    FAULT,
    Fault,
    Lazy,
    Scope,
    Template,
    Value,
    as_text,
    evaluate,
    kind_name,
    parse_template,
)
from linkforge_compile.limits import Budget, Limit
from linkforge_compile.schema.repetition import WORDS
from linkforge_compile.schema.shapes import FREE, Shape
from linkforge_compile.source import SourceFile, Span, TracedSpan
from linkforge_compile.syntax import YamlEntry, YamlFault, YamlList, YamlMap, YamlNode, YamlScalar, has_expression
from linkforge_compile.syntax.nodes import fault_of

MAX_COMPUTED_DEPTH = 100
"""How deep the lists and maps of one value may lie in one another: every later stage walks them by recursion."""


_STEPS_TO_PARSE = 50
"""A text with expressions takes as long to be parsed as so many steps of one to be computed."""


class Expressions(Changing):
    """What all uses of all files of one compile share: each expression parsed once, and what they take counted."""

    def __init__(self, budget: Budget) -> None:
        super().__init__()
        self.budget = budget
        self._templates: dict[YamlScalar, Template | None] = {}
        self._alone: dict[tuple[str, Span], YamlScalar] = {}
        self._live: dict[YamlList | YamlMap, bool] = {}
        self._sizes: dict[YamlList | YamlMap, tuple[int, int]] = {}

    def template(self, scalar: YamlScalar, sink: Diagnostics) -> Template | None:
        """Return a scalar's text with its expressions parsed; None where they cannot be, which is reported once."""
        if scalar not in self._templates:
            span = scalar.span
            self.budget.spend(Limit.STEPS, _STEPS_TO_PARSE, span)
            self._templates[scalar] = parse_template(scalar.text, span, sink)
        return self._templates[scalar]

    def alone(self, expression: str, where: Span) -> YamlScalar:
        """Return a part of an expression as a scalar of its own, the same one each time that a `for` comes by."""
        if (expression, where) not in self._alone:
            whole = f"$({expression})"
            self._alone[expression, where] = YamlScalar(whole, whole, where)
        return self._alone[expression, where]

    def are_in(self, node: YamlNode) -> bool:
        """Whether a node or anything in it, keys too, holds an expression."""
        if isinstance(node, YamlScalar):
            return has_expression(node.text)
        if isinstance(node, YamlFault):
            return False
        if node not in self._live:
            if isinstance(node, YamlList):
                self._live[node] = any(self.are_in(item) for item in node)
            else:
                self._live[node] = any(has_expression(entry.name) or self.are_in(entry.value) for entry in node)
        return self._live[node]

    def size(self, node: YamlNode) -> tuple[int, int]:
        """Return how many nodes a node is, tags of raw XML among them, and how many characters its scalars have."""
        if isinstance(node, YamlScalar):
            return 1 + node.text.count("<"), len(node.text)
        if isinstance(node, YamlFault):
            return 1, 0
        if node not in self._sizes:
            parts = node if isinstance(node, YamlList) else (entry.value for entry in node)
            sizes = [(1, 0), *map(self.size, parts)]
            self._sizes[node] = sum(nodes for nodes, _ in sizes), sum(characters for _, characters in sizes)
        return self._sizes[node]

    def repeat(self, node: YamlNode, names: int, where: Span) -> None:
        """Count a node that one round of a `for` writes, with a value for each name of the `for`."""
        self.budget.spend(Limit.ROUNDS, 1, where)
        self.write_again(node, where, names)

    def write_again(self, node: YamlNode, where: Span, names: int = 0) -> None:
        """Count a node that is written once more, with the values of so many names."""
        nodes, characters = self.size(node)
        self.budget.spend(Limit.VALUES, nodes + names, where)
        self.budget.spend(Limit.CHARACTERS_MADE, characters, where)

    def admit(self, value: Value, where: Span, sink: Diagnostics) -> bool:
        """Count what a value makes; False for one that lies too deep in itself, which is reported."""
        size = size_of(value, max(0, self.budget.left(Limit.VALUES)))
        if size.depth > MAX_COMPUTED_DEPTH:
            limit = f"{MAX_COMPUTED_DEPTH} lists and maps inside each other"
            sink.report(TREE_TOO_LARGE.at(where, limit=limit))
            return False
        self.budget.spend(Limit.VALUES, size.nodes, where)
        self.budget.spend(Limit.CHARACTERS_MADE, size.characters, where)
        return True


class _Silence(Diagnostics):
    """Takes what nobody is to be told."""


@dataclass(frozen=True)
class TreeEvaluator:
    """Evaluates nodes of one file in one scope.

    `elsewhere` holds, for each included file that lies in another folder, the paths among the names as seen from it.
    `disabled` collects what a `when` takes out.
    `settings` says of the names in scope what gave them their values.
    """

    scope: Scope
    expressions: Expressions
    sink: Diagnostics
    elsewhere: Mapping[SourceFile, Mapping[str, Lazy]] = field(default_factory=dict)
    disabled: Disabled = field(default_factory=Disabled)
    settings: ChainMap[str, Setting] = field(default_factory=ChainMap)

    def inside(self, values: Mapping[str, Value], settings: dict[str, Setting]) -> TreeEvaluator:
        """Return one that knows these names as well."""
        return replace(self, scope=self.scope.inside(values), settings=self.settings.new_child(settings))

    def scope_of(self, scalar: YamlScalar) -> Scope:
        """Return the scope in which a scalar's expressions are computed."""
        moved = self.elsewhere.get(scalar.span.file)
        return self.scope.inside(moved) if moved else self.scope

    def place(self, node: YamlNode) -> Span:
        """Return where a node stands; the place of an expression can tell where its value comes from."""
        if isinstance(node, YamlScalar) and has_expression(node.text):
            return TracedSpan.computed(node.span, ExpressionTrace(node, self))
        return node.span

    @property
    def silent(self) -> TreeEvaluator:
        """One that reports nothing, for what is not part of the robot."""
        if isinstance(self.sink, _Silence):
            return self
        return replace(self, sink=_Silence(), expressions=Expressions(self.expressions.budget))

    def names_in(self, node: YamlNode) -> frozenset[str]:
        """Return the names that the expressions of a scalar use."""
        template = self.expressions.template(node, self.sink) if isinstance(node, YamlScalar) else None
        return template.names if template else frozenset()

    def value(self, node: YamlNode) -> Value | Fault:
        """Return what a node means in an expression; FAULT if anything in it is at fault, which is reported."""
        if not self.expressions.are_in(node):
            return plain_value(node)
        match node:
            case YamlScalar():
                return self._computed(node)
            case YamlList():
                items = [self.value(item) for item in node]
                sound = tuple(item for item in items if item is not FAULT)
                return sound if len(sound) == len(items) else FAULT
            case YamlMap():
                return self._map_value(node)
        return FAULT

    def node(self, node: YamlNode, shape: Shape = FREE, *, key: str = "", is_free: bool = False) -> YamlNode:
        """Return the tree with every expression computed, and repeated where it says so; what says nothing is as it is.

        What is at fault becomes a YamlFault; an entry whose key is keeps the key as written. `shape` tells where
        `for` and `when` are more than keys, and judges what an expression under `key` makes of itself; `is_free`
        that the node is in a part of which nothing is read as a number.
        """
        if not self.expressions.change(node):
            return node
        is_free = is_free or shape.is_free_part
        match node:
            case YamlScalar():
                return judge_computed(self._scalar(node, shape, is_free), key, shape, self.sink)
            case YamlList():
                item = shape.item or (shape if shape.is_object else FREE)
                return YamlList(tuple(self._items(node, item, key, is_free)), node.span)
            case YamlMap():
                return self._map(node, shape, is_free)
        return node

    def part(self, node: YamlNode, shape: Shape, key: str) -> YamlNode | None:
        """Return the computed part of an object under a key, None where its `when` takes it out."""
        return next((tree.node(copy, shape, key=key) for tree, copy in occurrences(node, shape, self)), None)

    def key(self, key: YamlScalar) -> YamlScalar | None:
        """Return a key with its expressions computed; None where it is at fault, which is reported."""
        if not has_expression(key.text):
            return key
        value = self._computed(key)
        if value is FAULT:
            return None
        text = as_text(value)
        if text is None:
            self.sink.report(COMPUTED_KEY.at(key.span, found=kind_name(value)))
            return None
        return YamlScalar(text, text, key.span)

    def _items(self, items: Iterable[YamlNode], shape: Shape, key: str, is_free: bool) -> Iterator[YamlNode]:
        for item in items:
            for tree, copy in occurrences(item, shape, self, is_item=True):
                yield tree.node(copy, shape, key=key, is_free=is_free)

    def entries(self, node: YamlMap, shape: Shape) -> Iterator[tuple[TreeEvaluator, YamlEntry]]:
        """Yield each entry of a map as often as it is there, as written, with what computes it."""
        if shape.has_names and node.entries.keys() & WORDS:
            node, tree = without_words(node, shape, self)
            yield from tree.entries(node, shape)
            return
        for written in node:
            if shape.has_names and has_expression(written.name):
                tree = self._without_for(written, shape)
                if tree is not self:
                    yield tree, written
                    continue
            if not self.expressions.change(written.value):
                yield self, written
                continue
            inner, value = shape.under(written.name), written.value
            if not shape.has_names and inner.may_repeat and isinstance(value, YamlMap) and "for" in value.entries:
                # One object that repeats is an item of the list that might stand in its place.
                yield self, YamlEntry(written.key, YamlList((value,), value.span))
                continue
            key = written.key if shape.has_names else None
            for tree, copy in occurrences(value, inner, self, key=key):
                yield tree, written if copy is value else YamlEntry(written.key, copy)

    def _without_for(self, entry: YamlEntry, shape: Shape) -> TreeEvaluator:
        """Return what computes an entry; where its key uses names that nobody gives, that is told here, and once.

        Wherever else in the entry one of them stands, it is the same `for` that is missing.
        """
        if isinstance(entry.value, YamlFault) or (isinstance(entry.value, YamlMap) and "for" in entry.value.entries):
            return self
        unknown = sorted(name for name in self.names_in(entry.key) if name not in self.scope)
        if not unknown or any(nearest(name, self.scope) for name in unknown):
            return self
        if not _has_misspelt_for(entry.value):
            example = f"for: {{{', '.join(f'{name}: …' for name in unknown)}}}"
            hint = f"; to repeat {shape.things}, write '{example}' in the entry"
            self.sink.report(UNKNOWN_NAME.at(entry.key.span, name=unknown[0], hint=hint))
        return replace(self, scope=self.scope.inside(dict.fromkeys(unknown, FAULT)))

    def _map(self, node: YamlMap, shape: Shape, is_free: bool) -> YamlMap:
        entries: dict[str, YamlEntry] = {}
        for tree, written in self.entries(node, shape):
            tree._add(entries, written, shape, is_free)
        return YamlMap(entries, node.span)

    def _add(self, entries: dict[str, YamlEntry], written: YamlEntry, around: Shape, is_free: bool) -> None:
        """Compute an entry and add it to others; of two with one key, the second is reported."""
        # The key of what is faulty stays as it is: its names may be those of the fault itself.
        key = written.key if isinstance(written.value, YamlFault) else self.key(written.key)
        if key is None or isinstance(written.value, YamlFault):
            entries.setdefault(written.name, YamlEntry(written.key, fault_of(written.value)))
        elif key.text in entries:
            self._tell_same_key(key, entries[key.text])
        else:
            value: YamlNode = written.value
            if self.expressions.change(value):
                value = self.node(value, around.under(written.name), key=key.text, is_free=is_free)
            unchanged = key is written.key and value is written.value
            entries[key.text] = written if unchanged else YamlEntry(key, value)

    def _map_value(self, node: YamlMap) -> Value | Fault:
        values: dict[str, Value] = {}
        keys: dict[str, YamlEntry] = {}
        is_sound = True
        for written in node:
            key, value = self.key(written.key), self.value(written.value)
            if key is None or value is FAULT:
                is_sound = False
            elif key.text in values:
                self._tell_same_key(key, keys[key.text])
            else:
                values[key.text], keys[key.text] = value, written
        return values if is_sound else FAULT

    def _tell_same_key(self, key: YamlScalar, first: YamlEntry) -> None:
        self.sink.report(SAME_KEY.at(key.span, name=key.text, notes=[Note("the first is here", first.key.span)]))

    def _computed(self, scalar: YamlScalar, *, is_xml: bool = False) -> Value | Fault:
        template = self.expressions.template(scalar, self.sink)
        if template is None:
            return FAULT
        return evaluate(template, self.scope_of(scalar), self.sink, is_xml=is_xml, trace=self._traced)

    def _traced(self, expression: str, where: Span) -> Span:
        """Return the place of a part of an expression as one that can tell where its value comes from."""
        return TracedSpan.computed(where, ExpressionTrace(self.expressions.alone(expression, where), self))

    def _is_made_number(self, scalar: YamlScalar, value: Value) -> bool:
        return tell_made_number(scalar, value, self.expressions, self.scope_of(scalar), self.sink)

    def _scalar(self, scalar: YamlScalar, shape: Shape, is_free: bool) -> YamlNode:
        value = self._computed(scalar, is_xml=shape.is_xml)
        is_text = is_free or shape.is_text
        if value is FAULT or (not is_text and self._is_made_number(scalar, value)):
            return YamlFault(scalar.span)
        admitted = self.expressions.admit(value, scalar.span, self.sink)
        if not admitted:
            return YamlFault(scalar.span)
        return node_of(_passed_on_in(value, shape, is_free), self.place(scalar))


def _has_misspelt_for(node: YamlNode) -> bool:
    """Whether an entry says `fro` for `for`, which was told."""
    keys = node.entries if isinstance(node, YamlMap) else {}
    return any(isinstance(entry.value, YamlFault) and nearest(name, ("for",)) for name, entry in keys.items())


def _passed_on_in(value: Value, shape: Shape, is_free: bool) -> Value:
    """Return a value with the paths in its free parts as they are passed on: nobody after this knows them there."""
    if is_free or shape.is_free_part or shape.is_xml:
        return passed_on(value)
    match value:
        case Mapping():
            return {name: _passed_on_in(item, shape.under(name), is_free) for name, item in value.items()}
        case tuple() if shape.item:
            item = shape.item
            return tuple(_passed_on_in(one, item, is_free) for one in value)
    return value
