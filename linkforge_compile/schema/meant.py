"""What a value that does not fit was meant for, and how that is written here."""

from __future__ import annotations

import re
from typing import NamedTuple, TypeAlias

from linkforge_compile.expressions import forgotten_expression
from linkforge_compile.schema.json_types import Schema, branches, mapping
from linkforge_compile.schema.words import expected, is_number
from linkforge_compile.syntax.nodes import YamlList, YamlMap, YamlNode, YamlScalar
from linkforge_compile.syntax.scalars import TRUTHS_OF_YAML_1_1

Path: TypeAlias = tuple[str | int, ...]


class Misfit(NamedTuple):
    """A node, the path to it in its whole file, and the schema that it does not meet."""

    node: YamlNode
    path: Path
    schema: Schema
    file: YamlMap


def way_out(misfit: Misfit) -> str:
    """Return what to write for a value of a wrong kind, as the end of a sentence; "" where it does not show."""
    node, path, schema, _ = misfit
    if isinstance(node, YamlScalar):
        truth = TRUTHS_OF_YAML_1_1.get(node.text.lower())
        if truth and "true, false" in expected(schema):
            return f"; write {truth}"
        if meant := meant_expression(misfit):
            return f"; write '{meant}'"
    if path and path[-1] in _EXAMPLES:
        return _EXAMPLES[str(path[-1])]
    if isinstance(node, YamlList) and any("additionalProperties" in branch for branch in branches(schema)):
        return _by_name(misfit)
    return _as_urdf(misfit)


def meant_expression(misfit: Misfit) -> str | None:
    """Return the expression that a text was meant for, `$( )` being forgotten; None for other text."""
    node, path, _, file = misfit
    if not isinstance(node, YamlScalar) or not isinstance(node.value, str):
        return None
    return forgotten_expression(node.text, node.span, _names_at(path, file))


_DECLARING = ("parameters", "variables", "data")
_ALWAYS_THERE = frozenset({"name", "prefix", "standalone"})


def _names_at(path: Path, file: YamlMap) -> frozenset[str]:
    """Return the names that expressions may use at a place: those of the file, and of each `for` around it."""
    maps: list[YamlNode | None] = [file.get(section) for section in _DECLARING]
    node: YamlNode | None = file
    for key in path:
        node = node.child(key) if node else None
        maps.append(node.get("for") if isinstance(node, YamlMap) else None)
    return _ALWAYS_THERE | {entry.name for each in maps if isinstance(each, YamlMap) for entry in each}


def _by_name(misfit: Misfit) -> str:
    """Return how things are written whose list says their names, or has none: a map by name."""
    first = next(iter(misfit.node), None) if isinstance(misfit.node, YamlList) else None
    key = _NAMED_BY.get(str(misfit.path[-1]), "name") if misfit.path else "name"
    said: YamlNode | None = first
    if isinstance(first, YamlMap):
        said = first.get(key) or (next(iter(first)).key if len(first) == 1 else None)
    name = said.text if isinstance(said, YamlScalar) else "NAME"
    return f"; write each under its name, without '-': '{name}: …'"


_NAMED_BY = {"group_states": "group", "disabled_collisions": "link1", "enabled_collisions": "link1"}
"""What says in SRDF under which name of ours a thing stands, where that is not its own."""


def _as_urdf(misfit: Misfit) -> str:
    """Return what to write for a value that is as URDF has it: '0 0 1' in one attribute, or `{link: base}`."""
    node, path, schema, _ = misfit
    takes_list = any("array" in str(branch.get("type")) for branch in branches(schema))
    if isinstance(node, YamlScalar) and is_row(node) and takes_list:
        return f"; write '[{', '.join(node.text.split())}]'"
    if isinstance(node, YamlScalar) and isinstance(node.value, str) and _is_item(node.text, schema):
        return f"; write '[{node.text}]'"
    if isinstance(node, YamlScalar) and is_row(node) and path and isinstance(path[-1], int):
        return f"; write '{', '.join(node.text.split())}'"
    if isinstance(node, YamlScalar) and isinstance(node.value, str) and path and path[-1] == "mimic":
        return f"; write '{{joint: {node.text}}}'"
    entries = tuple(node) if isinstance(node, YamlMap) else ()
    if entries and len(path) > 1 and path[-2] in _INTERFACES:
        return f"; write a map in place of the list: '{path[-2]}: {{{entries[0].name}: …}}'"
    if len(entries) == 1 and entries[0].name in _ATTRIBUTES and isinstance(entries[0].value, YamlScalar):
        key = f"{path[-1]}: " if path and isinstance(path[-1], str) else ""
        return f"; write '{key}{entries[0].value.text}'"
    return ""


def _is_item(text: str, schema: Schema) -> bool:
    """Whether a schema takes a list in which the text could stand."""
    items = (mapping(branch["items"]) for branch in branches(schema) if isinstance(branch.get("items"), dict))
    kinds = (kind for item in items for kind in branches(item) if "string" in str(kind.get("type", "string")))
    return any(re.search(str(kind.get("pattern", "")), text) for kind in kinds)


_INTERFACES = ("command_interfaces", "state_interfaces")
"""The lists that become maps where an item has parameters."""

_ATTRIBUTES = ("link", "value", "name", "joint")
"""Attributes of URDF that hold the whole of their element."""


def is_row(node: YamlNode) -> bool:
    """Whether it is text of several numbers with spaces between them."""
    words = node.text.split() if isinstance(node, YamlScalar) and isinstance(node.value, str) else []
    return len(words) > 1 and all(is_number(word) for word in words)


_EXAMPLES = {"for": "; write '{side: [left, right]}'"}
"""What to write under keys of which it is easily forgotten."""
