"""Declare the parameters, variables and data of a spec: names, types and units by how they are used."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable

from linkforge_compile.expressions.functions import RESERVED_NAMES
from linkforge_compile.migration.formulas import Computed
from linkforge_compile.migration.nodes import map_of, scalar
from linkforge_compile.migration.symbols import (
    BOOLEAN,
    LIST,
    MAP,
    NUMBER,
    UNSET,
    VECTOR,
    Parts,
    Symbol,
    as_parts,
    constant,
    is_literal,
    is_path,
    joined,
    literal_of,
    value_of,
)
from linkforge_compile.migration.values import Values
from linkforge_compile.source import Span
from linkforge_compile.syntax import YamlList, YamlNode, YamlScalar
from linkforge_compile.syntax.nodes import scalar_value
from linkforge_compile.units import number_text

_INSTEAD = {"prefix": "name_prefix", "name": "base_name"}
"""Names for those that always mean something else in an expression."""


def names_of(symbols: Iterable[Symbol]) -> dict[Symbol, str]:
    """Return a name for each symbol, its own where that is free; parameters come first."""
    names: dict[Symbol, str] = {}
    taken: set[str] = set()
    for symbol in sorted(symbols, key=lambda one: one.role != "parameter"):
        wish = re.sub(r"\W", "_", symbol.wish)
        wish = _INSTEAD.get(wish, f"{wish}_value") if wish in RESERVED_NAMES else wish
        name, number = wish, 2
        while name in taken:
            name, number = f"{wish}_{number}", number + 1
        taken.add(name)
        names[symbol] = name
    return names


def type_of(symbol: Symbol) -> str:
    """Return the type of a parameter."""
    if is_file(symbol):
        return "file"
    if symbol.kind == VECTOR:
        return "vector" if symbol.size == 3 else "list"
    if symbol.kind in (BOOLEAN, MAP, LIST):
        return symbol.kind
    if symbol.kind == NUMBER and symbol.is_in_text and not symbol.dimensions and _is_spelled(symbol):
        return "string"
    if symbol.kind == NUMBER:
        return next(iter(symbol.dimensions)) if len(symbol.dimensions) == 1 else "number"
    return "string"


def _is_spelled(symbol: Symbol) -> bool:
    """Whether the default is a number that is not written as it is computed, such as the version 1.10."""
    text = "".join(map(str, symbol.value or ()))
    number = scalar_value(text)
    return isinstance(number, int | float) and number_text(number) != text


def is_file(symbol: Symbol) -> bool:
    """Whether a parameter is the path of a file of data and nothing else."""
    value = symbol.value
    is_known = value is None or is_path(value[0] if value else "") or _is_relative(value)
    return symbol.data_folder is not None and not symbol.is_written and is_known


def _is_relative(parts: Parts) -> bool:
    """Whether a text is a path that begins in the folder of the xacro that reads it."""
    text = "".join(map(str, parts))
    return is_literal(parts) and text.endswith((".yaml", ".yml")) and "://" not in text and not text.startswith("/")


def declaration(symbol: Symbol, values: Values, where: Span) -> YamlNode:
    """Return the declaration of a parameter, in its short form where the default has its type."""
    kind = type_of(symbol)
    if symbol.is_block and kind == LIST:
        return YamlList((), where)
    default = None if symbol.value is None else _default(symbol, symbol.value or ("",), values, where)
    is_known = isinstance(default, YamlList | YamlScalar) and "$(" not in getattr(default, "text", "")
    choices = None
    if is_known and _is_pinned(symbol) and isinstance(default, YamlScalar) and kind != "file":
        choices = YamlList((default,), where)
    elif symbol.is_closed and kind == "string":
        choices = YamlList(tuple(scalar(one, where) for one in symbol.choices), where)
    if default is not None and is_known and choices is None and kind in _TYPES_OF_DEFAULTS:
        return default
    return map_of({"type": scalar(kind, where), "default": default, "enum": choices}, where)


_TYPES_OF_DEFAULTS = ("boolean", "number", "string", "vector", "list")
"""The types that a parameter without a declared one has by its default."""


def _is_pinned(symbol: Symbol) -> bool:
    return symbol.is_argument and symbol.constant is not UNSET


def _default(symbol: Symbol, parts: Parts, values: Values, where: Span) -> YamlNode:
    """Return a default as its type has it: `1` for a text is the text, `0.5` for a number the number."""
    kind = type_of(symbol)
    parts = tuple(constant(one.value) if isinstance(one, Computed) else one for one in parts)
    if kind == "file":
        address = joined(*(as_parts(one.args[0]) if isinstance(one, ast.Call) else (one,) for one in parts))
        if _is_relative(parts):
            address = joined((f"{symbol.data_folder}/",), address)
        return values.value(address, where, "")
    literal = literal_of(value_of(parts))
    if kind == "string" and literal is not UNSET and not is_literal(parts):
        parts = (str(literal),)
    elif kind not in ("string", "vector", "list") and is_literal(parts):
        text = "".join(map(str, parts))
        if scalar_value(text) == literal:  # plugins read `1.10` and `True` as they are spelled
            return YamlScalar(text, scalar_value(text), where)
        parts = as_parts(value_of(parts)) or ("",)
    return values.value(parts, where, symbol.kind)


def comment_of(symbol: Symbol, name: str) -> str:
    """Return the comment of a name: the one in the xacro, and what is not certain."""
    lines = [symbol.comment] if symbol.comment else []
    if symbol.role == "parameter" and symbol.wish != name:
        lines.append(f"in the xacro: {symbol.wish}")
    if symbol.role == "parameter" and symbol.choices and not (_is_pinned(symbol) or symbol.is_closed):
        lines.append(f"compared with: {', '.join(repr(one) for one in symbol.choices)}")
    return "\n".join(lines)
