"""A use of a file as it would be if all of its conditions held and no override changed it."""

from __future__ import annotations

from dataclasses import replace

from linkforge_compile.diagnostics import BeyondLimitError, Diagnostics
from linkforge_compile.expand import Instance
from linkforge_compile.expand.evaluate import Evaluator, Expressions
from linkforge_compile.expand.expand_tree import expand_node
from linkforge_compile.expand.instance import robot_part
from linkforge_compile.limits import Budget
from linkforge_compile.schema.shapes import shapes
from linkforge_compile.syntax import YamlEntry, YamlList, YamlMap, YamlNode


def unconditional_tree(instance: Instance) -> YamlMap | None:
    """Return the expanded tree of a use without its modules, with all that a `when` or an override leaves out.

    What is faulty then is omitted, such as the second of two entries with the same name. None if nothing is omitted.
    """
    evaluator = instance.names
    if instance.spec is None or not isinstance(evaluator, Evaluator):
        return None
    written = robot_part(instance.spec.tree)
    tree = _without_conditions(written)
    if tree is written and not instance.overrides:
        return None
    silent = replace(evaluator, sink=Diagnostics(), expressions=Expressions(Budget()))
    try:
        expanded = expand_node(tree, silent, shapes())
    except BeyondLimitError:
        return None
    return expanded if isinstance(expanded, YamlMap) else None


def _without_conditions(node: YamlNode) -> YamlNode:
    """Return a node without its `when`s; the node itself if it has none."""
    if isinstance(node, YamlList):
        items = tuple(map(_without_conditions, node))
        return node if items == node.items else YamlList(items, node.span)
    if not isinstance(node, YamlMap):
        return node
    entries = {one.name: (one, _without_conditions(one.value)) for one in node if one.name != "when"}
    if len(entries) == len(node) and all(value is one.value for one, value in entries.values()):
        return node
    return YamlMap({name: YamlEntry(one.key, value) for name, (one, value) in entries.items()}, node.span)
