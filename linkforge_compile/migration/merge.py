"""Merge the trees that a part of a robot has for the outcomes of a condition into one with the condition in it."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator, Mapping, Sequence

from linkforge_compile.importers.spec_draft import is_same
from linkforge_compile.migration.conditions import Outcomes
from linkforge_compile.migration.logic import negated
from linkforge_compile.migration.placeholders import PLACEHOLDER, Placeholders
from linkforge_compile.migration.symbols import Part, Parts, as_expression, constant
from linkforge_compile.syntax import YamlEntry, YamlList, YamlMap, YamlNode, YamlScalar

_SHAPES = frozenset(("box", "cylinder", "sphere", "capsule", "mesh"))
_LISTS = frozenset(("visual", "collision", "gazebo", "extra"))
"""Keys of one entry or a list of them."""

_PREFIX = "$(prefix)"
_PLAIN = frozenset(("parameters", "properties"))
"""Keys of values for plugins, where anything may have a condition."""

_ZERO_UNLESS_SET = ("xyz", "rpy")

_BY_NAME = frozenset(("joints", "sensors", "gpios", "actuators", "plugins", "command_interfaces", "state_interfaces"))
"""Maps by name, whose entries have conditions and which have none."""


class CannotMergeError(Exception):
    """The alternatives have no common form; `key` is where."""

    def __init__(self, key: str) -> None:
        self.key = key
        super().__init__(key)


class Merger:
    """Merges trees with placeholders; `moved` has the keys of the results by those that they replace."""

    def __init__(self, placeholders: Placeholders) -> None:
        self._placeholders = placeholders
        self.moved: dict[YamlNode, YamlNode] = {}

    def merged(
        self, atoms: Mapping[str, ast.expr], variants: Sequence[tuple[Outcomes, YamlNode | None]]
    ) -> YamlNode | None:
        """Return one tree for those of all outcomes; None for a part that never exists."""
        if not atoms:
            return variants[0][1] if variants else None
        (key, atom), *others = atoms.items()
        sides = [[one for one in variants if one[0][key] is outcome] for outcome in (True, False)]
        trees = [self.merged(dict(others), side) for side in sides if side]
        if len(trees) == 1:
            return trees[0]
        return self._node(atom, trees[0], trees[1], "")

    def _scalar(self, node: ast.expr, where: YamlNode) -> YamlScalar:
        text = self._placeholders.number(node)
        return YamlScalar(text, text, where.span)

    def _node(
        self, test: ast.expr, one: YamlNode | None, other: YamlNode | None, key: str, *, is_plain: bool = False
    ) -> YamlNode | None:
        if is_same(one, other):
            return one if one is not None else other
        if key in _ZERO_UNLESS_SET and (one is None or other is None):
            one, other = (_zeros(other) if one is None else one), (_zeros(one) if other is None else other)
        if one is None and other is not None:
            return self._only_if(negated(test), other, "" if is_plain else key)
        if other is None and one is not None:
            return self._only_if(test, one, "" if is_plain else key)
        if key in _LISTS:
            return self._list(test, _items(one), _items(other), key)
        if is_plain and one is not None and other is not None and (_is_long(one) or _is_long(other)):
            return self._map(test, _as_long(one), _as_long(other), is_plain=True)
        match one, other:
            case YamlMap(), YamlMap():
                return self._map(test, one, other, is_plain=is_plain or key in _PLAIN)
            case YamlList(), YamlList():
                return self._list(test, one.items, other.items, key)
            case YamlScalar(), YamlScalar():
                return self._choice(test, one, other)
            case YamlMap(), _ if key == "origin":
                return self._map(test, one, _long_origin(other))
            case _, YamlMap() if key == "origin":
                return self._map(test, _long_origin(one), other)
        raise CannotMergeError(key)

    def _choice(self, test: ast.expr, one: YamlScalar, other: YamlScalar) -> YamlScalar:
        node = ast.IfExp(test=test, body=self._expression(one), orelse=self._expression(other))
        return self._scalar(node, one)

    def _expression(self, node: YamlScalar) -> ast.expr:
        if not PLACEHOLDER.search(node.text):
            is_number = type(node.value) in (int, float)
            if is_number or isinstance(node.value, bool):
                return constant(node.value)
            return as_expression(tuple(_with_prefix((node.text,))))
        return as_expression(tuple(_with_prefix(self._placeholders.parts(node.text))))

    def _only_if(self, test: ast.expr, node: YamlNode, key: str) -> YamlNode:
        """Return a node that exists only if a test is true."""
        match node:
            case YamlMap() if key in _PLAIN or key in _BY_NAME:
                return node.mapped(lambda entry: self._only_if(test, entry.value, ""))
            case YamlMap():
                return self._with_when(test, node)
            case YamlList() if key in _LISTS or not key:
                items = [self._only_if(test, item, "") for item in node]
                return YamlList(tuple(items), node.span)
            case YamlList() if key.endswith("_interfaces"):
                items = [self._long(test, item) for item in node]
                return YamlList(tuple(items), node.span)
            case YamlScalar() if not key:
                return self._long(test, node)
            case YamlScalar():
                orelse = constant(None)
                return self._scalar(ast.IfExp(test=test, body=self._expression(node), orelse=orelse), node)
            case YamlList() if key == "origin":
                return self._with_when(test, _long_origin(node))
        raise CannotMergeError(key)

    def _with_when(self, test: ast.expr, node: YamlMap) -> YamlMap:
        known = node.entries.get("when")
        if known is not None and isinstance(known.value, YamlScalar):
            test = ast.BoolOp(op=ast.And(), values=[test, self._expression(known.value)])
        when = YamlScalar("when", "when", node.span)
        entries = {"when": YamlEntry(when, self._scalar(test, node))}
        entries |= {entry.name: entry for entry in node if entry.name != "when"}
        made = YamlMap(entries, node.span)
        self.moved[node] = made
        return made

    def _long(self, test: ast.expr, item: YamlNode) -> YamlMap:
        """Return the long form of an item that is no object."""
        if isinstance(item, YamlMap):
            return self._with_when(test, item)
        keys = {name: YamlScalar(name, name, item.span) for name in ("when", "value")}
        entries = {"when": YamlEntry(keys["when"], self._scalar(test, item)), "value": YamlEntry(keys["value"], item)}
        return YamlMap(entries, item.span)

    def _map(self, test: ast.expr, one: YamlMap, other: YamlMap, *, is_plain: bool = False) -> YamlMap:
        shapes = [_SHAPES.intersection(node.entries) for node in (one, other)]
        if shapes[0] != shapes[1]:
            raise CannotMergeError("shape")
        entries: dict[str, YamlEntry] = {}
        for name in _merged_order(list(one.entries), list(other.entries)):
            sides = [node.entries.get(name) for node in (one, other)]
            known = sides[0] or sides[1]
            assert known
            values = [side.value if side else None for side in sides]
            if name == "when":
                entries[name] = YamlEntry(known.key, self._when(test, values[0], values[1], known.value))
                continue
            value = self._node(test, values[0], values[1], name, is_plain=is_plain)
            if sides[0] and sides[1]:
                self.moved[sides[1].key] = known.key
            if value is not None:
                entries[name] = YamlEntry(known.key, value)
        return YamlMap(entries, one.span)

    def _when(self, test: ast.expr, one: YamlNode | None, other: YamlNode | None, where: YamlNode) -> YamlScalar:
        """Return the condition of what exists on one condition if a test is true, and else on another."""
        sides = [self._expression(side) if isinstance(side, YamlScalar) else None for side in (one, other)]
        if sides[0] is None or sides[1] is None:
            always, side = (test, sides[1]) if sides[0] is None else (negated(test), sides[0])
            node: ast.expr = ast.BoolOp(op=ast.Or(), values=[one for one in (always, side) if one is not None])
        else:
            node = ast.IfExp(test=test, body=sides[0], orelse=sides[1])
        return self._scalar(node, where)

    def _list(self, test: ast.expr, ones: Sequence[YamlNode], others: Sequence[YamlNode], key: str) -> YamlNode:
        are_scalars = all(isinstance(item, YamlScalar) for item in (*ones, *others))
        if are_scalars and len(ones) == len(others) and not key.endswith("_interfaces"):
            items = [self._node(test, one, other, "") for one, other in zip(ones, others, strict=True)]
            return YamlList(tuple(item for item in items if item is not None), ones[0].span)
        if are_scalars and not key.endswith("_interfaces") and key not in _LISTS:
            raise CannotMergeError(key)
        made: list[YamlNode] = []
        for one, other in _aligned(ones, others):
            if one is None or other is None:
                present = one if one is not None else other
                assert present is not None
                made.append(self._long(test if one is not None else negated(test), present))
                continue
            try:
                item = self._node(test, one, other, "")
                made += [item] if item is not None else []
            except CannotMergeError:
                made += [self._long(test, one), self._long(negated(test), other)]
        return made[0] if len(made) == 1 and key in _LISTS else YamlList(tuple(made), ones[0].span)


def _with_prefix(parts: Parts) -> Iterator[Part]:
    """Yield the pieces of a text in which `$(prefix)`, which the URDF reader writes, is an expression."""
    for part in parts:
        if not isinstance(part, str):
            yield part
            continue
        for number, piece in enumerate(part.split(_PREFIX)):
            if number:
                yield ast.Name(id="prefix", ctx=ast.Load())
            if piece:
                yield piece


def _is_long(node: YamlNode) -> bool:
    """Whether a node is a value with its condition."""
    return isinstance(node, YamlMap) and node.entries.keys() == {"when", "value"}


def _as_long(node: YamlNode) -> YamlMap:
    if isinstance(node, YamlMap) and _is_long(node):
        return node
    return YamlMap({"value": YamlEntry(YamlScalar("value", "value", node.span), node)}, node.span)


def _items(node: YamlNode | None) -> tuple[YamlNode, ...]:
    if isinstance(node, YamlList):
        return node.items
    return () if node is None else (node,)


def _zeros(like: YamlNode | None) -> YamlNode | None:
    """Return a list of zeros that is as long as another one."""
    if not isinstance(like, YamlList):
        return None
    return YamlList(tuple(YamlScalar("0", 0, item.span) for item in like), like.span)


def _long_origin(node: YamlNode | None) -> YamlMap:
    if not isinstance(node, YamlList):
        raise CannotMergeError("origin")
    key = YamlScalar("xyz", "xyz", node.span)
    return YamlMap({"xyz": YamlEntry(key, node)}, node.span)


def _merged_order(ones: list[str], others: list[str]) -> list[str]:
    """Return the keys of both, in an order in which each keeps its own as far as possible."""
    made = list(ones)
    for place, name in enumerate(others):
        if name not in made:
            before = next((made.index(one) + 1 for one in reversed(others[:place]) if one in made), 0)
            made.insert(before, name)
    return made


def _aligned(ones: Sequence[YamlNode], others: Sequence[YamlNode]) -> list[tuple[YamlNode | None, YamlNode | None]]:
    """Return the items of two lists in pairs: equal ones first of all, then those between them in their order."""
    same = _common(ones, others, is_same)
    pairs: list[tuple[YamlNode | None, YamlNode | None]] = []
    start, begin = 0, 0
    for place, counterpart in [*same, (len(ones), len(others))]:
        left, right = list(ones[start:place]), list(others[begin:counterpart])
        for number in range(max(len(left), len(right))):
            pair = left[number] if number < len(left) else None, right[number] if number < len(right) else None
            pairs.append(pair)
        if place < len(ones):
            pairs.append((ones[place], others[counterpart]))
        start, begin = place + 1, counterpart + 1
    return pairs


def _common(
    ones: Sequence[YamlNode], others: Sequence[YamlNode], same: Callable[[YamlNode, YamlNode], bool]
) -> list[tuple[int, int]]:
    """Return the positions of the longest common part of two lists."""
    lengths = [[0] * (len(others) + 1) for _ in range(len(ones) + 1)]
    for i in reversed(range(len(ones))):
        for j in reversed(range(len(others))):
            longer = max(lengths[i + 1][j], lengths[i][j + 1])
            lengths[i][j] = lengths[i + 1][j + 1] + 1 if same(ones[i], others[j]) else longer
    found: list[tuple[int, int]] = []
    i = j = 0
    while i < len(ones) and j < len(others):
        if same(ones[i], others[j]):
            found.append((i, j))
            i, j = i + 1, j + 1
        elif lengths[i + 1][j] >= lengths[i][j + 1]:
            i += 1
        else:
            j += 1
    return found
