"""What may differ in the modules of a file from compile to compile, decided from its text alone."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TypeAlias

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.expressions import parse_template
from linkforge_compile.syntax import YamlEntry, YamlMap, YamlNode, YamlScalar, has_expression
from linkforge_compile.syntax.nodes import leaves_in

Varied: TypeAlias = frozenset[str] | None
"""The parameters of a use of a file whose values may differ from compile to compile; None if more of it may."""

_PLACING = ("parent", "origin", "joint", "when")
"""The keys of a module that decide whether it is there and where it is attached, not what is in it."""


def varied_in_modules(tree: YamlMap, varied: frozenset[str]) -> dict[str, Varied]:
    """Return what may differ in each module of a file if these parameters of the file do, by its key as written."""
    varied, modules = _varied_names(tree, varied), tree.section("modules")
    packages = tree.get("packages")
    if packages is not None and _names_in(packages) & varied:
        return dict.fromkeys(modules)  # any module may look for its files in them
    return {entry.name: _varied_in_module(entry, varied) for entry in modules.values()}


def _varied_names(tree: YamlMap, varied: frozenset[str]) -> frozenset[str]:
    """Return the names of a file whose values may differ if these parameters do."""
    used = [(entry.name, _names_in(entry.value)) for entry in _declarations(tree)]
    while more := {name for name, names in used if name not in varied and names & varied}:
        varied |= more
    return varied


def _declarations(tree: YamlMap) -> Iterator[YamlEntry]:
    """Yield what gives values to names: `name`, the sections that declare names, and variants, which set parameters."""
    if name := tree.entries.get("name"):
        yield name
    for section in ("parameters", "variables", "data"):
        yield from tree.section(section).values()
    for variant in tree.section("variants").values():
        if isinstance(variant.value, YamlMap):
            yield from variant.value


def _varied_in_module(module: YamlEntry, varied: frozenset[str]) -> Varied:
    fields = module.value
    if not isinstance(fields, YamlMap):
        return None if _names_in(fields) & varied else frozenset()
    # A macro may use its place in any way. The key has all names of a `for`, so it varies with their values.
    inside = fields.without("with", *(("when",) if "macro" in fields.entries else _PLACING))
    if (_names_in(module.key) | _names_in(inside)) & varied:
        return None
    return _varied_arguments(fields.get("with"), varied)


def _varied_arguments(arguments: YamlNode | None, varied: frozenset[str]) -> Varied:
    if not isinstance(arguments, YamlMap):
        return None if arguments is not None and _names_in(arguments) & varied else frozenset()
    found = [one for one in arguments if (_names_in(one.key) | _names_in(one.value)) & varied]
    return None if any(has_expression(one.name) for one in found) else frozenset(one.name for one in found)


def _names_in(node: YamlNode) -> frozenset[str]:
    """Return the names that the expressions in a node use."""
    texts = (leaf for leaf in leaves_in(node) if isinstance(leaf, YamlScalar) and has_expression(leaf.text))
    templates = (parse_template(text.text, text.span, Diagnostics()) for text in texts)
    return frozenset().union(*(template.names for template in templates if template))
