"""Compute an expression of Python of which all names are known, with what of Python changes nothing."""

from __future__ import annotations

import ast
import math
import operator
import re
from collections.abc import Callable, Iterable, Mapping
from typing import Any

_OPERATORS: Mapping[type[ast.AST], Callable[..., Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.FloorDiv: operator.floordiv,
    ast.Mod: operator.mod,
    ast.Pow: operator.pow,
    ast.USub: operator.neg,
    ast.UAdd: operator.pos,
    ast.Not: operator.not_,
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
    ast.Is: operator.is_,
    ast.IsNot: operator.is_not,
    ast.In: lambda item, items: item in items,
    ast.NotIn: lambda item, items: item not in items,
}
_FUNCTIONS: Mapping[str, Callable[..., Any]] = {
    **{name: getattr(math, name) for name in ("sqrt", "sin", "cos", "tan", "asin", "acos", "atan2", "floor", "ceil")},
    **{"radians": math.radians, "degrees": math.degrees, "min": min, "max": max, "abs": abs},
    **{"len": len, "int": int, "float": float, "str": str},
}
_MOST_BASE = 1e12
"""The largest base of a power."""

_MOST_BITS = 4096
"""The longest whole numbers together that are computed with."""

_MOST_CHARACTERS = 100_000
"""The size of all texts and lists together that one expression makes: characters and items."""

_WIDTH = re.compile(r"%(?:\(|[^a-zA-Z%]*(?:\d{4}|\*))")
"""A `%` that makes a text as long as a number in it says; one with the name of a value may hide such a number."""


_METHODS = frozenset(
    (
        *("split", "rsplit", "strip", "lstrip", "rstrip", "replace", "startswith", "endswith", "lower", "upper"),
        *("join", "get", "keys", "values", "items", "index", "count", "capitalize", "title", "isdigit", "find"),
    )
)
_MOST_STEPS = 20_000
_MOST_ITEMS = 10_000
_MOST_DIGITS = 400
"""The most digits that a number is rounded to; a double has fewer."""


def _range(*bounds: int) -> list[int]:
    found = range(*bounds)
    if len(found) > _MOST_ITEMS:
        raise UnknownValueError
    return list(found)


def _round(number: float, digits: int | None = None) -> float:
    if digits is not None and abs(digits) > _MOST_DIGITS:
        raise UnknownValueError
    return round(number, digits)


_CALLED: Mapping[str, Callable[..., Any]] = {
    **_FUNCTIONS,
    "range": _range,
    "round": _round,
    **{one.__name__: one for one in (list, dict, tuple, sorted, sum, any, all, bool, set)},
    **{one.__name__: lambda *items, one=one: list(one(*items)) for one in (zip, enumerate, reversed)},
    "dotify": dict,
}
_NAMESPACES = ("math", "python", "xacro")


_KINDS = {one.__name__: one for one in (str, int, float, bool, list, dict, tuple)}


def _kinds(node: ast.expr) -> tuple[type, ...]:
    """Return the classes that an expression names, the second argument of `isinstance`."""
    named = node.elts if isinstance(node, ast.Tuple) else [node]
    names = [one.attr if isinstance(one, ast.Attribute) else getattr(one, "id", "") for one in named]
    if not _KINDS.keys() >= {*names}:
        raise UnknownValueError
    return tuple(_KINDS[name] for name in names)


class UnknownValueError(Exception):
    """The expression needs something that is not known, or that is not computed."""


class PythonValues:
    """Computes expressions; `lookup` gives the value of a name or raises."""

    def __init__(self, lookup: Callable[[ast.Name], Any]) -> None:
        self._lookup = lookup
        self._steps = 0
        self._left = _MOST_CHARACTERS

    def value(self, tree: ast.expr) -> Any:
        """Return the value of an expression.

        Raises:
            UnknownValueError: if it cannot be computed.

        """
        try:
            return self._value(tree, {})
        except (ArithmeticError, TypeError, ValueError, LookupError, AttributeError, MemoryError, RecursionError):
            raise UnknownValueError from None

    def _value(self, node: ast.expr, local: Mapping[str, Any]) -> Any:
        self._steps += 1
        if self._steps > _MOST_STEPS:
            raise UnknownValueError
        match node:
            case ast.Constant(value=value) if not isinstance(value, bytes):
                return value
            case ast.Name(id=name):
                return local[name] if name in local else self._lookup(node)
            case ast.Subscript() | ast.Attribute():
                return self._part(node, local)
        made = self._made(node, local)
        self._spend(made)
        return made

    def _spend(self, value: Any) -> None:
        """Count the size of a value that was made; an item that is in it twice counts twice, as in its text."""
        waiting = [value]
        while waiting:
            each = waiting.pop()
            match each:
                case int() if each.bit_length() > _MOST_BITS:
                    raise UnknownValueError
                case str():
                    self._left -= len(each)
                case list() | tuple() | set() | dict():
                    self._left -= len(each)
                    waiting += (*each, *each.values()) if isinstance(each, dict) else each
            if self._left < 0:
                raise UnknownValueError

    def _made(self, node: ast.expr, local: Mapping[str, Any]) -> Any:
        match node:
            case ast.List(elts=items):
                return self._values(items, local)
            case ast.Tuple(elts=items):
                return tuple(self._values(items, local))
            case ast.Dict(keys=keys, values=values):
                present = [key for key in keys if key is not None]
                return dict(zip(self._values(present, local), self._values(values, local), strict=True))
            case ast.ListComp(elt=item, generators=generators) | ast.GeneratorExp(elt=item, generators=generators):
                return [self._value(item, one) for one in self._rounds(generators, local)]
            case ast.Call(func=ast.Name(id="isinstance") | ast.Attribute(attr="isinstance"), args=[value, kind]):
                return isinstance(self._value(value, local), _kinds(kind))
            case ast.Call(func=ast.Name(id="dict"), args=[], keywords=keywords) if keywords:
                return {str(one.arg): self._value(one.value, local) for one in keywords if one.arg}
            case ast.Call(keywords=[]):
                return self._call(node, local)
        return self._operation(node, local)

    def _values(self, nodes: Iterable[ast.expr], local: Mapping[str, Any]) -> list[Any]:
        return [self._value(node, local) for node in nodes]

    def _operation(self, node: ast.expr, local: Mapping[str, Any]) -> Any:
        match node:
            case ast.UnaryOp(op=operation, operand=operand):
                return _OPERATORS[type(operation)](self._value(operand, local))
            case ast.BinOp(left=left, op=operation, right=right):
                return _calculate(operation, self._value(left, local), self._value(right, local))
            case ast.BoolOp(op=operation, values=values):
                return self._boolean(operation, values, local)
            case ast.Compare(left=left, ops=operations, comparators=others):
                sides = self._values((left, *others), local)
                pairs = zip(sides, operations, sides[1:], strict=False)
                return all(_OPERATORS[type(each)](one, other) for one, each, other in pairs)
            case ast.IfExp(test=test, body=body, orelse=orelse):
                return self._value(body if self._value(test, local) else orelse, local)
        raise UnknownValueError

    def _part(self, node: ast.Subscript | ast.Attribute, local: Mapping[str, Any]) -> Any:
        match node:
            case ast.Subscript(value=whole, slice=ast.Slice() as part):
                ends = (part.lower, part.upper, part.step)
                return self._value(whole, local)[slice(*(end and self._value(end, local) for end in ends))]
            case ast.Subscript(value=whole, slice=index):
                return self._value(whole, local)[self._value(index, local)]
            case ast.Attribute(value=ast.Name(id=space), attr=name) if space in _NAMESPACES:
                return self._lookup(ast.Name(id=name, ctx=ast.Load()))
            case ast.Attribute(value=whole, attr=name):
                return self._value(whole, local)[name]

    def _boolean(self, operation: ast.boolop, values: list[ast.expr], local: Mapping[str, Any]) -> Any:
        value: Any = None
        for each in values:
            value = self._value(each, local)
            if bool(value) is isinstance(operation, ast.Or):
                return value
        return value

    def _rounds(self, generators: list[ast.comprehension], local: Mapping[str, Any]) -> list[Mapping[str, Any]]:
        rounds: list[Mapping[str, Any]] = [local]
        for generator in generators:
            target = generator.target
            parts = target.elts if isinstance(target, ast.Tuple) else [target]
            names = [one.id for one in parts if isinstance(one, ast.Name)]
            if len(names) < len(parts):
                raise UnknownValueError
            made: list[Mapping[str, Any]] = []
            for one in rounds:
                items = self._value(generator.iter, one)
                rows = items if isinstance(target, ast.Tuple) else ((item,) for item in items)
                made += ({**one, **dict(zip(names, row, strict=True))} for row in rows)
                if len(made) > _MOST_ITEMS:
                    raise UnknownValueError
            rounds = [one for one in made if all(self._value(test, one) for test in generator.ifs)]
        return rounds

    def _call(self, node: ast.Call, local: Mapping[str, Any]) -> Any:
        arguments = [self._value(argument, local) for argument in node.args]
        match node.func:
            case ast.Name(id=name) if name in _CALLED:
                return _CALLED[name](*arguments)
            case ast.Attribute(value=ast.Name(id=space), attr=name) if space in _NAMESPACES and name in _CALLED:
                return _CALLED[name](*arguments)
            case ast.Attribute(value=whole, attr=name) if name in _METHODS:
                owner = self._value(whole, local)
                if type(owner) not in (str, list, dict, tuple):
                    raise UnknownValueError
                if _longest(owner, name, arguments) > _MOST_CHARACTERS:
                    raise UnknownValueError
                found = getattr(owner, name)(*arguments)
                return list(found) if name in ("keys", "values", "items") else found
        raise UnknownValueError


def _longest(owner: Any, method: str, arguments: list[Any]) -> int:
    """Return how long a text can be that a method makes of several others, before it is made."""
    match method, arguments:
        case "join", [texts]:
            return sum(len(owner) + len(text) for text in texts)
        case "replace", [_, new, *_]:
            return len(owner) + (len(owner) + 1) * len(new)
    return 0


def _calculate(operation: ast.operator, left: Any, right: Any) -> Any:
    """Return the result of an operation of Python.

    Raises:
        ArithmeticError: for a number or a text that is longer than any robot needs, before it is made.

    """
    sequences = [one for one in (left, right) if isinstance(one, str | list | tuple)]
    numbers = [one for one in (left, right) if isinstance(one, int)]
    checks: dict[type[ast.operator], Callable[[], bool]] = {
        ast.Pow: lambda: not (abs(left) < _MOST_BASE and abs(right) < 100),
        ast.Mult: lambda: bool(sequences) and len(sequences[0]) * max(numbers, default=0) > _MOST_ITEMS,
        ast.Add: lambda: sum(map(len, sequences)) > _MOST_CHARACTERS,
        ast.Mod: lambda: isinstance(left, str) and _WIDTH.search(left) is not None,
    }
    is_huge = checks.get(type(operation), lambda: False)()
    if is_huge or sum(one.bit_length() for one in numbers) > _MOST_BITS:
        raise OverflowError
    return _OPERATORS[type(operation)](left, right)
