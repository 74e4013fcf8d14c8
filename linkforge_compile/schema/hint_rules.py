"""Hints for values that do not match the schema: what to write instead."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any

from linkforge_compile.expressions import forgotten_expression
from linkforge_compile.schema.hints import FIELDS_IN_ORDER, NO_BALL_JOINT, color_as_list, intended_word
from linkforge_compile.schema.json_schema import Schema, branches, mapping
from linkforge_compile.schema.shapes import (
    FREE,
    SchemaMismatch,
    expected,
    is_number,
    is_text,
    nested,
    node_at,
    shapes,
    shown,
    split_path,
)
from linkforge_compile.syntax.nodes import YAML_1_1_BOOLEANS, YamlList, YamlMap, YamlNode, YamlScalar
from linkforge_compile.units import parse_quantity


def value_hint(mismatch: SchemaMismatch) -> str:
    """Return what to write for a value of the wrong kind, as the end of a message; "" for no hint."""
    rules = _RULES.get(type(mismatch.node), ())
    hint = next(filter(None, (rule(mismatch.node, mismatch) for rule in rules)), "")
    return f"; write {hint}" if hint else ""


def word_hint(mismatch: SchemaMismatch, words: Sequence[str]) -> str:
    """Return what to write for a word that is not one of the allowed `words`; "" for no hint."""
    word = mismatch.node.text if isinstance(mismatch.node, YamlScalar) else ""
    intended = intended_word(word)
    intended = intended if intended in words else _intended_expression(mismatch)
    if intended:
        return f"; write '{intended}'"
    return NO_BALL_JOINT if word.lower() in ("ball", "spherical") and "revolute" in words else ""


# Expressions

_DECLARING_SECTIONS = ("parameters", "variables", "data")
_PREDEFINED = frozenset({"name", "prefix", "standalone"})
_PYTHON_MODULE = re.compile(r"\b(?:math|numpy|np)\.")


def _intended_expression(mismatch: SchemaMismatch) -> str | None:
    """Return the expression of declared names for a text without `$( )`; None for other text."""
    node, path, _, file = mismatch
    if not isinstance(node, YamlScalar) or not isinstance(node.value, str):
        return None
    maps = [file.get(section) for section in _DECLARING_SECTIONS]
    around = (node_at(file, path[:length]) for length in range(1, len(path) + 1))
    maps += [one.get("for") for one in around if isinstance(one, YamlMap)]
    names = _PREDEFINED | {entry.name for each in maps if isinstance(each, YamlMap) for entry in each}
    return forgotten_expression(_PYTHON_MODULE.sub("", node.text), node.span, names)


# Rules for scalars: each returns what to write, or "" if it does not apply


def _boolean(node: YamlScalar, mismatch: SchemaMismatch) -> str:
    """A boolean of YAML 1.1, such as `yes`."""
    accepts_boolean = expected(mismatch.schema).startswith(("true, false", "true or false"))
    return YAML_1_1_BOOLEANS.get(node.text.lower(), "") if accepts_boolean else ""


def _color(node: YamlScalar, mismatch: SchemaMismatch) -> str:
    rgb = color_as_list(node.text)
    if rgb and ("a color" in mismatch.titles or mismatch.field == "rgba"):
        return f"'{rgb}'"
    return f"'{{color: {rgb}}}'" if rgb and "a material" in mismatch.titles else ""


def _expression(node: YamlScalar, mismatch: SchemaMismatch) -> str:
    intended = None if is_row(node) else _intended_expression(mismatch)
    return f"'{intended}'" if intended else ""


def _row(node: YamlScalar, mismatch: SchemaMismatch) -> str:
    """The numbers of an attribute of URDF, '0 0 1'."""
    if not is_row(node):
        return ""
    if mismatch.field == "origin" and len(six := numbers_in_row(node.text)) == 6:
        return _pose(six)
    if mismatch.accepts_kind("array"):
        numbers = numbers_in_row(node.text, list_lengths(mismatch.schema))
        return f"'[{', '.join(numbers)}]'" if numbers else ""
    return "" if corrected_number(node.text) else _list_around(mismatch)


def _list_around(mismatch: SchemaMismatch) -> str:
    """The whole list of an item that holds several numbers, or a part of one."""
    around, shape = node_at(mismatch.file, mismatch.path[:-1]), shapes()
    for key in mismatch.path[:-1]:
        shape = shape.under(key) if isinstance(key, str) else shape.item or FREE
    if not isinstance(around, YamlList) or len(around) > _MOST_ITEMS:
        return ""
    parts = [f"{',' if _is_adjacent(before, item) else ', '}{shown(item)}" for before, item in pairwise(around)]
    numbers = numbers_in_row("".join((*map(shown, around.items[:1]), *parts)), list_lengths(shape.schema))
    return _field_with(mismatch.path[-2], numbers) if numbers else ""


def _number(node: YamlScalar, mismatch: SchemaMismatch) -> str:
    """A number in quotes, or with a decimal comma, or with spaces or underscores among its digits."""
    if not mismatch.accepts_kind("number") or not isinstance(node.value, str):
        return ""
    text = node.text.strip()
    return f"{text} without quotes" if is_number(text) else number_hint(text, mismatch.shape.unit)


def _mimicked_joint(node: YamlScalar, mismatch: SchemaMismatch) -> str:
    return f"'{{joint: {node.text}}}'" if mismatch.field == "mimic" and is_text(node) else ""


def _group_state(node: YamlScalar, mismatch: SchemaMismatch) -> str:
    """A joint value directly under a group, in place of a state's name."""
    groups = (mismatch.file.child("semantic") or mismatch.file).child("groups")
    is_state = mismatch.path[:2] == ("semantic", "group_states") and len(mismatch.path) == 4
    if not is_state or not isinstance(groups, YamlMap):
        return ""
    joint, group = mismatch.path[2:]
    return f"'{group}: {{NAME: {{{joint}: {node.text}}}}}'" if group in groups.entries else ""


