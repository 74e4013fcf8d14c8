"""What a value that does not fit was meant for, and how that is written here."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple, TypeAlias

from linkforge_compile.expressions import forgotten_expression
from linkforge_compile.schema.colors_meant import color_meant
from linkforge_compile.schema.json_types import Schema, branches, linked_part, mapping
from linkforge_compile.schema.keys_meant import nested, steps_of
from linkforge_compile.schema.numbers_meant import (
    is_row,
    lengths_of_lists,
    number_meant,
    number_to_write,
    row_meant,
    row_of_items,
    with_points,
)
from linkforge_compile.schema.shapes import FREE, Shape, shape_of, shapes
from linkforge_compile.schema.words import expected, is_number, shown
from linkforge_compile.syntax.nodes import YamlList, YamlMap, YamlNode, YamlScalar
from linkforge_compile.syntax.scalars import TRUTHS_OF_YAML_1_1

Path: TypeAlias = tuple[str | int, ...]


class Misfit(NamedTuple):
    """A node, the path to it in its whole file, and the schema that it does not meet."""

    node: YamlNode
    path: Path
    schema: Schema
    file: YamlMap

    @property
    def field(self) -> str | int:
        """The key or position that it stands at; "" for the whole file."""
        return self.path[-1] if self.path else ""

    @property
    def shape(self) -> Shape:
        return shape_of(linked_part(self.schema))

    @property
    def titles(self) -> set[str]:
        """What the schema calls the things that it takes."""
        return {str(branch.get("title")) for branch in branches(self.schema)}

    def takes(self, kind: str) -> bool:
        """Whether the schema takes something of JSON Schema's kind."""
        return any(kind in str(branch.get("type")) for branch in branches(self.schema))


def way_out(misfit: Misfit) -> str:
    """Return what to write for a value of a wrong kind, as the end of a sentence; "" where it does not show."""
    match misfit.node:
        case YamlScalar() as scalar:
            meant = next(filter(None, (find(scalar, misfit) for find in _OF_SCALARS)), "")
        case YamlList() as listed:
            meant = next(filter(None, (find(listed, misfit) for find in _OF_LISTS)), "")
        case YamlMap() as written:
            meant = next(filter(None, (find(written, misfit) for find in _OF_MAPS)), "")
        case _:
            meant = ""
    return f"; write {meant}" if meant else ""


def word_meant(misfit: Misfit, words: Sequence[str]) -> str:
    """Return what to write for a word that is none of those taken, as the end of a sentence; "" for no idea."""
    word = misfit.node.text.lower() if isinstance(misfit.node, YamlScalar) else ""
    meant = _WORDS_MEANT.get(word)
    meant = meant if meant in words else meant_expression(misfit)
    if meant:
        return f"; write '{meant}'"
    return _NO_SUCH_JOINT if word in ("ball", "spherical") and "revolute" in words else ""


# Expressions


def meant_expression(misfit: Misfit) -> str | None:
    """Return the expression that a text was meant for, `$( )` being forgotten; None for other text."""
    node, path, _, file = misfit
    if not isinstance(node, YamlScalar) or not isinstance(node.value, str):
        return None
    return forgotten_expression(_MODULE.sub("", node.text), node.span, _names_at(path, file))


_MODULE = re.compile(r"\b(?:math|numpy|np)\.")
"""What Python programs write before pi and sin."""

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


# Text and numbers: each returns what to write, "" where it was not meant


def _example(_: YamlNode, misfit: Misfit) -> str:
    return _EXAMPLES.get(str(misfit.field), "")


def _truth(node: YamlScalar, misfit: Misfit) -> str:
    takes_truth = expected(misfit.schema).startswith(("true, false", "true or false"))
    return TRUTHS_OF_YAML_1_1.get(node.text.lower(), "") if takes_truth else ""


def _color(node: YamlScalar, misfit: Misfit) -> str:
    """A color by its name, or as it stands in a style sheet."""
    rgb = color_meant(node.text)
    if rgb and ("a color" in misfit.titles or misfit.field == "rgba"):
        return f"'{rgb}'"
    return f"'{{color: {rgb}}}'" if rgb and "a material" in misfit.titles else ""


def _expression(node: YamlScalar, misfit: Misfit) -> str:
    meant = None if is_row(node) else meant_expression(misfit)
    return f"'{meant}'" if meant else ""


