"""The texts of a spec that may be names, though no schema tells: values of parameters, what plugins read, raw XML.

Values reach names by expressions. What these compute today is known, with all parts that a `when` leaves out; other
values of parameters may choose other texts.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Collection, Iterator
from typing import NamedTuple

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.expressions import Expression, parse_template
from linkforge_compile.schema.shapes import FREE, Shape, shapes
from linkforge_compile.source import Span
from linkforge_compile.syntax import YamlList, YamlMap, YamlNode, YamlScalar, has_expression

_WITHOUT_NAMES = ("metadata", "packages", "data", "include")
"""The sections of a file that have no names of parts."""

_WORD = r"(?<![\w/.-])(?:{})(?![\w/.-])"


class FreeText(NamedTuple):
    """A text that is a name as it is or, with expressions, may match one by its `pattern`; XML may have one in it.

    It is part of the value of a parameter, variable or name of `for`, its `owner`, or written where a name may be.
    `names` are those that its expressions use, and `flowing` those of them of whose values it may consist.
    """

    span: Span
    text: str = ""
    owner: str = ""
    pattern: str = ""
    names: frozenset[str] = frozenset()
    flowing: frozenset[str] = frozenset()
    is_xml: bool = False

    def may_be(self, names: Collection[str]) -> bool:
        """Whether it may be, or contain, one of some names."""
        if self.is_xml:
            return has_word(self.text, names)
        return any(re.fullmatch(self.pattern, one) for one in names) if self.pattern else self.text in names

    @property
    def is_one_expression(self) -> bool:
        """Whether the value of expressions is all of it, so that their texts are what it may be."""
        return bool(self.pattern) and not self.pattern.replace(".*", "").strip()


def has_word(text: str, names: Collection[str]) -> bool:
    """Whether a text has one of some names as a word."""
    return bool(names) and re.search(_WORD.format("|".join(map(re.escape, names))), text) is not None


def free_texts(tree: YamlMap, places: Collection[Span]) -> Iterator[FreeText]:
    """Yield the texts of a file as written that may be other names than those that are known at some places."""
    texts = [*_in_file(tree)]
    parameters, uses = tree.section("parameters"), [(one.owner, name) for one in texts for name in one.names]
    varying = _closure({*parameters}, uses)
    of_text = _closure({name for name, entry in parameters.items() if _is_text(entry.value)}, uses)
    # Between texts, a number does not become another name.
    is_known = {
        one: one.span in places and one.names.isdisjoint(varying if one.is_one_expression else of_text) for one in texts
    }
    wholes = (one for one in texts if not one.owner and one.is_one_expression and not is_known[one])
    used = {name for one in wholes for name in one.flowing}
    used = _closure(used, [(name, one.owner) for one in texts for name in one.flowing])
    for one in texts:
        is_literal = not one.pattern and one.span not in places
        if (one.owner in used or not one.owner) if is_literal else _is_open(one) and not is_known[one]:
            yield one


def _is_open(text: FreeText) -> bool:
    return bool(text.pattern) and not text.owner and not text.is_one_expression


def _closure(names: set[str], steps: Collection[tuple[str, str]]) -> set[str]:
    """Return names with those to which steps lead from them."""
    names, before = {*names}, -1
    while len(names) > before:
        before = len(names)
        names |= {end for end, start in steps if start in names and end}
    return names


def _in_file(tree: YamlMap) -> Iterator[FreeText]:
    for section in tree.without(*_WITHOUT_NAMES):
        if section.name in ("parameters", "variables"):
            for entry in tree.section(section.name).values():
                yield from _in_value(entry.value, entry.name)
        elif section.name == "modules":
            # A name is computed from that of a module, and is none itself.
            yield from _in_node(section.value, shapes().under("modules"), has_names=False)
        elif section.name == "variants":
            for variant in tree.section("variants").values():
                for entry in variant.value if isinstance(variant.value, YamlMap) else ():
                    yield from _in_value(entry.value, entry.name)
        elif not section.name.startswith("x-"):
            # Its parts are read where an alias uses them.
            yield from _in_node(section.value, shapes().under(section.name))


def _is_text(parameter: YamlNode) -> bool:
    """Whether a parameter may be a text, or have texts in it."""
    kind = parameter.text("type") if isinstance(parameter, YamlMap) else None
    if isinstance(parameter, YamlScalar):
        return isinstance(parameter.value, str)
    return kind is None or kind in ("string", "list", "map", "file")


def _in_value(node: YamlNode, owner: str) -> Iterator[FreeText]:
    """Yield the texts in the value of a name, or in the declaration of a parameter."""
    if isinstance(node, YamlMap) and "type" in node.entries:
        node = node.without("type", "description", "pattern")
    yield from (one._replace(owner=owner) for one in _in_node(node, FREE, has_names=False))


def _in_node(node: YamlNode, shape: Shape, *, is_free: bool = False, has_names: bool = True) -> Iterator[FreeText]:
    """Yield the texts in a node; its own keys are no names of parts without `has_names`."""
    is_free = is_free or shape.is_plain or shape.is_free_part or shape.is_for_plugins
    if isinstance(node, YamlScalar):
        if is_free or shape.is_xml or (shape.is_text and has_expression(node.text)):
            yield from _in_scalar(node, is_xml=shape.is_xml)
    elif isinstance(node, YamlList):
        item = shape.item or (shape if shape.is_object or shape.is_for_plugins or shape.is_xml else FREE)
        for one in node:
            yield from _in_node(one, item, is_free=is_free)
    elif isinstance(node, YamlMap):
        for entry in node.without("when", "for"):
            if has_names and (is_free or has_expression(entry.name)):
                yield from _in_scalar(entry.key)
            yield from _in_node(entry.value, shape.under(entry.name), is_free=is_free, has_names=entry.name != "with")
        for entry in node.section("for").values():
            yield from _in_value(entry.value, entry.name)


def _in_scalar(scalar: YamlScalar, *, is_xml: bool = False) -> Iterator[FreeText]:
    if not has_expression(scalar.text):
        yield FreeText(scalar.span, scalar.text, is_xml=is_xml)
        return
    template = parse_template(scalar.text, scalar.span, Diagnostics())
    parts = template.parts if template else ()
    expressions = [part for part in parts if isinstance(part, Expression)]
    flowing = [one for part in expressions for one in _flowing(part.tree)]
    yield FreeText(
        scalar.span,
        pattern="".join(".*" if isinstance(part, Expression) else re.escape(part) for part in parts),
        names=frozenset(name.id for part in expressions for name in part.names),
        flowing=frozenset(one.id for one in flowing if isinstance(one, ast.Name)),
    )
    for part in expressions:
        for one in _flowing(part.tree):
            if isinstance(one, ast.Constant) and isinstance(one.value, str):
                yield FreeText(part.span(one), one.value)


def _flowing(node: ast.AST) -> Iterator[ast.AST]:
    """Yield the parts of an expression whose values its own may have in it: nothing that is compared, and no keys."""
    yield node
    if isinstance(node, ast.Subscript):
        yield from _flowing(node.value)
    elif not isinstance(node, ast.Compare):
        for inner in ast.iter_child_nodes(node):
            yield from _flowing(inner)
