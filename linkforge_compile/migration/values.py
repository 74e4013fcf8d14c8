"""Write expressions of a spec in the place of the numbers that stand for them."""

from __future__ import annotations

import ast
import copy
from itertools import chain, count

from linkforge_compile.migration.blocks import stands_for_block
from linkforge_compile.migration.formulas import Computed
from linkforge_compile.migration.nodes import data_of
from linkforge_compile.migration.placeholders import PLACEHOLDER, Placeholders
from linkforge_compile.migration.symbols import (
    LIST,
    UNSET,
    VECTOR,
    CannotTranslateError,
    Part,
    Parts,
    Reference,
    Symbol,
    as_expression,
    as_parts,
    constant,
    is_literal,
    joined,
    literal_of,
    with_whole_paths,
)
from linkforge_compile.migration.vectors import tokens_of
from linkforge_compile.source import Span
from linkforge_compile.syntax import YamlEntry, YamlList, YamlMap, YamlNode, YamlScalar, scalar_value


class Values:
    """Fills the values of one spec. `names` are those of its symbols; `used` are the symbols that it names."""

    def __init__(self, placeholders: Placeholders, names: dict[Symbol, str]) -> None:
        self._placeholders, self._names = placeholders, names
        self.used: dict[Symbol, None] = {}
        self.moved: dict[YamlNode, YamlNode] = {}
        """The keys and maps of the results by those that they replace."""

    def expression(self, node: ast.expr) -> str:
        """Return an expression as a spec writes it, without `$(` and `)`."""
        return ast.unparse(_Named(self).visit(copy.deepcopy(node)))

    def name(self, symbol: Symbol) -> str:
        self.used[symbol] = None
        if symbol not in self._names:
            taken = set(self._names.values())
            numbered = (f"{symbol.wish}_{number}" for number in count(2))
            self._names[symbol] = next(one for one in chain((symbol.wish,), numbered) if one not in taken)
        return self._names[symbol]

    def text(self, parts: Parts, *, is_escaped: bool = False) -> str:
        """Return a text with its expressions."""
        pieces = []
        for part in with_whole_paths(parts):
            if isinstance(part, str):
                pieces.append(part if is_escaped else part.replace("$(", "$$("))
            else:
                pieces.append(f"$({self.expression(part)})")
        return "".join(pieces)

    def value(self, parts: Parts, where: Span, kind: str) -> YamlNode:
        """Return the value of a variable or of a parameter."""
        if kind == VECTOR and (len(parts) > 1 or is_literal(parts)):
            items = [self._scalar(token, where) for token in tokens_of(parts)]
            return YamlList(tuple(items), where)
        if len(parts) == 1 and isinstance(parts[0], ast.expr):
            literal = literal_of(parts[0])
            return data_of(literal, where) if isinstance(literal, dict | list) else self._scalar(parts, where)
        text = self.text(parts)
        return YamlScalar(text, text, where)

    def _scalar(self, parts: Parts, where: Span) -> YamlScalar:
        """Return a number or a text; a word that is a number or boolean is one."""
        literal = literal_of(parts[0]) if len(parts) == 1 and isinstance(parts[0], ast.expr) else UNSET
        if literal is UNSET or isinstance(parts[0], Computed):
            text = self.text(parts)
            return YamlScalar(text, scalar_value(text) if is_literal(parts) else text, where)
        text = str(literal).lower() if isinstance(literal, bool) else "null" if literal is None else str(literal)
        return YamlScalar(text, text if isinstance(literal, str) else scalar_value(text), where)

    def fill(self, node: YamlNode) -> YamlNode:
        """Return a node with expressions in the place of their numbers."""
        match node:
            case YamlScalar():
                return self._filled(node)
            case YamlList():
                return self._list(node)
            case YamlMap() if block := self._block(node):
                return block
            case YamlMap():
                entries: dict[str, YamlEntry] = {}
                for entry in node:
                    key = self._filled(entry.key)
                    self.moved[entry.key] = key
                    entries[key.text] = YamlEntry(key, self.fill(entry.value))
                made = YamlMap(entries, node.span)
                self.moved[node] = made
                return made
        return node

    def _block(self, node: YamlMap) -> YamlScalar | None:
        """Return the parameter that a map stands for; None if it is none.

        Raises:
            CannotTranslateError: if a block is a part of what stands there.

        """
        block = self._block_in(stands_for_block(node))
        if block is None:
            if any(self._block_in(entry.value) for entry in node if entry.name != "origin"):
                raise CannotTranslateError("it inserts a block of its call beside others")
            return None
        when = node.get("when")
        if isinstance(when, YamlScalar):
            test = as_expression(self._placeholders.parts(when.text))
            text = f"$({self.expression(ast.IfExp(test=test, body=block, orelse=constant(None)))})"
        else:
            text = f"$({self.expression(block)})"
        return YamlScalar(text, text, node.span)

    def _block_in(self, node: YamlNode | None) -> Reference | None:
        """Return the parameter for a block that a number, or the first of a list, stands for."""
        first = node.items[0] if isinstance(node, YamlList) and len(node) else node
        placed = self._placeholders.of(first.text) if isinstance(first, YamlScalar) else None
        block = placed.node if placed else None
        return block if isinstance(block, Reference) and block.symbol.is_block else None

    def _list(self, node: YamlList) -> YamlNode:
        found = [self._placeholders.of(item.text) if isinstance(item, YamlScalar) else None for item in node]
        first = found[0] if found else None
        if (
            first is not None
            and first.component == 0
            and first.size == len(found)
            and all(one and one.node is first.node and one.component == n for n, one in enumerate(found))
        ):
            text = f"$({self.expression(first.node)})"
            return YamlScalar(text, text, node.span)
        blocks = [self._block_in(stands_for_block(item)) for item in node if isinstance(item, YamlMap)]
        if any(one is not None and one.symbol.kind == LIST for one in blocks):
            if len(node) == 1:
                return self.fill(node.items[0])
            raise CannotTranslateError("it inserts a block of its call beside others")
        items = tuple(self.fill(item) for item in node)
        for old, new in zip(node, items, strict=True):
            self.moved[old] = new
        return YamlList(items, node.span)

    def _filled(self, node: YamlScalar) -> YamlScalar:
        if not PLACEHOLDER.search(node.text):
            return node
        parts = joined(*(_without_wrap(part) for part in self._placeholders.parts(node.text)))
        text = self.text(parts, is_escaped=True)
        return YamlScalar(text, text, node.span)


def _without_wrap(part: Part) -> Parts:
    """Return a piece of a text without the wrap that made its number another one."""
    return as_parts(part.values[0]) if isinstance(part, ast.JoinedStr) else (part,)


class _Named(ast.NodeTransformer):
    """Puts the names of a spec in the place of references."""

    def __init__(self, values: Values) -> None:
        self._values = values

    def visit_Computed(self, node: Computed) -> ast.expr:
        return copy.deepcopy(node.formula)

    def visit_Reference(self, node: Reference) -> ast.expr:
        return ast.Name(id=self._values.name(node.symbol), ctx=ast.Load())
