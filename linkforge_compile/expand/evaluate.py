"""Compute the expressions of scalars, keys and plain nodes in the scope of one file, without `for` and `when`."""

from __future__ import annotations

from collections import ChainMap
from collections.abc import Container, Mapping
from dataclasses import dataclass, field, replace

from linkforge_compile.diagnostics import Diagnostics, Note
from linkforge_compile.diagnostics.codes.modules import COMPUTED_KEY, SAME_KEY, TEXT_NOT_NUMBER, TREE_TOO_LARGE
from linkforge_compile.expand.values import ExpressionTrace, Setting, plain_value, size_of
from linkforge_compile.expressions import (
    FAULT,
    Expression,
    Fault,
    Lazy,
    Scope,
    Template,
    Value,
    as_one_expression,
    as_text,
    evaluate,
    forgotten_expression,
    kind_name,
    parse_template,
)
from linkforge_compile.limits import Budget, Limit
from linkforge_compile.load.spec_tree import ExpressionScan
from linkforge_compile.source import SourceFile, Span, TracedSpan
from linkforge_compile.syntax import (
    YamlEntry,
    YamlFault,
    YamlList,
    YamlMap,
    YamlNode,
    YamlScalar,
    has_expression,
    scalar_value,
)
from linkforge_compile.units import UNITS, Quantity, parse_quantity

MAX_COMPUTED_DEPTH = 100
"""How deep the lists and maps of one value may be nested, because later stages walk them by recursion."""

_STEPS_TO_PARSE = 50
"""What parsing a text with expressions costs, in steps of expressions."""


class Expressions(ExpressionScan):
    """The parsed expressions and the budget that all evaluators of one compile share."""

    def __init__(self, budget: Budget) -> None:
        super().__init__()
        self.budget = budget
        self._templates: dict[YamlScalar, Template | None] = {}
        self._parts: dict[tuple[str, Span], YamlScalar] = {}
        self._sizes: dict[YamlList | YamlMap, tuple[int, int]] = {}

    def template(self, scalar: YamlScalar, sink: Diagnostics) -> Template | None:
        """Return the parsed text of a scalar; None for a syntax error, which is reported once."""
        if scalar not in self._templates:
            self.budget.spend(Limit.STEPS, _STEPS_TO_PARSE, scalar.span)
            self._templates[scalar] = parse_template(scalar.text, scalar.span, sink)
        return self._templates[scalar]

    def part(self, expression: str, where: Span) -> YamlScalar:
        """Return a part of an expression as a scalar, the same one each time, so that it is parsed once."""
        if (expression, where) not in self._parts:
            text = f"$({expression})"
            self._parts[expression, where] = YamlScalar(text, text, where)
        return self._parts[expression, where]

    def size(self, node: YamlNode) -> tuple[int, int]:
        """Return how many nodes a tree has, tags of raw XML included, and how many characters."""
        if isinstance(node, YamlScalar):
            return 1 + node.text.count("<"), len(node.text)
        if isinstance(node, YamlFault):
            return 1, 0
        if node not in self._sizes:
            parts = node if isinstance(node, YamlList) else (entry.value for entry in node)
            sizes = [(1, 0), *map(self.size, parts)]
            self._sizes[node] = sum(nodes for nodes, _ in sizes), sum(characters for _, characters in sizes)
        return self._sizes[node]

    def charge_copy(self, node: YamlNode, where: Span, names: int = 0) -> None:
        """Charge the budget for another copy of a node, with values for so many names of a `for`."""
        nodes, characters = self.size(node)
        self.budget.spend(Limit.VALUES, nodes + names, where)
        self.budget.spend(Limit.CHARACTERS_MADE, characters, where)

    def charge_value(self, value: Value, where: Span, sink: Diagnostics) -> bool:
        """Charge the budget for a value; False for one that is nested too deep, which is reported."""
        nodes, characters, depth = size_of(value, max(0, self.budget.left(Limit.VALUES)))
        if depth > MAX_COMPUTED_DEPTH:
            limit = f"{MAX_COMPUTED_DEPTH} lists and maps inside each other"
            sink.report(TREE_TOO_LARGE.at(where, limit=limit))
            return False
        self.budget.spend(Limit.VALUES, nodes, where)
        self.budget.spend(Limit.CHARACTERS_MADE, characters, where)
        return True


