"""Hints for values that do not match the schema: what to write instead."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any

from linkforge_compile.expressions import forgotten_expression
from linkforge_compile.schema.hint import NO_HINT, Hint, change, write
from linkforge_compile.schema.hints import FIELDS_IN_ORDER, MAY_BE_EMPTY, NO_BALL_JOINT, intended_word
from linkforge_compile.schema.json_schema import branches, mapping
from linkforge_compile.schema.list_to_map import as_entries, as_map
from linkforge_compile.schema.nesting import as_path
from linkforge_compile.schema.number_texts import (
    MOST_ITEMS,
    corrected_number,
    is_row,
    list_lengths,
    number_hint,
    numbers_in_row,
)
from linkforge_compile.schema.shapes import (
    SchemaMismatch,
    expected,
    is_number,
    is_text,
    nested,
    node_at,
    shape_at,
    shown,
    split_path,
)
from linkforge_compile.schema.srdf_habits import srdf_entries, srdf_entry
from linkforge_compile.source import Span
from linkforge_compile.syntax.colors import color_as_list
from linkforge_compile.syntax.nodes import YAML_1_1_BOOLEANS, YamlList, YamlMap, YamlNode, YamlScalar


def value_hint(mismatch: SchemaMismatch) -> Hint:
    """Return what to write for a value of the wrong kind."""
    rules = _RULES.get(type(mismatch.node), ())
    hints = (rule(mismatch.node, mismatch) for rule in rules)
    return next((hint for hint in hints if hint.ending), NO_HINT)


def word_hint(mismatch: SchemaMismatch, words: Sequence[str]) -> Hint:
    """Return what to write for a word that is not one of the allowed `words`."""
    word = mismatch.node.text if isinstance(mismatch.node, YamlScalar) else ""
    intended = intended_word(word)
    if intended and intended in words:
        return write(intended, is_safe=not _has_value_with_unit(mismatch))
    if expression := _intended_expression(mismatch):
        return write(expression)
    return Hint(NO_BALL_JOINT) if word.lower() in ("ball", "spherical") and "revolute" in words else NO_HINT


def _has_value_with_unit(mismatch: SchemaMismatch) -> bool:
    """Whether a word is the type of a parameter with a default or a bound that is no number: a dimension is meant."""
    around = node_at(mismatch.file, mismatch.path[:-1])
    if mismatch.path[:1] != ("parameters",) or not isinstance(around, YamlMap):
        return False
    values = (around.child(key) for key in ("default", "minimum", "maximum"))
    return any(isinstance(value, YamlScalar) and is_text(value) for value in values)


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


# Rules for scalars: each returns what to write, or no hint if it does not apply


def _boolean(node: YamlScalar, mismatch: SchemaMismatch) -> Hint:
    """A boolean of YAML 1.1, such as `yes`."""
    accepts_boolean = expected(mismatch.schema).startswith(("true, false", "true or false"))
    truth = YAML_1_1_BOOLEANS.get(node.text.lower()) if accepts_boolean else None
    return write(truth, is_safe=True, words=truth) if truth else NO_HINT


def _color(node: YamlScalar, mismatch: SchemaMismatch) -> Hint:
    rgb = color_as_list(node.text)
    if rgb and ("a color" in mismatch.titles or mismatch.field == "rgba"):
        return write(rgb)
    return write(f"{{color: {rgb}}}") if rgb and "a material" in mismatch.titles else NO_HINT


def _counted(node: YamlScalar, mismatch: SchemaMismatch) -> Hint:
    """`range(n)` of Python for a name of `for`, which counts to a number by itself."""
    is_name = mismatch.path[-2:-1] == ("for",) and isinstance(node.value, str)
    found = re.fullmatch(r"range\((?:0,\s*)?([^(),]+)\)", node.text) if is_name else None
    return write(f"$({found[1]})") if found else NO_HINT


def _expression(node: YamlScalar, mismatch: SchemaMismatch) -> Hint:
    intended = None if is_row(node) else _intended_expression(mismatch)
    return write(intended) if intended else NO_HINT


def _row(node: YamlScalar, mismatch: SchemaMismatch) -> Hint:
    """The numbers of an attribute of URDF, '0 0 1'."""
    if not is_row(node):
        return NO_HINT
    if mismatch.field == "origin" and len(six := numbers_in_row(node.text)) == 6:
        return write(_pose(six))
    if mismatch.accepts_kind("array"):
        numbers = numbers_in_row(node.text, list_lengths(mismatch.schema))
        # A comma may be that of a decimal number.
        return write(f"[{', '.join(numbers)}]", is_safe="," not in node.text) if numbers else NO_HINT
    return NO_HINT if corrected_number(node.text) else _list_around(mismatch)


def _list_around(mismatch: SchemaMismatch) -> Hint:
    """The whole list of an item that holds several numbers, or a part of one."""
    around, shape = node_at(mismatch.file, mismatch.path[:-1]), shape_at(mismatch.path[:-1])
    if not isinstance(around, YamlList) or len(around) > MOST_ITEMS:
        return NO_HINT
    parts = [f"{',' if _is_adjacent(before, item) else ', '}{shown(item)}" for before, item in pairwise(around)]
    numbers = numbers_in_row("".join((*map(shown, around.items[:1]), *parts)), list_lengths(shape.schema))
    if not numbers:
        return NO_HINT
    value = _as_list(numbers)
    whole = change(_field_with(mismatch.path[-2], value))
    is_in_brackets = (around.span.text or "").startswith("[")
    # Of several items, a comma may be that of a decimal number.
    return whole._replace(value=value, is_safe=len(around) == 1, around=around.span) if is_in_brackets else whole


def _number(node: YamlScalar, mismatch: SchemaMismatch) -> Hint:
    """A number in quotes, or with a decimal comma, or with spaces or underscores among its digits."""
    if not mismatch.accepts_kind("number") or not isinstance(node.value, str):
        return NO_HINT
    text = node.text.strip()
    if is_number(text):
        return write(text, is_safe=True, words=f"{text} without quotes")
    words, number = number_hint(text, mismatch.shape.unit), corrected_number(text)
    return write(number, is_safe=not re.search(r"[\s,]", text), words=words) if words and number else NO_HINT


def _mimicked_joint(node: YamlScalar, mismatch: SchemaMismatch) -> Hint:
    is_joint = mismatch.field == "mimic" and is_text(node)
    return write(f"{{joint: {node.text}}}", is_safe=True) if is_joint else NO_HINT


def _group_state(node: YamlScalar, mismatch: SchemaMismatch) -> Hint:
    """A joint value directly under a group, in place of a state's name."""
    groups = (mismatch.file.child("semantic") or mismatch.file).child("groups")
    is_state = mismatch.path[:2] == ("semantic", "group_states") and len(mismatch.path) == 4
    if not is_state or not isinstance(groups, YamlMap):
        return NO_HINT
    joint, group = mismatch.path[2:]
    is_group = group in groups.entries
    return change(f"'{group}: {{NAME: {{{joint}: {node.text}}}}}'") if is_group else NO_HINT


