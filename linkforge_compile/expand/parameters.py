"""Parameters: how a file declares them, and whether a value is what a declaration admits."""

from __future__ import annotations

from collections.abc import Container, Iterator, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from linkforge_compile.diagnostics import Diagnostic, Diagnostics
from linkforge_compile.diagnostics.codes.model import WIDE_ANGLE
from linkforge_compile.diagnostics.codes.modules import (
    BAD_PATTERN,
    CROSSED_BOUNDS,
    NO_CHOICE,
    PARAMETER_CHOICE,
    PARAMETER_KIND,
    PARAMETER_PATTERN,
    PARAMETER_TOO_LARGE,
    PARAMETER_TOO_SMALL,
    UNFIT_CONSTRAINT,
)
from linkforge_compile.expand.evaluate_tree import TreeEvaluator
from linkforge_compile.expand.kinds import KINDS, Kind
from linkforge_compile.expand.values import describe
from linkforge_compile.expressions import FAULT, Fault, Value, forgotten_expression
from linkforge_compile.limits import Limit
from linkforge_compile.source import Span
from linkforge_compile.syntax import YamlEntry, YamlFault, YamlList, YamlMap, YamlNode, YamlScalar, has_expression
from linkforge_compile.syntax.scalars import TRUTHS_OF_YAML_1_1
from linkforge_compile.units import WIDEST_ANGLE, Dimension, Quantity, number_text, unit_text

if TYPE_CHECKING:
    from linkforge_compile.expand.patterns import Pattern

_STEPS_AN_INSTRUCTION = 4
"""What it takes to compile one instruction of a pattern, in steps of expressions."""

_CONSTRAINTS = ("minimum", "maximum", "enum", "pattern")


@dataclass(frozen=True)
class Declaration:
    """A parameter as its file declares it; `kind` is None where it follows from the default.

    `is_faulty` where a part that decides what it takes was reported already: then any value passes in silence, none
    as well.
    """

    key: YamlScalar
    kind: Kind | None = None
    default: YamlNode | None = None
    constraints: Mapping[str, YamlEntry] = field(default_factory=dict)
    is_faulty: bool = False

    @property
    def name(self) -> str:
        return self.key.text


def declarations(section: YamlNode | None) -> dict[str, Declaration]:
    """Return what the section `parameters` declares, by name."""
    return {entry.name: _declaration(entry) for entry in section} if isinstance(section, YamlMap) else {}


def _declaration(entry: YamlEntry) -> Declaration:
    declared = entry.value
    if isinstance(declared, YamlFault):
        return Declaration(entry.key, is_faulty=True)
    if isinstance(declared, YamlScalar) and declared.value is None:
        return Declaration(entry.key)
    if not isinstance(declared, YamlMap):
        return Declaration(entry.key, default=declared)
    word = declared.get("type")
    kind = KINDS.get(word.text) if isinstance(word, YamlScalar) else None
    constraints = {name: declared.entries[name] for name in _CONSTRAINTS if declared.get(name) is not None}
    default = declared.get("default")
    # A key that nobody knows may have been meant for the default that is not there.
    is_misspelt = default is None and any(isinstance(part.value, YamlFault) for part in declared)
    is_faulty = is_misspelt or (word is not None and kind is None)
    return Declaration(entry.key, kind, default, constraints, is_faulty)


@dataclass(frozen=True)
class Parameter:
    """A declaration whose constraints are computed; those that it does not have, or that are at fault, are None."""

    name: str
    kind: Kind
    minimum: Value = None
    maximum: Value = None
    choices: tuple[Value, ...] | None = None
    pattern: Pattern | None = None

    def take(self, given: Value, where: Span, sink: Diagnostics, names: Container[str]) -> Value:
        """Return the value as one of this parameter's type; None where it does not fit, which is reported.

        `names` are those that expressions may use where it is given.
        """
        value = self.kind.take(given)
        if value is None:
            found = f"{describe(given)}{self._way_out(given, where, names)}"
            sink.report(PARAMETER_KIND.at(where, parameter=self.name, expected=self.kind.words, found=found))
            return None
        violation = next(self._violations(value, where), None)
        if violation:
            sink.report(violation)
            return None
        if self.kind.name == Dimension.ANGLE and isinstance(given, int | float) and abs(given) > WIDEST_ANGLE:
            sink.report(WIDE_ANGLE.at(where, field=f"parameter '{self.name}'", found=number_text(given)))
        return value

    def _way_out(self, given: Value, where: Span, names: Container[str]) -> str:
        """Return what to write for a text that was meant as a value of another type; "" for what shows no meaning."""
        if not isinstance(given, str):
            return ""
        if self.kind is KINDS["boolean"] and (truth := TRUTHS_OF_YAML_1_1.get(given.lower())):
            return f"; write {truth}"
        meant = forgotten_expression(given, where, names)
        return f"; write '{meant}'" if meant else ""

    def _violations(self, value: Value, where: Span) -> Iterator[Diagnostic]:
        name, found = self.name, describe(value)
        if self.minimum is not None and _size(value) < _size(self.minimum):
            bound, seen = _compared(self.minimum, value)
            yield PARAMETER_TOO_SMALL.at(where, parameter=name, bound=bound, found=seen)
        if self.maximum is not None and _size(value) > _size(self.maximum):
            bound, seen = _compared(self.maximum, value)
            yield PARAMETER_TOO_LARGE.at(where, parameter=name, bound=bound, found=seen)
        if self.choices is not None and value not in self.choices:
            choices = [_plain(choice) for choice in self.choices]
            near = choices if self.kind.is_text else ()
            yield PARAMETER_CHOICE.at(where, parameter=name, choices=", ".join(choices), name=_plain(value), near=near)
        if self.pattern is not None and not self.pattern.is_in(str(value)):
            yield PARAMETER_PATTERN.at(where, parameter=name, pattern=self.pattern.text, found=found)


