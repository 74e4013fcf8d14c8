"""Convert between nodes of a tree and values of expressions."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from linkforge_compile.expressions import FAULT, Fault, Value, as_text, seen_from_compiled
from linkforge_compile.source import Key, Span
from linkforge_compile.syntax import ScalarValue, YamlEntry, YamlList, YamlMap, YamlNode, YamlScalar
from linkforge_compile.units import Quantity, parse_quantity


def plain_value(node: YamlNode) -> Value | Fault:
    """Return the value of a node without computing `$(...)`; text such as `3 kg` is a quantity. FAULT for a fault."""
    match node:
        case YamlScalar():
            return (parse_quantity(node.value) or node.value) if isinstance(node.value, str) else node.value
        case YamlList():
            items = tuple(plain_value(item) for item in node)
            return FAULT if FAULT in items else tuple(item for item in items if item is not FAULT)
        case YamlMap():
            values = {entry.name: plain_value(entry.value) for entry in node}
            sound = {name: value for name, value in values.items() if value is not FAULT}
            return sound if len(sound) == len(values) else FAULT
    return FAULT


def node_of(value: Value, span: Span) -> YamlNode:
    """Return a value as a tree; every node gets the span of the expression, as a part of it.

    The text of a scalar is its shortest form, of a quantity the number in SI units, of null empty.
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


def _scalar(value: ScalarValue, span: Span) -> YamlScalar:
    return YamlScalar(as_text(value) or "", value, span)


def with_final_paths(value: Value) -> Value:
    """Return a value for text that the compiler does not read, with paths as the compiled file would write them."""
    match value:
        case str():
            return seen_from_compiled(value)
        case tuple():
            return tuple(map(with_final_paths, value))
        case Mapping():
            return {name: with_final_paths(item) for name, item in value.items()}
    return value


class Size(NamedTuple):
    """The size of a value: nodes (tags of raw XML included), characters, and the nesting depth of lists and maps."""

    nodes: int
    characters: int
    depth: int


def size_of(value: Value, max_nodes: int) -> Size:
    """Return the size of a value; counting stops after `max_nodes` nodes.

    Values share parts, so that ten short variables can stand for a billion nodes.
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


def describe_node(node: YamlNode) -> str:
    """Return a node as messages quote it."""
    if isinstance(node, YamlScalar):
        return f"'{node.text}'"
    return "a list" if isinstance(node, YamlList) else "a map"