def _row(node: YamlScalar, misfit: Misfit) -> str:
    """The numbers of one attribute of URDF, '0 0 1'."""
    if not is_row(node):
        return ""
    if misfit.field == "origin" and len(six := row_meant(node.text)) == 6:
        return _pose(six)
    if misfit.takes("array"):
        numbers = row_meant(node.text, lengths_of_lists(misfit.schema))
        return f"'[{', '.join(numbers)}]'" if numbers else ""
    return "" if number_meant(node.text) else _row_among_items(misfit)


def _row_among_items(misfit: Misfit) -> str:
    """The list, written anew, that holds several numbers in one item, since spaces part them or commas are in them."""
    listed: YamlNode | None = misfit.file
    shape = shapes()
    for key in misfit.path[:-1]:
        listed = listed.child(key) if listed else None
        shape = shape.under(key) if isinstance(key, str) else shape.item or FREE
    if not isinstance(listed, YamlList):
        return ""
    numbers = row_of_items(listed, lengths_of_lists(shape.schema))
    return _of_field(misfit.path[-2], numbers) if numbers else ""


def _number(node: YamlScalar, misfit: Misfit) -> str:
    """A number with a decimal comma, with spaces or underscores among its digits, or in quotes."""
    if not misfit.takes("number") or not isinstance(node.value, str):
        return ""
    text = node.text.strip()
    return f"{text} without quotes" if is_number(text) else number_to_write(text, misfit.shape.unit)


def _leader(node: YamlScalar, misfit: Misfit) -> str:
    return f"'{{joint: {node.text}}}'" if misfit.field == "mimic" and isinstance(node.value, str) else ""


def _state(node: YamlScalar, misfit: Misfit) -> str:
    """A joint, a group and a value of it, where a group has states."""
    groups = (misfit.file.child("semantic") or misfit.file).child("groups")
    if misfit.path[:2] != ("semantic", "group_states") or len(misfit.path) != 4 or not isinstance(groups, YamlMap):
        return ""
    joint, group = misfit.path[2:]
    return f"'{group}: {{NAME: {{{joint}: {node.text}}}}}'" if group in groups.entries else ""


def _way(node: YamlScalar, misfit: Misfit) -> str:
    """A value of an entry whose key is the way to it: `elbow/limits/effort: 20`."""
    keys = steps_of(str(misfit.field))
    return f"'{nested(keys, node.text)}'" if len(keys) > 1 and keys[1] in misfit.shape.keys else ""


def _use(node: YamlScalar, misfit: Misfit) -> str:
    """The file of a module in place of its entry."""
    is_module = len(misfit.path) == 2 and misfit.path[0] == "modules"
    return f"'{{use: {node.text}}}'" if is_module and node.text.endswith(_FILES_OF_MODULES) else ""


def _item(node: YamlScalar, misfit: Misfit) -> str:
    """One thing where a list of them belongs."""
    if not isinstance(node.value, str):
        return ""
    if "a group" in misfit.titles:
        return f"'{{joints: [{node.text}]}}'"
    lists = (branch["items"] for branch in branches(misfit.schema) if isinstance(branch.get("items"), dict))
    kinds = (kind for items in lists for kind in branches(mapping(items)))
    texts = (kind for kind in kinds if "string" in str(kind.get("type", "string")))
    fits = any(re.search(str(kind.get("pattern", "")), node.text) for kind in texts)
    return f"'[{node.text}]'" if fits else ""


# Lists


def _decimal_commas(node: YamlList, misfit: Misfit) -> str:
    """A list that is too long, since the commas in its numbers part it as well."""
    counts = {branch["maxItems"] for branch in branches(misfit.schema) if "maxItems" in branch}
    meant = with_points(node)
    return f"'[{', '.join(meant)}]'" if len(meant) < len(node) and len(meant) in counts else ""


def _object_in_order(node: YamlList, misfit: Misfit) -> str:
    """The values of an object's fields without their keys."""
    titles = misfit.titles
    if titles & {"a material", "a visual's material"} and len(node) in (3, 4):
        return f"'{{color: {shown(node)}}}'"
    if "a group" in titles:
        return f"'{{joints: {shown(node)}}}'"
    keys = next((_IN_ORDER[title] for title in titles if title in _IN_ORDER), ())
    if not 0 < len(node) <= len(keys):
        return ""
    return f"'{{{', '.join(f'{key}: {shown(item)}' for key, item in zip(keys, node, strict=False))}}}'"


def _six_of_a_pose(node: YamlList, misfit: Misfit) -> str:
    return _pose([shown(item) for item in node]) if misfit.field == "origin" and len(node) == 6 else ""


def _pose(numbers: Sequence[str]) -> str:
    return f"'{{xyz: [{', '.join(numbers[:3])}], rpy: [{', '.join(numbers[3:])}]}}'"


