"""The texts of a spec that may be names, though no schema tells: values of parameters, what plugins read, raw XML."""

from __future__ import annotations

import ast
import re
from collections.abc import Collection, Iterator
from typing import NamedTuple

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.expressions import Expression, Template, parse_template
from linkforge_compile.schema.shapes import FREE, Shape, shapes
from linkforge_compile.source import Span
from linkforge_compile.syntax import YamlList, YamlMap, YamlNode, YamlScalar, has_expression

_WITHOUT_NAMES = ("metadata", "packages", "data", "include")
"""The sections of a file that have no names of parts."""

_WORD = r"(?<![\w/.-])(?:{})(?![\w/.-])"


class FreeText(NamedTuple):
    """A text that is one of `words`, or matches `pattern` as a whole, or has words in it if it is XML."""

    span: Span
    text: str = ""
    pattern: str = ""
    is_xml: bool = False

    def names(self, names: Collection[str]) -> bool:
        """Whether it may be, or contain, one of some names."""
        if self.is_xml:
            return has_word(self.text, names)
        return any(re.fullmatch(self.pattern, one) for one in names) if self.pattern else self.text in names


def has_word(text: str, names: Collection[str]) -> bool:
    """Whether a text has one of some names as a word."""
    return bool(names) and re.search(_WORD.format("|".join(map(re.escape, names))), text) is not None


def free_texts(tree: YamlMap) -> Iterator[FreeText]:
    """Yield the texts of a file as written; those with expressions by what is written around these."""
    for section in tree.without(*_WITHOUT_NAMES):
        if section.name in ("parameters", "variants"):
            for entry in tree.section(section.name).values():
                yield from _in_values(entry.value)
        elif not section.name.startswith("x-"):
            # Its parts are read where an alias uses them.
            yield from _in_node(section.value, shapes().under(section.name))


def _in_values(node: YamlNode) -> Iterator[FreeText]:
    """Yield the texts in a declaration of a parameter, or in the values of a variant."""
    if isinstance(node, YamlMap):
        node = node.without("type", "description", "pattern")
    yield from _in_node(node, FREE, has_names=False)


def _in_node(node: YamlNode, shape: Shape, *, is_free: bool = False, has_names: bool = True) -> Iterator[FreeText]:
    """Yield the texts in a node; its own keys are no names of parts without `has_names`."""
    is_free = is_free or shape.is_plain or shape.is_free_part or shape.is_for_plugins
    if isinstance(node, YamlScalar):
        yield from _in_scalar(node, is_free=is_free, is_xml=shape.is_xml)
    elif isinstance(node, YamlList):
        item = shape.item or (shape if shape.is_object or shape.is_for_plugins or shape.is_xml else FREE)
        for one in node:
            yield from _in_node(one, item, is_free=is_free)
    elif isinstance(node, YamlMap):
        for entry in node.without("when"):
            if has_names:
                yield from _in_scalar(entry.key, is_free=is_free, is_xml=False)
            yield from _in_node(entry.value, shape.under(entry.name), is_free=is_free, has_names=entry.name != "with")


def _in_scalar(scalar: YamlScalar, *, is_free: bool, is_xml: bool) -> Iterator[FreeText]:
    if not has_expression(scalar.text):
        if is_free or is_xml:
            yield FreeText(scalar.span, scalar.text, is_xml=is_xml)
        return
    template = parse_template(scalar.text, scalar.span, Diagnostics())
    if template is None:
        return
    if any(isinstance(part, str) and part.strip() for part in template.parts):
        yield FreeText(scalar.span, pattern=_pattern(template))
    for part in template.parts:
        if isinstance(part, Expression):
            yield from (FreeText(part.span(one), str(one.value)) for one in _texts_of(part.tree))


def _pattern(template: Template) -> str:
    return "".join(".*" if isinstance(part, Expression) else re.escape(part) for part in template.parts)


def _texts_of(node: ast.AST) -> Iterator[ast.Constant]:
    """Yield the texts in an expression that its value may have in it: not those compared, and no keys."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        yield node
    elif isinstance(node, ast.Subscript):
        yield from _texts_of(node.value)
    elif not isinstance(node, ast.Compare):
        for inner in ast.iter_child_nodes(node):
            yield from _texts_of(inner)
