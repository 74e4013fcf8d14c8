"""Report expressions at places where they have no meaning, and what only looks like an expression."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.diagnostics.codes.modules import NAME_OUTSIDE_TEXT, PATH_OF_THIS_MACHINE, PREFIX_TWICE
from linkforge_compile.diagnostics.codes.syntax import CURLY_QUOTES, XACRO_EXPRESSION, XACRO_IN_FREE_TEXT
from linkforge_compile.diagnostics.fix import Edit, Fix, Replacement
from linkforge_compile.schema.json_schema import LinkedSchema
from linkforge_compile.schema.shapes import FREE, Shape, field, shapes
from linkforge_compile.source import Span
from linkforge_compile.syntax import YamlEntry, YamlFault, YamlList, YamlMap, YamlNode, YamlScalar, has_expression
from linkforge_compile.syntax.nodes import xacro_facts

if TYPE_CHECKING:
    from linkforge_compile.expressions import Expression

_SUSPICIOUS = re.compile(r"\bprefix\b(?!['\"]?\s*:)|\b(?:path|link|joint)[\s)]*\(|\$\{|[“„‘]")
"""Matches every text that has to be looked at; few specs have one."""

_MARKS = ("$", "\\", "“", "„", "‘")
"""One of them is in every file with such a text; the pattern alone would be 4 % of the compile of a long file."""

_NAME_TITLES = frozenset({"a name", "a joint's name", "a material's name", "a joint value or a state's name"})
"""The titles of schemas of names, which get the prefix automatically."""

_PREFIXED_KEYS = frozenset({"topic", "frame", "prefix"})
"""Keys of text that is not a name but gets the prefix automatically."""

_NAME = Shape(LinkedSchema({"title": "a name", "type": "string"}))

_MAPS_WITHOUT_PREFIX = frozenset({"interfaces by name", "folders by package name"})
"""The titles of maps whose keys get no prefix."""

_RAW_KEYS = frozenset({"extra", "extra_attributes", "extra_inside"})

_PLUGIN_KEYS = frozenset({"filename", "hardware_plugin"})
"""Keys of text that a simulator or controller manager looks up."""

_PROSE_KEYS = frozenset({"description", "metadata"})

_COMPUTING_SECTIONS = frozenset({"parameters", "variables", "data", "variants"})
_COMPUTING_KEYS = frozenset({"with", "for", "when"})
"""Sections, and keys of objects, whose values only the compiler reads; other places without a shape are free parts."""


def check_expressions(text: str, tree: YamlMap, sink: Diagnostics) -> YamlMap:
    """Report misplaced expressions of a file with this text; return its tree with YamlFaults in their place."""
    if not any(mark in text for mark in _MARKS) or not _SUSPICIOUS.search(text):
        return tree
    checked = _Checker(sink).node(tree, _Place((), shapes()))
    assert isinstance(checked, YamlMap), "only scalars are replaced"
    return checked


class _Place(NamedTuple):
    """The path of keys to a node, its shape, and whether it lies in a free part or only serves to compute others."""

    path: tuple[str | int, ...]
    shape: Shape
    is_free: bool = False
    is_computed: bool = False

    @property
    def is_name(self) -> bool:
        is_prefixed = bool(self.path) and self.path[-1] in _PREFIXED_KEYS and self.shape.word != ""
        return not self.is_free and (self.shape.word in _NAME_TITLES or is_prefixed)

    @property
    def is_prose(self) -> bool:
        return not _PROSE_KEYS.isdisjoint(self.path)

    @property
    def is_output(self) -> bool:
        """Whether plugins read the text: a path in it cannot be `package://`, which few of them resolve."""
        return (self.is_free or self.path[-1] in _PLUGIN_KEYS) and not self.is_prose

    @property
    def words(self) -> str:
        return field(self.path)

    def under(self, key: str) -> _Place:
        """Return the place of the value of a key."""
        # `value` of the long form holds what would otherwise be written here.
        inner = self.shape if key == "value" and not self.shape.is_plain else self.shape.under(key)
        computing = _COMPUTING_KEYS if self.path else _COMPUTING_SECTIONS
        is_computed = self.is_computed or (key in computing and not self.is_free)
        is_free = not is_computed and (self.is_free or inner.is_plain or key in _RAW_KEYS)
        return _Place((*self.path, key), inner, is_free, is_computed)

    def item(self, position: int) -> _Place:
        """Return the place of an item of this list."""
        return _Place((*self.path, position), self.shape.item or FREE, self.is_free, self.is_computed)


class _Checker:
    """Walks the tree of one file."""

    def __init__(self, sink: Diagnostics) -> None:
        self._sink = sink

    def node(self, node: YamlNode, place: _Place) -> YamlNode:
        """Return a node with faults replaced; the same object if there are none."""
        match node:
            case YamlScalar():
                return node if self._is_valid(node, place) else YamlFault(node.span)
            case YamlList():
                items = tuple(self.node(item, place.item(position)) for position, item in enumerate(node))
                is_same = all(one is other for one, other in zip(items, node, strict=True))
                return node if is_same else YamlList(items, node.span)
            case YamlMap():
                entries = {entry.name: self._entry(entry, place) for entry in node}
                is_same = all(one is other for one, other in zip(entries.values(), node, strict=True))
                return node if is_same else YamlMap(entries, node.span)
        return node

    def _entry(self, entry: YamlEntry, around: _Place) -> YamlEntry:
        if not around.path and entry.name.startswith("x-"):
            return entry
        place, shape = around.under(entry.name), around.shape
        is_name = shape.has_names and shape.title not in _MAPS_WITHOUT_PREFIX and not shape.is_raw(entry.name)
        if not self._is_valid(entry.key, place._replace(shape=_NAME if is_name else FREE)):
            return YamlEntry(entry.key, YamlFault(entry.value.span))
        value = self.node(entry.value, place)
        return entry if value is entry.value else YamlEntry(entry.key, value)

    def _is_valid(self, scalar: YamlScalar, place: _Place) -> bool:
        """Whether a scalar has nothing misplaced, which is reported."""
        if not _SUSPICIOUS.search(scalar.text):
            return True
        from linkforge_compile.expressions import Expression, parse_template  # 45 ms, and few texts need it

        template = parse_template(scalar.text, scalar.span, Diagnostics()) if has_expression(scalar.text) else None
        parts = template.parts if template else (scalar.text,)
        expressions = [part for part in parts if isinstance(part, Expression)]
        # Check all before deciding, so that each fault is reported.
        names = [self._is_allowed(name, one, place) for one in expressions for name in _names_of(one)]
        # A string inside of an expression is not checked: $('${HOME}') is how to write such text.
        texts = [self._is_plain_text(part, scalar, place) for part in parts if isinstance(part, str)]
        return all(names) and all(texts)

    def _is_plain_text(self, text: str, scalar: YamlScalar, place: _Place) -> bool:
        """Whether a text outside of expressions has no xacro syntax that matters there; reports it."""
        facts = () if place.is_prose else xacro_facts(text)
        code = XACRO_IN_FREE_TEXT if place.is_free else XACRO_EXPRESSION
        for each in facts:
            self._sink.report(code.at(scalar.span, text=each["text"], ours=each["ours"]))
        if place.is_output and _is_in_curly_quotes(scalar):
            self._sink.report(CURLY_QUOTES.at(scalar.span, text=scalar.text, ours=scalar.text[1:-1]))
        return place.is_free or not facts

    def _is_allowed(self, name: ast.Name, expression: Expression, place: _Place) -> bool:
        span = expression.span(name)
        match name.id:
            case "prefix" if place.is_name:
                self._sink.report(PREFIX_TWICE.at(span, place=place.words).with_fix(_without_prefix(span)))
                return False
            case "link" | "joint" if not place.is_free:
                self._sink.report(NAME_OUTSIDE_TEXT.at(span, function=f"{name.id}()").with_fix(_name_alone(expression)))
                return False
            case "path" if not (place.is_computed or place.path[-1:] == ("use",) or place.is_output):
                self._sink.report(PATH_OF_THIS_MACHINE.at(span))
        return True


def _without_prefix(prefix: Span) -> Fix | None:
    """Return the fix that leaves out an expression that is the prefix alone, before other text."""
    whole = prefix._replace(column=prefix.column - len("$("), end_column=prefix.end_column + len(")"))
    following = prefix.file.line(prefix.line)[whole.end_column - 1 :][:1]
    is_alone = whole.text == "$(prefix)" and re.match(r"[\w$]", following)
    return Fix("remove '$(prefix)'", (Edit(whole, ""),)) if is_alone else None


def _name_alone(expression: Expression) -> Fix | None:
    """Return the fix that writes the name in place of an expression such as `$(link('base'))`; None for any other."""
    match expression.tree:
        case ast.Call(args=[ast.Constant(value=str(name))]):
            call = expression.span(expression.tree)
            whole = call._replace(column=call.column - len("$("), end_column=call.end_column + len(")"))
            is_whole = whole.text == f"$({call.text})"
            return Replacement("$(" + (call.text or "") + ")", name).within(whole) if is_whole else None
    return None


def _is_in_curly_quotes(scalar: YamlScalar) -> bool:
    """Whether a plain text starts and ends with a word processor's quotes; in a quoted text they are intended."""
    begins = (scalar.span.text or "").startswith(("“", "„", "‘"))
    return begins and scalar.text.endswith(("”", "“", "’"))


def _names_of(expression: Expression) -> Iterator[ast.Name]:
    """Yield the names in an expression, those of functions too, in the order of the text."""
    names = (node for node in ast.walk(expression.tree) if isinstance(node, ast.Name))
    return iter(sorted(names, key=lambda name: name.col_offset))
