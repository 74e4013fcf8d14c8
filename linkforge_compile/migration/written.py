"""Write a template as URDF in which a number stands for each expression, for one outcome of each condition."""

from __future__ import annotations

import ast
import math
from collections.abc import Iterable, Mapping
from xml.sax.saxutils import escape, quoteattr

from linkforge_compile.load.macro_roles import DIMENSIONS
from linkforge_compile.migration.conditions import WORDS, Outcomes, decided, holds
from linkforge_compile.migration.constants import constant_of, example_of
from linkforge_compile.migration.dimensions import Placement, without_angles
from linkforge_compile.migration.formulas import Computed, negative, without_round_angle
from linkforge_compile.migration.logic import folded
from linkforge_compile.migration.placeholders import Placeholders, key_of
from linkforge_compile.migration.symbols import (
    BOOLEAN,
    NUMBER,
    TEXT,
    UNKNOWN,
    UNSET,
    NotConstantError,
    Parts,
    Reference,
    as_expression,
    as_parts,
    constant,
    is_literal,
    joined,
    kind_of,
    literal_of,
    refer,
    symbols_in,
    with_whole_paths,
)
from linkforge_compile.migration.template import Choice, Comment, Content, Element, Text
from linkforge_compile.migration.vectors import as_vector, is_data, tokens_of
from linkforge_compile.migration.without_effect import without_effect
from linkforge_compile.units import WIDEST_ANGLE, number_text

_COUNTS = {"xyz": 3, "rpy": 3, "size": 3}
NUMBERS: Mapping[tuple[str, str], tuple[int, str]] = {
    **{key: (_COUNTS.get(key[1], 1), dimension.value) for key, dimension in DIMENSIONS.items()},
    ("axis", "xyz"): (3, ""),
    ("mesh", "scale"): (3, ""),
    ("color", "rgba"): (4, ""),
    **{("inertia", f"i{axes}"): (1, "") for axes in ("xx", "yy", "zz", "xy", "xz", "yz")},
    **{("limit", name): (1, "") for name in ("lower", "upper", "effort", "velocity", "acceleration", "jerk")},
    **{("dynamics", name): (1, "") for name in ("damping", "friction")},
    **{("mimic", name): (1, "") for name in ("multiplier", "offset")},
    **{("safety_controller", f"soft_{end}_limit"): (1, "") for end in ("lower", "upper")},
    **{("safety_controller", f"k_{kind}"): (1, "") for kind in ("position", "velocity")},
    **{("calibration", edge): (1, "") for edge in ("rising", "falling")},
}
"""Attributes that are numbers: how many, and their dimension if that is always the same."""

_ANGLES = frozenset(
    (
        *(("origin", "rpy"), ("limit", "lower"), ("limit", "upper"), ("mimic", "offset")),
        *(("safety_controller", f"soft_{end}_limit") for end in ("lower", "upper")),
        *(("calibration", edge) for edge in ("rising", "falling")),
    )
)
"""Those that are an angle, of some types of joints."""

_NAMES = frozenset(("name", "link", "joint", "reference"))
_PLUGINS = frozenset(("gazebo", "ros2_control", "transmission"))