def _path_in_key(node: YamlScalar, mismatch: SchemaMismatch) -> Hint:
    """The value of a path written as one key, `elbow/limits/effort: 20`."""
    keys, around = split_path(str(mismatch.field)), node_at(mismatch.file, mismatch.path[:-1])
    entry = around.entries.get(str(mismatch.field)) if isinstance(around, YamlMap) else None
    is_path = len(keys) > 1 and keys[1] in mismatch.shape.keys
    return change(f"'{nested(keys, node.text)}'", as_path(keys, entry) if entry else None) if is_path else NO_HINT


def _module_file(node: YamlScalar, mismatch: SchemaMismatch) -> Hint:
    """The file of a module in place of its entry."""
    is_module = len(mismatch.path) == 2 and mismatch.path[0] == "modules"
    is_file = node.text.endswith((".yaml", ".yml", ".urdf", ".xacro"))
    return write(f"{{use: {node.text}}}", is_safe=True) if is_module and is_file else NO_HINT


def _single_item(node: YamlScalar, mismatch: SchemaMismatch) -> Hint:
    """The only item of a list, without its brackets."""
    if not is_text(node):
        return NO_HINT
    if "a group" in mismatch.titles:
        return write(f"{{joints: [{node.text}]}}")
    lists = (branch["items"] for branch in branches(mismatch.schema) if isinstance(branch.get("items"), dict))
    kinds = (kind for items in lists for kind in branches(mapping(items)))
    texts = (kind for kind in kinds if "string" in str(kind.get("type", "string")))
    is_item = any(re.search(str(kind.get("pattern", "")), node.text) for kind in texts)
    return write(f"[{node.text}]", is_safe=True) if is_item else NO_HINT


# Rules for lists


def _decimal_commas(node: YamlList, mismatch: SchemaMismatch) -> Hint:
    """A list that is too long because the decimal commas of its numbers separate items: `1,5 mm`."""
    lengths = {branch["maxItems"] for branch in branches(mismatch.schema) if "maxItems" in branch}
    items = [*map(shown, node.items[:1])]
    for before, item in pairwise(node):
        is_part = _is_adjacent(before, item) and re.fullmatch(r"[+-]?\d+", items[-1])
        if is_part and corrected_number(f"{items[-1]},{shown(item)}"):
            items[-1] += f".{shown(item)}"
        else:
            items.append(shown(item))
    return write(_as_list(items)) if len(items) < len(node) and len(items) in lengths else NO_HINT


def _fields_in_order(node: YamlList, mismatch: SchemaMismatch) -> Hint:
    """The values of an object's fields without their keys."""
    titles = mismatch.titles
    if titles & {"a material", "a visual's material"} and len(node) in (3, 4):
        return write(f"{{color: {shown(node)}}}")
    if "a group" in titles:
        return write(f"{{joints: {shown(node)}}}")
    keys = next((FIELDS_IN_ORDER[title] for title in titles if title in FIELDS_IN_ORDER), ())
    if not 0 < len(node) <= len(keys):
        return NO_HINT
    return write(f"{{{', '.join(f'{key}: {shown(item)}' for key, item in zip(keys, node, strict=False))}}}")