def _path_in_key(node: YamlScalar, mismatch: SchemaMismatch) -> str:
    """The value of a path written as one key, `elbow/limits/effort: 20`."""
    keys = split_path(str(mismatch.field))
    return f"'{nested(keys, node.text)}'" if len(keys) > 1 and keys[1] in mismatch.shape.keys else ""


def _module_file(node: YamlScalar, mismatch: SchemaMismatch) -> str:
    """The file of a module in place of its entry."""
    is_module = len(mismatch.path) == 2 and mismatch.path[0] == "modules"
    is_file = node.text.endswith((".yaml", ".yml", ".urdf", ".xacro"))
    return f"'{{use: {node.text}}}'" if is_module and is_file else ""


def _single_item(node: YamlScalar, mismatch: SchemaMismatch) -> str:
    """The only item of a list, without its brackets."""
    if not is_text(node):
        return ""
    if "a group" in mismatch.titles:
        return f"'{{joints: [{node.text}]}}'"
    lists = (branch["items"] for branch in branches(mismatch.schema) if isinstance(branch.get("items"), dict))
    kinds = (kind for items in lists for kind in branches(mapping(items)))
    texts = (kind for kind in kinds if "string" in str(kind.get("type", "string")))
    is_item = any(re.search(str(kind.get("pattern", "")), node.text) for kind in texts)
    return f"'[{node.text}]'" if is_item else ""


# Rules for lists


def _decimal_commas(node: YamlList, mismatch: SchemaMismatch) -> str:
    """A list that is too long because the decimal commas of its numbers separate items: `1,5 mm`."""
    lengths = {branch["maxItems"] for branch in branches(mismatch.schema) if "maxItems" in branch}
    items = [*map(shown, node.items[:1])]
    for before, item in pairwise(node):
        is_part = _is_adjacent(before, item) and re.fullmatch(r"[+-]?\d+", items[-1])
        if is_part and corrected_number(f"{items[-1]},{shown(item)}"):
            items[-1] += f".{shown(item)}"
        else:
            items.append(shown(item))
    return f"'[{', '.join(items)}]'" if len(items) < len(node) and len(items) in lengths else ""


