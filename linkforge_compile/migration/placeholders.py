"""Numbers that stand for expressions in a URDF, so that the URDF reader reads templates as well."""

from __future__ import annotations

import ast
import re
from typing import NamedTuple

from linkforge_compile.migration.symbols import Parts, Reference, joined

_MARK = "0.71836"
PLACEHOLDER = re.compile(r"0\.71836(\d{4})7")
"""A number from 0 to 1, which all fields take, and a valid part of a name."""


class Placeholder(NamedTuple):
    """What a number stands for: an expression, or a component of one that gives a vector."""

    node: ast.expr
    component: int | None = None
    size: int = 0


class Placeholders:
    """The expressions of one file by the numbers that stand for them; equal ones have one number."""

    def __init__(self) -> None:
        self._made: list[Placeholder] = []
        self._numbers: dict[tuple[str, int | None], int] = {}

    def number(self, node: ast.expr, component: int | None = None, size: int = 0) -> str:
        """Return the number that stands for an expression."""
        key = key_of(node), component
        if key not in self._numbers:
            self._numbers[key] = len(self._made)
            self._made.append(Placeholder(node, component, size))
        return f"{_MARK}{self._numbers[key]:04d}7"

    def of(self, number: str) -> Placeholder | None:
        """Return what a text stands for as a whole; None if it is no placeholder."""
        found = PLACEHOLDER.fullmatch(number)
        return self._made[int(found[1])] if found else None

    def parts(self, text: str) -> Parts:
        """Return a text with its expressions."""
        parts: Parts = ()
        end = 0
        for found in PLACEHOLDER.finditer(text):
            placeholder = self._made[int(found[1])]
            node = placeholder.node
            if placeholder.component is not None:
                index = ast.Constant(value=placeholder.component)
                node = ast.Subscript(value=node, slice=index, ctx=ast.Load())
            parts = joined(parts, (text[end : found.start()],), (node,))
            end = found.end()
        return joined(parts, (text[end:],))


def key_of(node: ast.expr) -> str:
    """Return a text that is the same for the same expressions of the same symbols."""
    if isinstance(node, Reference) and node.canonical is not None:
        return node.canonical
    symbols = [str(id(one.symbol)) for one in ast.walk(node) if isinstance(one, Reference)]
    given = [str(one.is_as_given) for one in ast.walk(node) if isinstance(one, Reference)]
    return f"{ast.dump(node)} {' '.join(symbols)} {' '.join(given)}"