@dataclass(frozen=True)
class Evaluator:
    """Evaluates nodes of one file in one scope.

    `paths_elsewhere` has the path parameters as seen from each included file that lies in another folder. `settings`
    has what gave the names in scope their values. `disabled` collects the names that a `when` removes, and
    `disabled_prefixes` those of the modules that it removes.
    """

    scope: Scope
    expressions: Expressions
    sink: Diagnostics
    paths_elsewhere: Mapping[SourceFile, Mapping[str, Lazy]] = field(default_factory=dict)
    disabled: dict[str, Note] = field(default_factory=dict)
    disabled_prefixes: dict[str, Note] = field(default_factory=dict)
    settings: ChainMap[str, Setting] = field(default_factory=ChainMap)

    def inside(self, values: Mapping[str, Value], settings: dict[str, Setting]) -> Evaluator:
        """Return an evaluator with additional names, those of a `for`."""
        return replace(self, scope=self.scope.inside(values), settings=self.settings.new_child(settings))

    def with_faults(self, names: Mapping[str, object]) -> Evaluator:
        """Return an evaluator in which these names have faulty values, so that using them is not reported again."""
        return replace(self, scope=self.scope.inside(dict.fromkeys(names, FAULT)))

    @property
    def silent(self) -> Evaluator:
        """An evaluator that reports nothing, for parts that are omitted from the robot."""
        return replace(self, sink=Diagnostics(), expressions=Expressions(self.expressions.budget))

    def scope_of(self, scalar: YamlScalar) -> Scope:
        """Return the scope for the expressions of a scalar, which may be written in an included file."""
        paths = self.paths_elsewhere.get(scalar.span.file)
        return self.scope.inside(paths) if paths else self.scope

    def template(self, scalar: YamlScalar, sink: Diagnostics) -> Template | None:
        return self.expressions.template(scalar, sink)

    def place(self, node: YamlNode) -> Span:
        """Return the span of a node; that of an expression can trace where its value was written."""
        if isinstance(node, YamlScalar) and has_expression(node.text):
            return TracedSpan.computed(node.span, ExpressionTrace(node, self))
        return node.span

    def names_in(self, node: YamlNode) -> frozenset[str]:
        """Return the names that the expressions of a scalar use."""
        template = self.expressions.template(node, self.sink) if isinstance(node, YamlScalar) else None
        return template.names if template else frozenset()

    def value(self, node: YamlNode) -> Value | Fault:
        """Return the value of a node in expressions; FAULT if any part of it is faulty, which is reported."""
        if not self.expressions.is_computed(node):
            return plain_value(node)
        match node:
            case YamlScalar():
                return self.scalar(node)
            case YamlList():
                items = [self.value(item) for item in node]
                sound = tuple(item for item in items if item is not FAULT)
                return sound if len(sound) == len(items) else FAULT
            case YamlMap():
                return self._map(node)
        return FAULT

    def scalar(self, scalar: YamlScalar, *, is_xml: bool = False) -> Value | Fault:
        """Return the value of a scalar with expressions; `is_xml` escapes what they insert into raw XML."""
        template = self.expressions.template(scalar, self.sink)
        if template is None:
            return FAULT

        def trace(expression: str, where: Span) -> Span:
            return TracedSpan.computed(where, ExpressionTrace(self.expressions.part(expression, where), self))

        return evaluate(template, self.scope_of(scalar), self.sink, is_xml=is_xml, trace=trace)

    def _map(self, node: YamlMap) -> Value | Fault:
        values: dict[str, Value] = {}
        keys: dict[str, YamlEntry] = {}
        is_sound = True
        for entry in node:
            key, value = self.key(entry.key), self.value(entry.value)
            if key is None or value is FAULT:
                is_sound = False
            elif key.text in values:
                self.report_same_key(key, keys[key.text])
            else:
                values[key.text], keys[key.text] = value, entry
        return values if is_sound else FAULT

    def key(self, key: YamlScalar) -> YamlScalar | None:
        """Return a key with its expressions computed; None after a reported error."""
        if not has_expression(key.text):
            return key
        value = self.scalar(key)
        if value is FAULT:
            return None
        text = as_text(value)
        if text is None:
            self.sink.report(COMPUTED_KEY.at(key.span, found=kind_name(value)))
            return None
        return YamlScalar(text, text, key.span)

    def report_same_key(self, key: YamlScalar, first: YamlEntry) -> None:
        self.sink.report(SAME_KEY.at(key.span, name=key.text, notes=[Note("the first is here", first.key.span)]))


# Text that only looks like a number after expressions are interpolated: fields read numbers and units where a person
# typed them, or where the whole text is one expression.


def report_interpolated_number(
    node: YamlNode, value: Value, expressions: Expressions, names: Container[str], sink: Diagnostics
) -> bool:
    """Report text such as `$(a).5` that became a number, quantity or sum of them; return whether it did.

    `names` are those that the expressions may use.
    """
    if not isinstance(node, YamlScalar) or not isinstance(value, str) or not has_expression(node.text):
        return False
    is_number = isinstance(scalar_value(value.strip()), int | float) or parse_quantity(value) is not None
    if not is_number and forgotten_expression(value, node.span, ()) is None:
        return False
    template = expressions.template(node, sink)
    if template is None or len(template.parts) == 1:
        return False
    remedy = "make the whole one expression, such as '$(-a)'"
    if expression := as_one_expression(node.text, node.span, names):
        remedy = f"write '{expression}'"
    elif isinstance(template.parts[0], Expression) and (unit := str(template.parts[1]).strip()) in UNITS:
        remedy = f"give the unit '{unit}' where the number is written, and here '$({template.parts[0].text.strip()})'"
    fault = TEXT_NOT_NUMBER.at(node.span, text=value, remedy=remedy)
    sink.report(fault.replacing(node.text, expression, is_safe=True, is_whole=True) if expression else fault)
    return True


def report_interpolated_quantity(node: YamlNode, value: Value | Fault, evaluator: Evaluator) -> bool:
    """Report the text of a variable such as `$(reach) / 2` that is a quantity if written as one expression.

    Whatever is computed from the variable would go wrong. Returns whether it is one.
    """
    if not isinstance(value, str) or not isinstance(node, YamlScalar) or not has_expression(node.text):
        return False
    expression = as_one_expression(node.text, node.span, evaluator.scope_of(node))
    whole = YamlScalar(expression, expression, node.span) if expression else None
    if whole is None or not isinstance(replace(evaluator, sink=Diagnostics()).value(whole), Quantity):
        return False
    fault = TEXT_NOT_NUMBER.at(node.span, text=value, remedy=f"write '{expression}'")
    evaluator.sink.report(fault.replacing(node.text, whole.text, is_safe=True, is_whole=True))
    return True
