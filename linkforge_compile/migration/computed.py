"""Compute an expression of xacro that the language does not have, where the names in it have values."""

from __future__ import annotations

import ast
import copy
import math
import re
from collections.abc import Callable
from typing import NamedTuple

from linkforge_compile.migration.constants import constant_of
from linkforge_compile.migration.python_values import PythonValues, UnknownValueError
from linkforge_compile.migration.symbols import (
    CannotTranslateError,
    NotConstantError,
    Parts,
    Symbol,
    as_expression,
    constant,
    read_literal,
)

MATH = {name: getattr(math, name) for name in ("e", "tau", "inf")}


_CONSTANTS = {"pi": math.pi, "True": True, "False": False, "None": None, **MATH}


MARK = re.compile(r"XACRO(\d+)EXTENSION")
"""What stands for a `$(…)` in an expression of Python."""


class Names(NamedTuple):
    """What the names in a text are: a function for names, one for `$(…)`, and one for the path of a YAML file."""

    lookup: Callable[[str], ast.expr | None]
    extension: Callable[[str], Parts]
    load_data: Callable[[Parts], ast.expr]


def computed(tree: ast.expr, names: Names, extensions: list[Parts]) -> ast.expr | None:
    """Return the value of an expression of Python that the language does not have; None if it cannot be computed.

    Raises:
        NotConstantError: if it can be once names have values.

    """
    unknown: set[Symbol] = set()

    def lookup(name: str) -> object:
        marked = MARK.fullmatch(name)
        if marked:
            node: ast.expr | None = as_expression(extensions[int(marked[1])])
        else:
            node = names.lookup(name)
        if node is None and name in _CONSTANTS:
            return _CONSTANTS[name]
        if node is None:
            raise UnknownValueError
        try:
            value = constant_of(node)
        except NotConstantError as error:
            unknown.update(error.symbols)
            raise UnknownValueError from None
        return _evaluated(value) if marked and isinstance(value, str) else value

    tree = _with_texts(tree, lookup)
    try:
        value = PythonValues(lambda name: lookup(name.id)).value(tree)
    except (UnknownValueError, CannotTranslateError):
        if unknown:
            raise NotConstantError(frozenset(unknown)) from None
        return None
    return constant(value)


def _evaluated(text: str) -> object:
    """Return what a text is as a part of an expression, such as a list that an argument gives."""
    try:
        return ast.literal_eval(text)
    except (ValueError, SyntaxError, RecursionError, MemoryError):
        return read_literal(text)


def _with_texts(tree: ast.expr, lookup: Callable[[str], object]) -> ast.expr:
    """Return an expression with the values of `$(…)` in its texts."""

    class Replaced(ast.NodeTransformer):
        def visit_Constant(self, found: ast.Constant) -> ast.expr:
            if isinstance(found.value, str) and MARK.search(found.value):
                text = MARK.sub(lambda one: str(lookup(one[0])), found.value)
                return ast.Constant(value=text)
            return found

    try:
        return Replaced().visit(copy.deepcopy(tree))  # type: ignore[no-any-return]  # by its base
    except UnknownValueError:
        return tree
