"""What the parameters that vary from compile to compile may change, decided from the text of a file alone."""

from __future__ import annotations

from collections.abc import Iterator

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.expressions import parse_template
from linkforge_compile.syntax import YamlEntry, YamlMap, YamlNode, YamlScalar, has_expression
from linkforge_compile.syntax.nodes import leaves_in

_PLACING = ("parent", "origin", "joint", "when", "for")
"""The keys of a module that decide whether it is there and where it is attached, not what is in it."""


def varied_in_modules(tree: YamlMap, varied: frozenset[str]) -> dict[str, frozenset[str] | None]:
    """Return the parameters of each module that may vary if `varied` parameters of its user do, by its key as written.

    None for a module of which more than its parameters may vary, such as its file.
    """
    varied, modules = _varied_names(tree, varied), tree.section("modules")
    packages = tree.get("packages")  # in which any module may look for files
    if packages is not None and _names_in(packages) & varied:
        return dict.fromkeys(modules)
    return {entry.name: _varied_parameters(entry, varied) for entry in modules.values()}


def _varied_names(tree: YamlMap, varied: frozenset[str]) -> frozenset[str]:
    """Return the names of a file whose values may vary if some of its parameters do."""
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


def _varied_parameters(module: YamlEntry, varied: frozenset[str]) -> frozenset[str] | None:
    fields = module.value
    if not isinstance(fields, YamlMap):
        return None if _names_in(fields) & varied else frozenset()
    names = fields.get("for")
    for name in names if isinstance(names, YamlMap) else ():
        varied |= {name.name} if _names_in(name.value) & varied else set()
    arguments = fields.get("with")
    is_placed = "macro" not in fields.entries  # a macro may use its place in any way
    inside = fields.without("with", *_PLACING) if is_placed else fields.without("with", "when", "for")
    given = list(arguments) if isinstance(arguments, YamlMap) else []
    fixed = [module.key, inside, *(one.key for one in given), *([] if given or arguments is None else [arguments])]
    if any(_names_in(one) & varied for one in fixed):
        return None
    return frozenset(one.name for one in given if _names_in(one.value) & varied)


def _names_in(node: YamlNode) -> frozenset[str]:
    """Return the names that the expressions in a node use."""
    texts = (leaf for leaf in leaves_in(node) if isinstance(leaf, YamlScalar) and has_expression(leaf.text))
    templates = (parse_template(text.text, text.span, Diagnostics()) for text in texts)
    return frozenset().union(*(template.names for template in templates if template))