class Writer:
    """Writes the elements of one file."""

    def __init__(self, placeholders: Placeholders) -> None:
        self.placeholders = placeholders
        self.placements: list[Placement] = []
        """The expressions that were written, with the dimensions of their fields."""
        self.left_out: dict[Element, None] = {}
        """The elements that have no effect, in their order."""

    def document(self, attributes: Mapping[str, Parts], elements: Iterable[str]) -> str:
        """Return a URDF with these elements."""
        written = "".join(f" {name}={quoteattr(self.name(parts))}" for name, parts in attributes.items())
        return f"<robot{written}>{''.join(elements)}</robot>"

    def element(self, element: Element, outcomes: Outcomes, *, is_plugin: bool = False, mark: str | None = None) -> str:
        """Return an element as it is for the outcomes of its conditions, with a mark at the end of its content."""
        is_plugin = is_plugin or element.tag in _PLUGINS
        attributes = "".join(
            f" {name}={quoteattr(self._attribute((element.tag, name), parts, outcomes, is_plugin=is_plugin))}"
            for name, parts in element.attributes.items()
        )
        without = frozenset[str]()
        if not is_plugin:
            kind = ""
            if element.tag == "joint" and "type" in element.attributes:
                kind = self._attribute(("joint", "type"), element.attributes["type"], outcomes, is_plugin=False)
            without = without_effect(element.tag, kind)
        content = self.content(element.content, outcomes, is_plugin=is_plugin, without=without) + (mark or "")
        return f"<{element.tag}{attributes}>{content}</{element.tag}>" if content else f"<{element.tag}{attributes}/>"

    def content(
        self, content: Iterable[Content], outcomes: Outcomes, *, is_plugin: bool, without: frozenset[str] = frozenset()
    ) -> str:
        """Return what is in an element, without the elements of some tags."""
        pieces: list[str] = []
        for one in content:
            if isinstance(one, Element) and one.tag in without:
                self.left_out[one] = None
            elif isinstance(one, Element):
                pieces.append(self.element(one, outcomes, is_plugin=is_plugin))
            elif isinstance(one, Choice) and holds(one.test, outcomes):
                pieces.append(self.content(one.content, outcomes, is_plugin=is_plugin, without=without))
            elif isinstance(one, Text):
                pieces.append(escape(self._text(one.parts, is_plugin=is_plugin)))
            elif isinstance(one, Comment) and "--" not in one.text:
                pieces.append(f"<!--{one.text}-->")
        return "".join(pieces)

    # Values

    def _attribute(self, key: tuple[str, str], parts: Parts, outcomes: Outcomes, *, is_plugin: bool) -> str:
        if not is_plugin and key in NUMBERS:
            parts = parts if key in _ANGLES else without_angles(parts)
            if key in _ANGLES or key == ("limit", "velocity"):
                widest = WIDEST_ANGLE if key in _ANGLES else math.inf
                parts = tuple(without_round_angle(part, widest) for part in parts)
            return self._numbers(parts, *NUMBERS[key])
        if key in WORDS:
            return str(constant_of(decided(as_expression(canonical(parts)), outcomes)))
        if key[1] in _NAMES:
            return self.name(parts)
        return self._text(parts, is_plugin=is_plugin)

    def name(self, parts: Parts) -> str:
        return self._text(canonical(parts), is_plugin=True)

    def _numbers(self, parts: Parts, count: int, dimension: str) -> str:
        if is_literal(parts):
            return "".join(map(str, parts))
        if count > 1 and len(parts) == 1 and isinstance(parts[0], ast.expr):
            return self._vector(parts[0], count, dimension)
        return " ".join(self._number(token, dimension) for token in tokens_of(parts))

    def _vector(self, node: ast.expr, count: int, dimension: str) -> str:
        if literal_of(node) is not UNSET:
            return str(literal_of(node))
        try:
            known = constant_of(node)
        except NotConstantError:
            known = None
        if isinstance(known, int | float) or (isinstance(node, Reference) and node.symbol.kind == NUMBER):
            return self._number((node,), dimension)
        if isinstance(known, str) and not (isinstance(node, Reference) or is_data(node)):
            return known
        if isinstance(node, Reference) and node.symbol.value and len(node.symbol.value) > 1:
            count = len(tokens_of(node.symbol.value)) if node.symbol.role == "variable" else count
        node = as_vector(node, count)
        return " ".join(self.placeholders.number(node, component, count) for component in range(count))

    def _number(self, token: Parts, dimension: str) -> str:
        if is_literal(token):
            return "".join(map(str, token))
        match token:
            case (ast.expr() as node,):
                pass
            case ("-", Computed() as number):
                node = negative(number)
            case ("-", ast.expr() as inner):
                node = folded(ast.UnaryOp(op=ast.USub(), operand=inner))
            case ("+", ast.expr() as inner):
                node = inner
            case _:
                node = as_expression(token)
        for symbol in (one.symbol for one in _bare(node)):
            if symbol.kind in (UNKNOWN, TEXT):
                symbol.kind = NUMBER
            if dimension:
                symbol.dimensions.add(dimension)
            else:
                symbol.dimensions.add("number")
        self.placements.append((node, dimension))
        if isinstance(node, Computed):
            return self.placeholders.number(node.formula)
        literal = literal_of(node)
        return self.placeholders.number(node) if literal is UNSET else _python_text(literal)

    def _text(self, parts: Parts, *, is_plugin: bool) -> str:
        pieces: list[str] = []
        for part in with_whole_paths(parts):
            if isinstance(part, str):
                pieces.append(part)
                continue
            literal = literal_of(part)
            if isinstance(part, Reference) and part.is_as_given and len(parts) > 1:
                part.symbol.is_in_text = True
            if literal is not UNSET:
                pieces.append(_python_text(literal))
            elif _is_boolean(part) and not _is_given_in_lower_case(part):
                word = ast.IfExp(test=part, body=constant("True"), orelse=constant("False"))
                pieces.append(self.placeholders.number(word))
            else:
                pieces.append(self._text_of(part))
        return "".join(pieces)

    def _text_of(self, node: ast.expr) -> str:
        """Return the number for an expression in a text; what Python would spell differently is written as it does."""
        for symbol in symbols_in(node):
            symbol.is_written = True
        try:
            known = constant_of(node)
        except NotConstantError:
            known = None
        if isinstance(known, float) and str(known) != number_text(known):
            return str(known)
        return self.placeholders.number(_as_spelled(node) or node)