def _fields_in_order(node: YamlList, mismatch: SchemaMismatch) -> str:
    """The values of an object's fields without their keys."""
    titles = mismatch.titles
    if titles & {"a material", "a visual's material"} and len(node) in (3, 4):
        return f"'{{color: {shown(node)}}}'"
    if "a group" in titles:
        return f"'{{joints: {shown(node)}}}'"
    keys = next((FIELDS_IN_ORDER[title] for title in titles if title in FIELDS_IN_ORDER), ())
    if not 0 < len(node) <= len(keys):
        return ""
    return f"'{{{', '.join(f'{key}: {shown(item)}' for key, item in zip(keys, node, strict=False))}}}'"


def _pose_of_six(node: YamlList, mismatch: SchemaMismatch) -> str:
    return _pose([shown(item) for item in node]) if mismatch.field == "origin" and len(node) == 6 else ""


def _pose(numbers: Sequence[str]) -> str:
    return f"'{{xyz: [{', '.join(numbers[:3])}], rpy: [{', '.join(numbers[3:])}]}}'"


def _entries_by_name(node: YamlList, mismatch: SchemaMismatch) -> str:
    """A list in place of a map keyed by names."""
    if not any(isinstance(branch.get("additionalProperties"), dict) for branch in branches(mismatch.schema)):
        return ""
    first: YamlNode | None = next(iter(node), None)
    if isinstance(first, YamlMap):
        only_key = next(iter(first)).key if len(first) == 1 else None
        first = first.get("group" if mismatch.field == "group_states" else "name") or only_key
    name = first.text if isinstance(first, YamlScalar) else "NAME"
    return f"each entry under its name, without '-': '{name}: …'"


# Rules for maps


def _interfaces(node: YamlMap, mismatch: SchemaMismatch) -> str:
    """An interface with parameters, which needs a map instead of a list of interfaces."""
    around = mismatch.path[-2] if len(mismatch.path) > 1 else ""
    first = next(iter(node), None)
    if first is None or around not in ("command_interfaces", "state_interfaces"):
        return ""
    return f"a map instead of the list: '{around}: {{{first.name}: …}}'"


def _axes(node: YamlMap, mismatch: SchemaMismatch) -> str:
    """The numbers of a list by the names of their axes."""
    is_vector = [entry.name for entry in node] == ["x", "y", "z"] and mismatch.accepts_kind("array")
    return _field_with(mismatch.field, [shown(entry.value) for entry in node]) if is_vector else ""


def _attribute(node: YamlMap, mismatch: SchemaMismatch) -> str:
    """An element of URDF with its only attribute, `{link: base}`."""
    only = next(iter(node)) if len(node) == 1 else None
    if only is None or only.name not in ("link", "value", "name", "joint", "xyz", "rgba", "size"):
        return ""
    if isinstance(only.value, YamlScalar):
        numbers = numbers_in_row(only.value.text, list_lengths(mismatch.schema))
        return _field_with(mismatch.field, numbers or only.value.text)
    if isinstance(only.value, YamlList) and mismatch.accepts_kind("array"):
        return _field_with(mismatch.field, [shown(item) for item in only.value])
    return ""


def _field_with(field: str | int, value: str | Sequence[str]) -> str:
    key = f"{field}: " if isinstance(field, str) and field else ""
    return f"'{key}{value}'" if isinstance(value, str) else f"'{key}[{', '.join(value)}]'"


_RULES: dict[type, tuple[Callable[[Any, SchemaMismatch], str], ...]] = {
    YamlScalar: (
        *(_boolean, _color, _expression, _row, _number),
        *(_mimicked_joint, _group_state, _path_in_key, _module_file, _single_item),
    ),
    YamlList: (_decimal_commas, _fields_in_order, _pose_of_six, _entries_by_name),
    YamlMap: (_interfaces, _axes, _attribute),
}
"""The rules by kind of node; the first that applies wins."""

# Numbers that YAML reads as text

