"""Between nodes of a tree and values of expressions: what a literal means, and what a computed value becomes."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from linkforge_compile.expressions import FAULT, Fault, Value, as_text, seen_from_compiled
from linkforge_compile.source import Key, Span
from linkforge_compile.syntax import ScalarValue, YamlEntry, YamlList, YamlMap, YamlNode, YamlScalar
from linkforge_compile.units import Quantity, parse_quantity


def literal(scalar: YamlScalar) -> Value:
    """Return what a scalar without expressions means in an expression: text that is a quantity is one."""
    if isinstance(scalar.value, str):
        return parse_quantity(scalar.value) or scalar.value
    return scalar.value


def plain_value(node: YamlNode) -> Value | Fault:
    """Return what a node means in which no `$(` is an expression; FAULT where anything in it was reported."""
    match node:
        case YamlScalar():
            return literal(node)
        case YamlList():
            items = tuple(plain_value(item) for item in node)
            return FAULT if FAULT in items else tuple(item for item in items if item is not FAULT)
        case YamlMap():
            values = {entry.name: plain_value(entry.value) for entry in node}
            return (
                FAULT
                if FAULT in values.values()
                else {name: value for name, value in values.items() if value is not FAULT}
            )
    return FAULT


def node_of(value: Value, span: Span) -> YamlNode:
    """Return a computed value as a tree whose every node lies at `span`, where the expression stands, as its part.

    A scalar's text is its shortest, of a quantity the number in SI units; null has none, as if nothing were written.
    """
    if isinstance(value, tuple):
        return YamlList(tuple(node_of(item, span.inside(place)) for place, item in enumerate(value)), span)
    if isinstance(value, Mapping):
        entries = {
            name: YamlEntry(_scalar(name, span.inside(Key(name))), node_of(item, span.inside(name)))
            for name, item in value.items()
        }
        return YamlMap(entries, span)
    return _scalar(value, span)


def passed_on(value: Value) -> Value:
    """Return a value for a part that is passed on as text: with the paths in it as the compiled file writes them."""
    match value:
        case str():
            return seen_from_compiled(value)
        case tuple():
            return tuple(map(passed_on, value))
        case Mapping():
            return {name: passed_on(item) for name, item in value.items()}
    return value


class Size(NamedTuple):
    """How much a value makes: nodes and tags of raw XML, characters, and how deep lists and maps lie in one another."""

    nodes: int
    characters: int
    depth: int


def size_of(value: Value, most_nodes: int) -> Size:
    """Return how much a value makes; where it is more than `most_nodes` nodes, of those up to there.

    Values share their parts, so ten short variables may stand for a billion nodes: counting stops.
    """
    nodes = characters = depth = 0
    waiting = [(value, 0)]
    while waiting and nodes <= most_nodes:
        part, level = waiting.pop()
        nodes, depth = nodes + 1, max(depth, level)
        if isinstance(part, str):
            characters += len(part)
            nodes += part.count("<")
        elif isinstance(part, tuple):
            waiting.extend((item, level + 1) for item in part)
        elif isinstance(part, Mapping):
            characters += sum(map(len, part))
            waiting.extend((item, level + 1) for item in part.values())
    return Size(nodes, characters, depth)


def describe(value: Value) -> str:
    """Return a value as messages quote it."""
    if isinstance(value, tuple):
        return f"a list of {len(value)}"
    if isinstance(value, Mapping):
        return "a map"
    if value is None:
        return "nothing"
    return f"'{value if isinstance(value, Quantity) else as_text(value)}'"


def _scalar(value: ScalarValue, span: Span) -> YamlScalar:
    return YamlScalar(as_text(value) or "", value, span)
