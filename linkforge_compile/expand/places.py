"""Judges where `prefix`, `link()`, `joint()`, `path()` and xacro's `${...}` may stand, which not every place takes."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from typing import NamedTuple

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.diagnostics.codes.files import NAME_OUTSIDE_TEXT, PATH_OF_THIS_MACHINE, PREFIX_TWICE
from linkforge_compile.diagnostics.codes.syntax import CURLY_QUOTES, XACRO_EXPRESSION, XACRO_IN_FREE_TEXT
from linkforge_compile.expand.telltale import TELLTALE
from linkforge_compile.expressions import Expression, parse_template
from linkforge_compile.schema.json_types import LinkedSchema
from linkforge_compile.schema.shapes import FREE, Shape, shapes
from linkforge_compile.schema.words import field
from linkforge_compile.syntax import YamlEntry, YamlFault, YamlList, YamlMap, YamlNode, YamlScalar, has_expression
from linkforge_compile.syntax.scalars import xacro_facts

_NAMES = frozenset({"a name", "a joint's name", "a material's name", "a joint value or a state's name"})
"""The titles of schemas whose text is a name, which takes the prefix by itself."""

_PREFIXED_KEYS = frozenset({"topic", "frame", "prefix"})
"""Keys of what is no name and takes the prefix all the same."""

_NAME = Shape(LinkedSchema({"title": "a name", "type": "string"}))
"""The shape of a key that is a name."""

_WITHOUT_PREFIX = frozenset({"interfaces by name", "folders by package name"})
"""The titles of maps whose keys take no prefix."""

_READ_BY_PLUGINS = frozenset({"extra", "extra_attributes", "extra_inside"})

_PLUGINS = frozenset({"filename", "hardware_plugin"})
"""Keys whose text a simulator or a controller manager looks for."""

_FOR_PEOPLE = frozenset({"description", "metadata"})
"""Keys whose text no reader takes for anything but text."""

_COMPUTED = frozenset({"parameters", "variables", "data", "variants"})
_COMPUTED_WITHIN = frozenset({"with", "for", "when"})
"""The sections, and the keys of objects, whose values the compiler reads; what else has no shape is a free part."""


def judge_places(tree: YamlMap, sink: Diagnostics) -> YamlMap:
    """Report what stands where it means nothing; return the tree with a YamlFault in its place."""
    judged = _Judge(sink).node(tree, _Place((), shapes()))
    assert isinstance(judged, YamlMap), "what is judged is scalars"
    return judged


class _Place(NamedTuple):
    """Where a node stands: the keys that lead to it, its shape, and what all that is in it counts as.

    What is computed comes to nothing by itself; only its use is an output.
    """

    path: tuple[str | int, ...]
    shape: Shape
    is_free: bool = False
    is_computed: bool = False

    @property
    def is_name(self) -> bool:
        is_prefixed = bool(self.path) and self.path[-1] in _PREFIXED_KEYS and self.shape.word != ""
        return not self.is_free and (self.shape.word in _NAMES or is_prefixed)

    @property
    def words(self) -> str:
        return field(self.path)

    def under(self, key: str) -> _Place:
        """Return the place of what stands under a key or name."""
        # The long form's `value` is what would stand here without it.
        inner = self.shape if key == "value" and not self.shape.is_plain else self.shape.under(key)
        computed = _COMPUTED_WITHIN if self.path else _COMPUTED
        is_computed = self.is_computed or (key in computed and not self.is_free)
        is_free = not is_computed and (self.is_free or inner.is_plain or key in _READ_BY_PLUGINS)
        return _Place((*self.path, key), inner, is_free, is_computed)

    def item(self, position: int) -> _Place:
        """Return the place of an item of the list that stands here."""
        return _Place((*self.path, position), self.shape.item or FREE, self.is_free, self.is_computed)


class _Judge:
    """One walk through the tree of a file."""

    def __init__(self, sink: Diagnostics) -> None:
        self._sink = sink

    def node(self, node: YamlNode, place: _Place) -> YamlNode:
        """Return a node as it may go on; what has nothing at fault is the same object."""
        match node:
            case YamlScalar():
                return node if self._is_sound(node, place) else YamlFault(node.span)
            case YamlList():
                items = tuple(self.node(item, place.item(position)) for position, item in enumerate(node))
                return node if all(map(_is_same, items, node)) else YamlList(items, node.span)
            case YamlMap():
                entries = {entry.name: self._entry(entry, place) for entry in node}
                return node if all(map(_is_same, entries.values(), node)) else YamlMap(entries, node.span)
        return node

    def _entry(self, entry: YamlEntry, around: _Place) -> YamlEntry:
        if not around.path and entry.name.startswith("x-"):
            return entry
        place = around.under(entry.name)
        named = (
            around.shape.has_names and around.shape.title not in _WITHOUT_PREFIX and not around.shape.is_raw(entry.name)
        )
        if not self._is_sound(entry.key, place._replace(shape=_NAME if named else FREE)):
            return YamlEntry(entry.key, YamlFault(entry.value.span))
        value = self.node(entry.value, place)
        return entry if value is entry.value else YamlEntry(entry.key, value)

    def _is_sound(self, scalar: YamlScalar, place: _Place) -> bool:
        """Whether all that a scalar says may stand there; reports what may not."""
        if not TELLTALE.search(scalar.text):
            return True
        template = parse_template(scalar.text, scalar.span, Diagnostics()) if has_expression(scalar.text) else None
        parts = template.parts if template else (scalar.text,)
        found = [part for part in parts if isinstance(part, Expression)]
        judged = [self._may_stand(name, expression, place) for expression in found for name in _used(expression)]
        # A text within an expression is the way out for who wants these characters: $('${HOME}').
        texts = [self._is_ours(part, scalar, place) for part in parts if isinstance(part, str)]
        return all(judged) and all(texts)

    def _is_ours(self, text: str, scalar: YamlScalar, place: _Place) -> bool:
        """Whether a text without expressions of ours may go on as it is; reports xacro's."""
        facts = () if _FOR_PEOPLE.intersection(place.path) else xacro_facts(text)
        code = XACRO_IN_FREE_TEXT if place.is_free else XACRO_EXPRESSION
        for each in facts:
            self._sink.report(code.at(scalar.span, text=each["text"], ours=each["ours"]))
        goes_on = place.is_free or place.path[-1] in _PLUGINS
        if goes_on and not _FOR_PEOPLE.intersection(place.path) and _is_in_curly_quotes(scalar):
            self._sink.report(CURLY_QUOTES.at(scalar.span, text=scalar.text, ours=scalar.text[1:-1]))
        return place.is_free or not facts

    def _may_stand(self, name: ast.Name, expression: Expression, place: _Place) -> bool:
        span = expression.span(name)
        match name.id:
            case "prefix" if place.is_name:
                self._sink.report(PREFIX_TWICE.at(span, place=place.words))
                return False
            case "link" | "joint" if not place.is_free:
                self._sink.report(NAME_OUTSIDE_TEXT.at(span, function=f"{name.id}()"))
                return False
            case "path" if not (place.is_computed or place.path[-1:] == ("use",)):
                self._sink.report(PATH_OF_THIS_MACHINE.at(span))
        return True


def _is_in_curly_quotes(scalar: YamlScalar) -> bool:
    """Whether a text has the quotes of word processors around it; in YAML's own quotes they are meant as letters."""
    begins = (scalar.span.text or "").startswith(("“", "„", "‘"))
    return begins and scalar.text.endswith(("”", "“", "’"))


def _used(expression: Expression) -> Iterator[ast.Name]:
    """Yield the names of an expression, those of its functions too, in the order of the text."""
    names = (node for node in ast.walk(expression.tree) if isinstance(node, ast.Name))
    return iter(sorted(names, key=lambda name: name.col_offset))


def _is_same(one: object, other: object) -> bool:
    return one is other