def parameter_of(declaration: Declaration, kind: Kind, tree: TreeEvaluator) -> Parameter:
    """Compute a declaration's constraints; one at fault is reported and left out."""
    constraints: dict[str, YamlNode] = {}
    for name, entry in declaration.constraints.items():
        if name in kind.constraints:
            constraints[name] = entry.value
        else:
            tree.sink.report(UNFIT_CONSTRAINT.at(entry.key.span, constraint=name, type=kind.name))
    bounds = Parameter(declaration.name, KINDS["number"] if kind.name == "integer" else kind)
    plain = Parameter(declaration.name, kind)
    minimum, maximum = (_constraint(bounds, constraints.get(name), tree) for name in ("minimum", "maximum"))
    if minimum is not None and maximum is not None and _size(minimum) > _size(maximum):
        where, least, most = constraints["minimum"].span, _plain(minimum), _plain(maximum)
        tree.sink.report(CROSSED_BOUNDS.at(where, parameter=declaration.name, minimum=least, maximum=most))
        minimum = maximum = None
    return Parameter(
        declaration.name,
        kind,
        minimum,
        maximum,
        choices=_choices(plain, constraints.get("enum"), tree),
        pattern=_pattern(constraints.get("pattern"), tree),
    )


def _constraint(plain: Parameter, node: YamlNode | None, tree: TreeEvaluator) -> Value:
    given = FAULT if node is None else written(node, plain.kind, tree)
    return None if node is None or given is FAULT else plain.take(given, node.span, tree.sink, tree.scope)


def _choices(plain: Parameter, node: YamlNode | None, tree: TreeEvaluator) -> tuple[Value, ...] | None:
    if not isinstance(node, YamlList):
        return None
    if not node.items:
        tree.sink.report(NO_CHOICE.at(node.span, parameter=plain.name))
        return None
    choices = [_constraint(plain, item, tree) for item in node]
    return None if None in choices else tuple(choices)


def _pattern(node: YamlNode | None, tree: TreeEvaluator) -> Pattern | None:
    if not isinstance(node, YamlScalar):
        return None
    from linkforge_compile.expand.patterns import REFUSED_STEPS, Pattern, PatternError

    try:
        pattern = Pattern(node.text)
        tree.expressions.budget.spend(Limit.STEPS, pattern.steps("") * _STEPS_AN_INSTRUCTION, node.span)
        return pattern
    except PatternError as error:
        tree.expressions.budget.spend(Limit.STEPS, REFUSED_STEPS, node.span)
        tree.sink.report(BAD_PATTERN.at(node.span, pattern=node.text, reason=error))
        return None


def written(node: YamlNode, kind: Kind, tree: TreeEvaluator) -> Value | Fault:
    """Return what a node gives to a parameter of a type, before it is judged; text takes a scalar as written."""
    if kind.is_text and isinstance(node, YamlScalar) and not has_expression(node.text):
        return node.text
    return tree.value(node)


def _size(value: Value) -> float:
    number = value.value if isinstance(value, Quantity) else value
    assert isinstance(number, int | float), "only numbers have a minimum or a maximum"
    return number


def _compared(bound: Value, value: Value) -> tuple[str, str]:
    """Return a bound and what passes it as messages show them, also in SI units where they are in different ones."""
    plain, quoted = _plain(bound), describe(value)
    if not isinstance(bound, Quantity) or not isinstance(value, Quantity):
        return plain, quoted
    if unit_text(str(bound)) == unit_text(str(value)):
        return plain, quoted
    return _with_si(plain, bound), _with_si(quoted, value)


def _with_si(text: str, quantity: Quantity) -> str:
    return text if str(quantity) == quantity.in_si else f"{text}, which is {quantity.in_si}"


def _plain(value: Value) -> str:
    return describe(value).strip("'")
