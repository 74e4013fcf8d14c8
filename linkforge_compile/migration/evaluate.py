"""Evaluate the texts of a xacro: what names stand for, `$(arg)`, `$(find)` and the data of YAML files."""

from __future__ import annotations

import ast
import copy
import math
import os
import re
from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path

from linkforge_compile.importers.origin import relative_path
from linkforge_compile.migration.computed import Names
from linkforge_compile.migration.constants import constant_of
from linkforge_compile.migration.deadline import Deadline
from linkforge_compile.migration.expressions import translate_text
from linkforge_compile.migration.scopes import Block, Macro, Property, Table, Value
from linkforge_compile.migration.sources import Sources
from linkforge_compile.migration.symbols import (
    MAP,
    UNSET,
    CannotTranslateError,
    NotConstantError,
    Parts,
    Reference,
    Symbol,
    as_expression,
    as_parts,
    call,
    constant,
    is_literal,
    is_path,
    joined,
    kind_of,
    literal_of,
    read_literal,
    refer,
    same_text,
    symbols_of,
    value_of,
)
from linkforge_compile.migration.template import Content, FileDraft
from linkforge_compile.source.xml_tree import XmlContent, XmlElement

_MOST_NODES = 80
"""The largest expression that is written in each place of use; a larger one becomes a variable."""


@dataclass(frozen=True)
class Context:
    """Where the walk is: the spec that is made, the folder of the xacro file, what is defined, and the calls."""

    file: FileDraft
    folder: Path
    macros: Table[Macro]
    symbols: Table[Property]
    calls: tuple[Called, ...] = ()
    is_inside: bool = False
    """Whether the walk is inside an element."""


@dataclass(eq=False)
class Called:
    """One call of a macro: the values of its parameters, its blocks, and what it expanded to."""

    macro: Macro
    element: XmlElement
    context: Context
    arguments: dict[str, Parts] = field(default_factory=dict)
    blocks: dict[str, list[Content]] = field(default_factory=dict)
    content: list[Content] = field(default_factory=list)


class MacroCalls(ABC):
    """The calls of macros, and what a module sees of the scopes of its callers."""

    @abstractmethod
    def define(self, macro: Macro) -> None:
        """Note a macro."""

    @abstractmethod
    def call(self, element: XmlElement, context: Context, evaluator: Evaluator) -> list[Content]:
        """Return what a call expands to, or the use of a module."""

    @abstractmethod
    def block(self, name: str, context: Context) -> Block | None:
        """Return the elements that a property of a caller holds, for a module."""

    @abstractmethod
    def imported(self, name: str, context: Context, evaluator: Evaluator) -> ast.expr | None:
        """Return a name of a caller in a module: a constant as a variable of its own, another one as a parameter."""

    @abstractmethod
    def require_file(self, parts: Parts, context: Context) -> None:
        """Refuse an argument that names a file of data and is empty: a spec reads its data in any case."""

    @abstractmethod
    def argument(self, name: str, context: Context, evaluator: Evaluator) -> ast.expr:
        """Return an argument of the robot; in a module, a parameter that gets it."""