_DECIMAL_COMMA = re.compile(r"([+-]?\d+),(\d+)(\s*[^\d\s,]\S*|)")
_UNDERSCORES = re.compile(r"(?<=[0-9a-fA-F])_+(?=[0-9a-fA-F])")
"""Skipped between digits by YAML 1.1 and Python, but not by YAML 1.2."""
_GROUPED = re.compile(r"([+-]?\d{1,3}(?:(?:\s\d{3})+|(?:,\d{3}){2,}))(?!\d)(.*)")
"""A number whose thousands are separated by spaces or by several commas, and the text after it."""
_THOUSANDS_COMMA = re.compile(r"([+-]?[1-9]\d{0,2}),(\d{3})(\s*[^\d\s,]\S*|)")
"""A number whose only comma may separate thousands."""
_MINUS_SIGNS = ("\u2212", "\u2013", "\u2014")
"""What word processors write for the hyphen before a number."""
_LEADING_ZERO = re.compile(r"0\d+")
_MOST_ITEMS = 100
"""The longest list that a hint writes anew."""
_LONGEST_ROW = 2000
"""The longest text, in characters, in which several numbers are looked for."""
_ANY_LENGTH = range(2, sys.maxsize)


def corrected_number(text: str) -> str | None:
    """Return a number, with its unit if it has one, as the language writes it; None for any other text."""
    if text[:1] in _MINUS_SIGNS:
        text = f"-{text[1:]}"
        return text if is_number(text) or parse_quantity(text) else corrected_number(text)
    if comma := _DECIMAL_COMMA.fullmatch(text):
        return f"{comma[1]}.{comma[2]}{comma[3]}"
    joined = _UNDERSCORES.sub("", text)
    if grouped := _GROUPED.fullmatch(joined):
        joined = re.sub(r"[\s,]", "", grouped[1]) + grouped[2]
    return joined if joined != text and (is_number(joined) or parse_quantity(joined)) else None


def number_hint(text: str, unit: str | None) -> str:
    """Return what to write for a number, both readings of `1,500`; "" for any other text.

    `unit` is the SI unit of the field: a number of another dimension gets no hint; None for any dimension.
    """
    corrected = corrected_number(text)
    quantity = parse_quantity(corrected) if corrected else None
    if corrected is None or (unit and quantity and quantity.dimension.si_unit != unit):
        return ""
    if thousands := _THOUSANDS_COMMA.fullmatch(text):
        return f"'{corrected}', or '{''.join(thousands.groups())}' if the comma separates thousands"
    return f"'{corrected}'"


def numbers_in_row(text: str, lengths: Sequence[range] = (_ANY_LENGTH,)) -> Sequence[str]:
    """Return the numbers of a text that has several, separated by spaces or commas; () for other text.

    `lengths` are the allowed counts. Commas between spaces are decimal commas if the count is then right.
    """
    if len(text) > _LONGEST_ROW or _DECIMAL_COMMA.fullmatch(text):
        return ()
    spaced = [word.strip(",") for word in text.split()]
    rows = (_numbers(words) for words in (spaced, re.split(r"[\s,]+", text.strip())))
    return next((row for row in rows if len(row) > 1 and any(len(row) in length for length in lengths)), ())


def list_lengths(schema: Schema) -> list[range]:
    """Return the allowed lengths of the lists that a schema accepts."""
    lists = (branch for branch in branches(schema) if "items" in branch)
    bounds = [(each.get("minItems", 2), each.get("maxItems", _MOST_ITEMS)) for each in lists]
    return [range(least, most + 1) for least, most in bounds if isinstance(least, int) and isinstance(most, int)]


def _numbers(words: Sequence[str]) -> Sequence[str]:
    """Return words as numbers, a unit after a number as part of it; () if one word is neither."""
    numbers: list[str] = []
    for word in words:
        if (is_number(word) and not _LEADING_ZERO.fullmatch(word)) or parse_quantity(word):
            numbers.append(word)
        elif numbers and is_number(numbers[-1]) and parse_quantity(f"{numbers[-1]} {word}"):
            numbers[-1] += f" {word}"
        elif corrected := corrected_number(word):
            numbers.append(corrected)
        else:
            return ()
    return numbers


def is_row(node: YamlNode) -> bool:
    """Whether a node is text of several numbers."""
    return isinstance(node, YamlScalar) and is_text(node) and bool(numbers_in_row(node.text))


def _is_adjacent(before: YamlNode, item: YamlNode) -> bool:
    """Whether there is only a comma between two items."""
    return before.span.end == (item.span.line, item.span.column - 1)