def _as_spelled(node: ast.expr) -> ast.expr | None:
    """Return alternatives of numbers as the texts that Python writes; None if the language writes the same."""
    match node:
        case Reference(symbol=symbol) if symbol.role == "variable" and symbol.value and len(symbol.value) == 1:
            return _as_spelled(as_expression(symbol.value))
        case ast.IfExp(test=test, body=body, orelse=orelse):
            sides = _as_spelled(body), _as_spelled(orelse)
            if any(sides):
                return ast.IfExp(test=test, body=sides[0] or body, orelse=sides[1] or orelse)
    value = literal_of(node)
    return constant(str(value)) if isinstance(value, float) and str(value) != number_text(value) else None


def _is_given_in_lower_case(node: ast.expr) -> bool:
    """Whether a boolean is an argument as it was given, and not in the words of Python by default."""
    return isinstance(node, Reference) and node.is_as_given and node.symbol.value not in (("True",), ("False",))


def _is_boolean(node: ast.expr) -> bool:
    """Whether an expression is a boolean, also one of data, which Python writes in its own words."""
    return kind_of(node) == BOOLEAN or isinstance(example_of(node), bool)


def _bare(node: ast.expr) -> list[Reference]:
    """Return the names whose value an expression gives: itself, or through a sign."""
    match node:
        case Reference():
            return [node]
        case ast.UnaryOp(operand=Reference() as inner):
            return [inner]
    return []


def _python_text(value: object) -> str:
    return str(value)


def canonical(parts: Parts) -> Parts:
    """Return a name with the values of variables in their places, so that equal names are equal texts."""
    made: Parts = ()
    for part in parts:
        if isinstance(part, Reference):
            symbol = part.symbol
            if symbol.role == "variable" and symbol.value is not None:
                value = canonical(symbol.value)
                if len(value) == 1 and isinstance(value[0], ast.IfExp):
                    short = refer(symbol)
                    short.canonical = key_of(value[0])
                    value = (short,)
                made = joined(made, value)
                continue
        if isinstance(part, ast.expr):
            try:
                made = joined(made, (str(constant_of(part)),))
                continue
            except NotConstantError:
                text = as_parts(part)
                if len(text) > 1:
                    made = joined(made, canonical(text))
                    continue
        made = joined(made, (part,))
    return made