@dataclass
class Evaluator(ABC):
    """Evaluates the texts of one xacro.

    `given` are the arguments on the command line, `pinned` the names of those that keep their values.
    """

    sources: Sources
    given: Mapping[str, str]
    pinned: frozenset[str]
    calls: MacroCalls
    deadline: Deadline = field(default_factory=Deadline)
    robot: FileDraft = field(default_factory=lambda: FileDraft("robot"))
    arguments: dict[str, Symbol] = field(default_factory=dict)
    environment: dict[str, str] = field(default_factory=dict)
    """The values of the environment that `$(optenv)` gives."""
    decided: int = 0
    """How many conditions have the same outcome for all arguments."""

    def __post_init__(self) -> None:
        self._resolving: list[tuple[int, str]] = []

    @abstractmethod
    def walk(self, content: Iterable[XmlContent], context: Context) -> list[Content]:
        """Return what the content of an element expands to."""

    def text(self, text: str, context: Context) -> Parts:
        """Return a text with expressions of the language."""
        return translate_text(text, self._names(context)) if "$" in text else ((text,) if text else ())

    def _names(self, context: Context) -> Names:
        return Names(
            lambda name: self.lookup(name, context),
            lambda text: self._extension(text, context),
            lambda path: self._data(path, context),
        )

    def lookup(self, name: str, context: Context) -> ast.expr | None:
        """Return what a name stands for; None for one that is not defined."""
        *spaces, name = name.split(".")
        table: Table[Property] | None = context.symbols
        for space in spaces:
            table = table.namespace(space) if table else None
        found = table.find(name) if table else None
        if found is None:
            return None if spaces else self.calls.imported(name, context, self)
        return self.resolved(found[0], name, found[1], context)

    def resolved(self, table: Table[Property], name: str, entry: Property, context: Context) -> ast.expr:
        self.deadline.check()
        if isinstance(entry, Value):
            return entry.node
        if isinstance(entry, Block):
            raise CannotTranslateError(f"the block '{name}' in an expression")
        if (id(table), name) in self._resolving:
            raise CannotTranslateError(f"the property '{name}', which depends on itself")
        self._resolving.append((id(table), name))
        try:
            file = next((one.file for one in table.chain() if one.file), context.file)
            inside = replace(context, symbols=table, folder=entry.folder, file=file)
            parts = self.text(entry.text, inside)
        finally:
            self._resolving.pop()
        node = value_of(parts)
        if table.file is not None:
            node = self.variable(name, node, table.file, entry.comment, entry.place)
        elif sum(1 for _ in ast.walk(node)) > _MOST_NODES:
            node = self.variable(name, node, context.file, entry.comment)
        table.entries[name] = Value(node, source=entry)
        return node

    def variable(
        self, name: str, node: ast.expr, file: FileDraft, comment: str = "", place: tuple[str, int] = ("", 0)
    ) -> ast.expr:
        """Return a new variable of a spec; data get the name of the first property that has them."""
        if isinstance(node, Reference) and node.symbol.kind == MAP and node.symbol.role != "parameter":
            data = node.symbol
            if not data.is_named:
                data.wish, data.is_named, data.comment = name, True, data.comment or comment
            if data.wish == name:
                return node
        if isinstance(node, Reference) and node.symbol.role == "parameter" and file is self.robot:
            # `<xacro:property name="model" value="$(arg model)"/>` is the parameter itself.
            node.symbol.comment = node.symbol.comment or comment
            return node
        known: object = UNSET
        with suppress(NotConstantError):
            known = constant_of(node)
        if known == math.pi:
            return ast.Name(id="pi", ctx=ast.Load())
        symbol = Symbol(name, "variable", as_parts(node) or ("",), known, kind_of(node), comment)
        symbol.place = place
        file.symbols.append(symbol)
        return refer(symbol)

    def _extension(self, text: str, context: Context) -> Parts:
        kind, _, rest = text.strip().partition(" ")
        name = self.text(rest.strip(), context)
        if kind == "arg":
            node = self.calls.argument(self.path_text(name), context, self)
            return (node,) if isinstance(node, Reference) else as_parts(node)
        if kind == "find":
            self.sources.note_package(name)
            return (call("path", as_expression(joined(("package://",), name))),)
        if kind == "optenv":
            variable, *default = self.path_text(name).split()
            self.environment[variable] = os.environ.get(variable, " ".join(default))
            return joined((self.environment[variable],))
        raise CannotTranslateError(f"'$({text})'")

    def _data(self, parts: Parts, context: Context) -> ast.expr:
        """Return the data of a YAML file."""
        self.calls.require_file(parts, context)
        known: object = UNSET
        with suppress(NotConstantError):
            known = self.sources.data(context.folder / self.path_text(parts))
        if known is not UNSET and not self.sources.is_readable(context.folder / self.path_text(parts)):
            return self._unreadable(known, self.address(parts, context), context)
        for part in parts[:1]:
            if isinstance(part, Reference):
                part.symbol.data_folder = relative_path(self.sources.spec_folder, context.folder)
        address = self.address(parts, context)
        for symbol in context.file.symbols:
            if symbol.role == "data" and same_text(symbol.value or (), address):
                return refer(symbol)
        wish = _name_of_data(address)
        symbol = Symbol(wish, "data", address, known, MAP)
        if known is UNSET:
            is_readable = True
            with suppress(NotConstantError, CannotTranslateError):
                path = context.folder / self.path_text(self._as_given(parts, context))
                symbol.example = self.sources.data(path)
                is_readable = self.sources.is_readable(path)
            if not is_readable:
                raise NotConstantError(symbols_of(parts), "a spec cannot read this file directly")
        context.file.symbols.append(symbol)
        return refer(symbol)

    def _as_given(self, parts: Parts, context: Context) -> Parts:
        """Return a text with the values that the given arguments lead to."""
        made: Parts = ()
        for part in parts:
            if not isinstance(part, Reference):
                made = joined(made, (part,))
                continue
            symbol, around = part.symbol, context
            value = symbol.value
            if symbol.is_argument:
                value = (self.given[symbol.wish],) if symbol.wish in self.given else value
            elif symbol.role == "parameter" and context.calls and symbol.wish in context.calls[0].arguments:
                value, around = context.calls[0].arguments[symbol.wish], context.calls[0].context
            made = joined(made, (part,) if value is None else self._as_given(value, around))
        return made

    def _unreadable(self, known: object, address: Parts, context: Context) -> ast.expr:
        """Return the data of a file that no spec can read as a variable."""
        wish = _name_of_data(address)
        same = (one for one in context.file.symbols if one.wish == wish and one.constant is known)
        symbol = next(same, None)
        if symbol is None:
            symbol = Symbol(wish, "variable", (constant(known),), known, MAP)
            symbol.comment = f"from {address[0]}, which a spec cannot read directly" if is_literal(address) else ""
            context.file.symbols.append(symbol)
        return refer(symbol)

    def address(self, parts: Parts, context: Context) -> Parts:
        """Return the path of a file as a spec names it: `package://…`, or relative to the main xacro."""
        made: Parts = ()
        for part in parts:
            is_package = isinstance(part, ast.Call) and is_path(part)
            made = joined(made, as_parts(part.args[0]) if is_package and isinstance(part, ast.Call) else (part,))
        first = made[0] if made else ""
        if isinstance(first, str) and "://" not in first and not first.startswith("/"):
            return joined((f"{relative_path(self.sources.spec_folder, context.folder)}/",), made)
        return made

    def path_text(self, parts: Parts) -> str:
        """Return a path that must be known now, with the folders of packages."""
        texts: list[str] = []
        for part in parts:
            if isinstance(part, str):
                texts.append(part)
                continue
            node = _without_paths(part, self.sources)
            literal = literal_of(node)
            texts.append(str(constant_of(node) if literal is UNSET else literal))
        return "".join(texts)

    def declare(self, name: str, default: Parts | None, comment: str = "") -> Symbol:
        """Return the parameter of the robot that an argument becomes."""
        symbol = self.arguments.get(name)
        if symbol is None:
            symbol = self.arguments[name] = Symbol(name, "parameter", is_argument=True)
            self.robot.symbols.append(symbol)
        symbol.value, symbol.comment = default, comment or symbol.comment
        given = (self.given[name],) if name in self.given else default
        if given is not None:
            node = value_of(given)
            symbol.kind = kind_of(node)
            if name in self.pinned:
                symbol.value, symbol.constant = given, read_literal(self.path_text(given))
        return symbol


