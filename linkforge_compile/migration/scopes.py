"""Look up properties, blocks and macros by name, in the order in which xacro does."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Generic, TypeAlias, TypeVar

from linkforge_compile.migration.template import Content, FileDraft
from linkforge_compile.source.xml_tree import XmlElement

B = TypeVar("B")


@dataclass(eq=False)
class Lazy:
    """A property whose text is computed when it is first needed."""

    text: str
    folder: Path
    comment: str = ""
    place: tuple[str, int] = ("", 0)
    """The file that has it, and the index in it."""


@dataclass(eq=False)
class Value:
    """A property or parameter with a value; one with a `test` is defined only where that holds."""

    node: ast.expr
    test: ast.expr | None = None
    source: Lazy | None = None
    """The property that it was computed from."""


@dataclass(eq=False)
class Block:
    """Elements that `insert_block` inserts: those of a property, or evaluated ones of a call."""

    elements: XmlElement | None = None
    content: tuple[Content, ...] = ()
    folder: Path = field(default_factory=Path)


Property: TypeAlias = "Lazy | Value | Block"


@dataclass(eq=False)
class Macro:
    """A macro: its name, the parameters in their order with their defaults, and its element."""

    name: str
    parameters: tuple[str, ...]
    defaults: dict[str, tuple[str | None, str | None]]
    """By parameter: the property that is passed on if there is one, and the text of the default."""
    body: XmlElement
    folder: Path
    file: Path
    comment: str = ""


class Table(Generic[B]):
    """Names of one scope; those of the parent are seen through it. `is_namespace` is for `<xacro:include ns=…>`.

    Properties of a scope with a `file` become variables of that file; those of others are written where they are used.
    """

    def __init__(
        self, parent: Table[B] | None = None, *, is_namespace: bool = False, file: FileDraft | None = None
    ) -> None:
        self.parent, self.is_namespace, self.file = parent, is_namespace, file
        self.entries: dict[str, B] = {}
        self.namespaces: dict[str, Table[B]] = {}
        self.journal: list[tuple[Table[B], str, B | None]] = parent.journal if parent else []
        """What was set, with the entry before, so that what a condition sets can be found again."""

    def find(self, name: str) -> tuple[Table[B], B] | None:
        """Return the scope that has a name, and its entry."""
        table: Table[B] | None = self
        while table is not None:
            if name in table.entries:
                return table, table.entries[name]
            table = table.parent
        return None

    def get(self, name: str) -> B | None:
        found = self.find(name)
        return found[1] if found else None

    def set(self, name: str, entry: B) -> None:
        self.journal.append((self, name, self.entries.get(name)))
        self.entries[name] = entry

    def namespace(self, name: str) -> Table[B] | None:
        return next((one.namespaces[name] for one in self.chain() if name in one.namespaces), None)

    def chain(self) -> Iterator[Table[B]]:
        """Yield this scope and those around it."""
        table: Table[B] | None = self
        while table is not None:
            yield table
            table = table.parent

    @property
    def top(self) -> Table[B]:
        """The outermost scope."""
        return list(self.chain())[-1]

    @property
    def caller(self) -> Table[B] | None:
        """The scope around this macro, without namespaces."""
        around = self.parent
        while around is not None and around.is_namespace and not self.is_namespace:
            around = around.parent
        return around


def find_macro(
    name: str, macros: Table[Macro], symbols: Table[Property]
) -> tuple[Macro | None, Table[Macro], Table[Property]]:
    """Return a macro and the scopes in which its body is evaluated: those of its namespace, if its name has one."""
    found = macros.get(name)
    if found is not None:
        return found, macros, symbols
    *spaces, last = name.split(".")
    inner: Table[Macro] | None = macros
    names: Table[Property] | None = symbols
    for space in spaces:
        inner = inner.namespace(space) if inner else None
        names = names.namespace(space) if names else None
    if not spaces or inner is None or names is None:
        return None, macros, symbols
    return inner.get(last), inner, names


def unquoted(text: str) -> str:
    """Return the default of a parameter without the double quotes around it."""
    if len(text) >= 2 and text[0] == text[-1] and text[0] in "'\"":
        return text[1:-1] if text[0] == '"' else text
    return text