def _by_name(node: YamlList, misfit: Misfit) -> str:
    """Things whose list says their names, or has none, where they stand in a map by name."""
    if not any(isinstance(branch.get("additionalProperties"), dict) for branch in branches(misfit.schema)):
        return ""
    said: YamlNode | None = next(iter(node), None)
    if isinstance(said, YamlMap):
        only = next(iter(said)).key if len(said) == 1 else None
        said = said.get(_NAMED_BY.get(str(misfit.field), "name")) or only
    name = said.text if isinstance(said, YamlScalar) else "NAME"
    return f"each under its name, without '-': '{name}: …'"


# Maps


def _interfaces(node: YamlMap, misfit: Misfit) -> str:
    """An interface with parameters in a list, of which it makes a map."""
    around = misfit.path[-2] if len(misfit.path) > 1 else ""
    first = next(iter(node), None)
    return f"a map in place of the list: '{around}: {{{first.name}: …}}'" if first and around in _INTERFACES else ""


def _parts(node: YamlMap, misfit: Misfit) -> str:
    """The numbers of a list by the names of their axes."""
    named = [entry.name for entry in node] == ["x", "y", "z"]
    return _of_field(misfit.field, [shown(entry.value) for entry in node]) if named and misfit.takes("array") else ""


def _attribute(node: YamlMap, misfit: Misfit) -> str:
    """An element of URDF with its one attribute, `{link: base}`."""
    only = next(iter(node)) if len(node) == 1 else None
    if only is None or only.name not in _ATTRIBUTES:
        return ""
    if isinstance(only.value, YamlScalar):
        return _of_field(misfit.field, row_meant(only.value.text, lengths_of_lists(misfit.schema)) or only.value.text)
    if isinstance(only.value, YamlList) and misfit.takes("array"):
        return _of_field(misfit.field, [shown(item) for item in only.value])
    return ""


def _of_field(field: str | int, value: str | Sequence[str]) -> str:
    key = f"{field}: " if isinstance(field, str) and field else ""
    return f"'{key}{value}'" if isinstance(value, str) else f"'{key}[{', '.join(value)}]'"


_OF_SCALARS: tuple[Callable[[YamlScalar, Misfit], str], ...] = (
    _truth,
    _color,
    _expression,
    _example,
    _row,
    _number,
    _leader,
    _state,
    _way,
    _use,
    _item,
)
_OF_LISTS = (_example, _decimal_commas, _object_in_order, _six_of_a_pose, _by_name)
_OF_MAPS: tuple[Callable[[YamlMap, Misfit], str], ...] = (_interfaces, _parts, _attribute)

_EXAMPLES = {"for": "'{side: [left, right]}'"}
"""What to write under keys of which it is easily forgotten."""

_FILES_OF_MODULES = (".yaml", ".yml", ".urdf", ".xacro")

_INTERFACES = ("command_interfaces", "state_interfaces")
"""The lists that become maps where an item has parameters."""

_NAMED_BY = {"group_states": "group", "disabled_collisions": "link1", "enabled_collisions": "link1"}
"""What says in SRDF under which name of ours a thing stands, where that is not its own."""

_ATTRIBUTES = ("link", "value", "name", "joint", "xyz", "rgba", "size")
"""Attributes of URDF that hold the whole of their element."""

_IN_ORDER: Mapping[str, Sequence[str]] = {
    "a cylinder": ("radius", "length"),
    "a capsule": ("radius", "length"),
    "a joint's limits": ("lower", "upper", "effort", "velocity"),
    "a joint's dynamics": ("damping", "friction"),
    "a chain": ("base_link", "tip_link"),
    "an inertia tensor": ("ixx", "iyy", "izz"),
}
"""Objects whose fields have an order that everybody thinks of."""

_NO_SUCH_JOINT = "; URDF has no such joint: write three revolute ones that share a place"

_WORDS_MEANT = {
    "float": "number",
    "double": "number",
    "int": "integer",
    "str": "string",
    "bool": "boolean",
    "path": "file",
    "array": "list",
    "dict": "map",
    "hinge": "revolute",
    "rotary": "revolute",
    "rotational": "revolute",
    "rotation": "revolute",
    "slider": "prismatic",
    "slide": "prismatic",
    "linear": "prismatic",
    "translational": "prismatic",
    "rigid": "fixed",
    "weld": "fixed",
    "static": "fixed",
    "free": "floating",
    "depth": "depth_camera",
    "gpu_ray": "gpu_lidar",
    "laser": "lidar",
    "+x": "x",
    "+y": "y",
    "+z": "z",
}
"""Words of other languages and formats for those of this one."""