def _name_of_data(address: Parts) -> str:
    first = address[0] if address else ""
    if isinstance(first, Reference):
        return re.sub(r"(_(parameters?|params?|config))?_(file|path|filename)$", "", first.symbol.wish)
    last = next((part for part in reversed(address) if isinstance(part, str)), "data")
    stem = last.rsplit("/", 1)[-1].rsplit(".", 1)[0]
    return re.sub(r"\W", "_", stem).strip("_") or "data"


class _WithoutPaths(ast.NodeTransformer):
    """Puts the folders of packages in the place of `path(…)`, and values in that of variables."""

    def __init__(self, sources: Sources) -> None:
        self._sources = sources

    def visit_Call(self, found: ast.Call) -> ast.AST:
        if is_path(found):
            package, _, rest = str(constant_of(found.args[0])).removeprefix("package://").partition("/")
            return constant(str(self._sources.find(package) / rest))
        return self.generic_visit(found)

    def visit_Reference(self, found: Reference) -> ast.AST:
        symbol = found.symbol
        if symbol.value and symbol.constant is UNSET and symbol.role != "parameter":
            return self.visit(copy.deepcopy(as_expression(symbol.value)))  # type: ignore[no-any-return]  # by its base
        return found


def _without_paths(node: ast.expr, sources: Sources) -> ast.expr:
    """Return an expression with the folders of packages in the place of `path(…)`."""
    replaced = _WithoutPaths(sources).visit(copy.deepcopy(node))
    assert isinstance(replaced, ast.expr), "an expression is replaced by one"
    return replaced
