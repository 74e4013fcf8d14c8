"""A scalar's text once its expressions are found: literal text and expressions, in order."""

from __future__ import annotations

import ast
from dataclasses import dataclass

from linkforge_compile.source import Span
from linkforge_compile.source.text_place import TextPlace


@dataclass(frozen=True, eq=False)
class Expression:
    """What stands between `$(` and `)`: its text, its place in the scalar, and Python's syntax tree of it.

    The tree holds only what the language allows; `names` are its names but for functions and constants.
    Columns of the tree count UTF-8 bytes of the text in one pair of parentheses.
    """

    text: str
    offset: int
    place: TextPlace
    tree: ast.expr
    names: tuple[ast.Name, ...] = ()

    def span(self, node: ast.expr) -> Span:
        """Return where a part of the expression stands."""
        start = self.index(node.col_offset)
        end = self.index(node.col_offset if node.end_col_offset is None else node.end_col_offset)
        return self.place.part(self.offset + start, end - start)

    def key_span(self, node: ast.expr) -> Span:
        """Return where the key of `row.key` stands, which ends where the whole does."""
        whole = self.written(node)
        key = whole.rpartition(".")[2].lstrip()
        return self.place.part(self.offset + self.index(node.col_offset) + len(whole) - len(key), len(key))

    def index(self, column: int) -> int:
        """Return the index into the text for a column of the tree."""
        column = max(column - 1, 0)  # a comprehension begins with the parenthesis that is not the text's own
        if self.text.isascii():
            return min(column, len(self.text))
        return len(self.text.encode()[:column].decode(errors="ignore"))

    def written(self, node: ast.expr) -> str:
        """Return a part of the expression as it was written."""
        return self.text[self.index(node.col_offset) : self.index(node.end_col_offset or 0)]


@dataclass(frozen=True, eq=False)
class Template:
    """Text with expressions in it; a single part that is an expression gives its value as it is."""

    parts: tuple[str | Expression, ...]
    span: Span

    @property
    def names(self) -> frozenset[str]:
        """The parameters, variables and other names that it uses."""
        return frozenset(self.names_in_order)

    @property
    def names_in_order(self) -> tuple[str, ...]:
        """The same in the order in which they are first used."""
        used = (name.id for part in self.parts if isinstance(part, Expression) for name in part.names)
        return tuple(dict.fromkeys(used))