def _pose_of_six(node: YamlList, mismatch: SchemaMismatch) -> Hint:
    is_pose = mismatch.field == "origin" and len(node) == 6
    return write(_pose([shown(item) for item in node])) if is_pose else NO_HINT


def _pose(numbers: Sequence[str]) -> str:
    return f"{{xyz: {_as_list(numbers[:3])}, rpy: {_as_list(numbers[3:])}}}"


def _entries_by_name(node: YamlList, mismatch: SchemaMismatch) -> Hint:
    """A list in place of a map keyed by names."""
    if not any(isinstance(branch.get("additionalProperties"), dict) for branch in branches(mismatch.schema)):
        return NO_HINT
    if mismatch.path[:-1] == ("semantic",) and (entry := srdf_entry(mismatch.field, node)):
        fix = as_entries(node, srdf_entries(str(mismatch.field), node), _key_span(mismatch))
        return change(f"each entry without '-', such as '{entry}'", fix)
    first: YamlNode | None = next(iter(node), None)
    if isinstance(first, YamlMap):
        only_key = next(iter(first)).key if len(first) == 1 else None
        first = first.get("name") or only_key
    name = first.text if isinstance(first, YamlScalar) else "NAME"
    is_empty_allowed = mismatch.path[-1] in MAY_BE_EMPTY
    fix = as_map(node, _key_span(mismatch), is_empty_allowed=is_empty_allowed)
    return change(f"each entry under its name, without '-': '{name}: …'", fix)


def _key_span(mismatch: SchemaMismatch) -> Span | None:
    """Return the place of the key of the value; None for an item of a list."""
    around = node_at(mismatch.file, mismatch.path[:-1])
    return around.key_span(str(mismatch.field)) if isinstance(around, YamlMap) else None


# Rules for maps


def _interfaces(node: YamlMap, mismatch: SchemaMismatch) -> Hint:
    """An interface with parameters, which needs a map instead of a list of interfaces."""
    around = mismatch.path[-2] if len(mismatch.path) > 1 else ""
    first = next(iter(node), None)
    if first is None or around not in ("command_interfaces", "state_interfaces"):
        return NO_HINT
    items, above = (node_at(mismatch.file, mismatch.path[:-count]) for count in (1, 2))
    key = above.key_span(str(around)) if isinstance(above, YamlMap) else None
    fix = as_map(items, key, is_empty_allowed=True) if isinstance(items, YamlList) else None
    return change(f"a map instead of the list: '{around}: {{{first.name}: …}}'", fix)


def _axes(node: YamlMap, mismatch: SchemaMismatch) -> Hint:
    """The numbers of a list by the names of their axes."""
    is_vector = [entry.name for entry in node] == ["x", "y", "z"] and mismatch.accepts_kind("array")
    return _of_field(mismatch.field, _as_list([shown(entry.value) for entry in node])) if is_vector else NO_HINT


def _attribute(node: YamlMap, mismatch: SchemaMismatch) -> Hint:
    """An element of URDF with its only attribute, `{link: base}`."""
    only = next(iter(node)) if len(node) == 1 else None
    if only is None or only.name not in ("link", "value", "name", "joint", "xyz", "rgba", "size", "filename"):
        return NO_HINT
    if isinstance(only.value, YamlScalar):
        numbers = numbers_in_row(only.value.text, list_lengths(mismatch.schema))
        return _of_field(mismatch.field, _as_list(numbers) if numbers else only.value.text)
    if isinstance(only.value, YamlList) and mismatch.accepts_kind("array"):
        return _of_field(mismatch.field, _as_list([shown(item) for item in only.value]))
    return NO_HINT


def _of_field(field: str | int, value: str) -> Hint:
    return write(value, is_safe=True, words=_field_with(field, value))


def _field_with(field: str | int, value: str) -> str:
    return f"'{field}: {value}'" if isinstance(field, str) and field else f"'{value}'"


def _as_list(items: Sequence[str]) -> str:
    return f"[{', '.join(items)}]"


def _is_adjacent(before: YamlNode, item: YamlNode) -> bool:
    """Whether there is only a comma between two items."""
    return before.span.end == (item.span.line, item.span.column - 1)


_RULES: dict[type, tuple[Callable[[Any, SchemaMismatch], Hint], ...]] = {
    YamlScalar: (
        *(_boolean, _color, _counted, _expression, _row, _number),
        *(_mimicked_joint, _group_state, _path_in_key, _module_file, _single_item),
    ),
    YamlList: (_decimal_commas, _fields_in_order, _pose_of_six, _entries_by_name),
    YamlMap: (_interfaces, _axes, _attribute),
}
"""The rules by kind of node; the first that applies wins."""
