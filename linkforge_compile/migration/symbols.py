"""Names of a spec that replace those of a xacro, and the texts that are computed of them."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import Final, TypeAlias

from linkforge_compile.source import Span
from linkforge_compile.source.xml_tree import XmlElement

Part: TypeAlias = "str | ast.expr"
Parts: TypeAlias = tuple[Part, ...]
"""A text: its literal pieces, and the expressions between them. A single expression keeps its type."""

_MOST_CHARACTERS = 100_000
NUMBER, BOOLEAN, TEXT, VECTOR, MAP, LIST, UNKNOWN = "number", "boolean", "text", "vector", "map", "list", "unknown"


class NotConstantError(Exception):
    """A value is needed at once, but depends on arguments: on the names `symbols`, at `where` if that is known.

    `reason` says why, if it is not that nothing in the language depends on them as this does.
    """

    def __init__(self, symbols: frozenset[Symbol], reason: str = "") -> None:
        self.symbols, self.reason = symbols, reason
        self.where: Span | None = None
        super().__init__(", ".join(sorted(symbol.wish for symbol in symbols)))


class CannotTranslateError(Exception):
    """Something in a xacro has no equivalent in the language; `reason` says what, `where` is its place if known."""

    def __init__(self, reason: str) -> None:
        self.reason = reason
        self.where: Span | None = None
        super().__init__(reason)


class UndefinedError(CannotTranslateError):
    """A macro is called that is not defined, or a file included that does not exist."""


class TooLargeError(CannotTranslateError):
    """A text or an expression is larger than any robot needs; no other way to compute it is tried."""


class MissingFileError(UndefinedError):
    """A file or package is not there."""


class NoModuleError(Exception):
    """A macro cannot be a module; `body` is its element.

    It can be one without the parameters `fixed`, if their values never differ, or if the file that uses it has the
    elements `outer`. Else it may help to leave out the parameters `named`, which are in the names of its parts.
    """

    def __init__(
        self,
        body: XmlElement,
        reason: str,
        fixed: frozenset[str] = frozenset(),
        outer: frozenset[XmlElement] = frozenset(),
        named: frozenset[str] = frozenset(),
    ) -> None:
        self.body, self.reason, self.fixed, self.outer, self.named = body, reason, fixed, outer, named
        super().__init__(reason)


class _Unset:
    pass


UNSET: Final = _Unset()


@dataclass(eq=False)
class Symbol:
    """A parameter, a variable or data of one spec.

    `wish` is its name in the xacro, `value` that of a variable, or the default of a parameter; None for one that is
    required. `constant` is its value where that is known and the same in every use. `kind` is what it is used as.
    """

    wish: str
    role: str
    value: Parts | None = None
    constant: object = UNSET
    kind: str = UNKNOWN
    comment: str = ""
    example: object = UNSET
    """Its value for the given arguments, if that is all that is known: what data are like."""
    size: int = 3
    """The number of components of a vector."""
    dimensions: set[str] = field(default_factory=set)
    """The dimensions of the fields that it is written to as a whole."""
    choices: dict[str, None] = field(default_factory=dict)
    """The texts that it is compared with."""
    place: tuple[str, int] = ("", 0)
    """The file in which it was defined, and the index in it."""
    where: Span | None = None
    is_named: bool = False
    """Whether data have the name of a property."""
    data_folder: str | None = None
    """The folder in which the path of a file of data begins, if it names one."""
    is_written: bool = False
    """Whether its text is written into the robot."""
    is_in_text: bool = False
    """Whether it is a piece of a text, as it was given."""
    is_argument: bool = False
    """Whether it is an argument of the whole robot."""
    is_closed: bool = False
    """Whether `choices` are all its values: for others the xacro makes no valid robot."""
    is_block: bool = False
    """Whether it is a parameter for a block of elements."""

    def __deepcopy__(self, memo: object) -> Symbol:
        return self


class Reference(ast.Name):
    """A name in an expression that stands for a symbol."""

    symbol: Symbol
    canonical: str | None = None
    """The key of the expression that it is the short form of."""
    is_as_given: bool = False
    """Whether its text is that which the user gave, as of `$(arg NAME)`; properties are values."""


def refer(symbol: Symbol) -> Reference:
    """Return an expression that is a symbol."""
    node = Reference(id=symbol.wish, ctx=ast.Load())
    node.symbol = symbol
    return node


def as_given(symbol: Symbol) -> Reference:
    """Return a reference to an argument that is written as its user gave it."""
    node = refer(symbol)
    node.is_as_given = True
    return node


def symbols_in(node: ast.AST) -> frozenset[Symbol]:
    """Return the symbols that an expression names."""
    return frozenset(one.symbol for one in ast.walk(node) if isinstance(one, Reference))


def symbols_of(parts: Parts) -> frozenset[Symbol]:
    """Return the symbols that a text names."""
    return frozenset().union(*(symbols_in(part) for part in parts if isinstance(part, ast.AST)))


def sources_of(symbols: Iterable[Symbol]) -> frozenset[Symbol]:
    """Return symbols and those that their values depend on."""
    found: set[Symbol] = set()
    waiting = list(symbols)
    while waiting:
        symbol = waiting.pop()
        if symbol not in found:
            found.add(symbol)
            waiting += symbols_of(symbol.value or ())
    return frozenset(found)


def call(name: str, *arguments: ast.expr) -> ast.Call:
    """Return a call of a function of the language."""
    return ast.Call(func=ast.Name(id=name, ctx=ast.Load()), args=list(arguments), keywords=[])


def constant(value: object) -> ast.expr:
    """Return a literal; booleans and null are names in the language."""
    if value is None or isinstance(value, bool):
        return ast.Name(id={None: "null", True: "true", False: "false"}[value], ctx=ast.Load())
    if isinstance(value, int | float) and value < 0:
        return ast.UnaryOp(op=ast.USub(), operand=ast.Constant(value=-value))
    return ast.Constant(value=value)  # type: ignore[arg-type]  # a list of data is one here, too


_WORDS: dict[str, object] = {"true": True, "false": False, "null": None}


def literal_of(node: ast.expr) -> object:
    """Return the value of a literal, UNSET for any other expression."""
    match node:
        case Reference():
            return UNSET
        case ast.Constant(value=value):
            return value
        case ast.Name(id=name) if name in _WORDS:
            return _WORDS[name]
        case ast.UnaryOp(op=ast.USub(), operand=ast.Constant(value=int() | float() as value)):
            return -value
    return UNSET


_BOOLEANS = {"true": True, "True": True, "false": False, "False": False}


def read_literal(text: str) -> object:
    """Return a text as xacro reads the value of a property: a number, a boolean, or the text."""
    if len(text) >= 2 and text[0] == text[-1] == "'":
        return text[1:-1]
    if "_" in text:
        return text
    for read in (int, float):
        try:
            return read(text)
        except ValueError:
            continue
    return _BOOLEANS.get(text, text)


_RESULTS = {**dict.fromkeys(("str", "join", "path"), TEXT), "split": VECTOR}
"""What functions give that give no number."""

_KINDS: dict[type, str] = {bool: BOOLEAN, int: NUMBER, float: NUMBER, str: TEXT, dict: MAP}


def kind_of(node: ast.expr) -> str:
    """Return what an expression gives: a number, a boolean, a text, or unknown."""
    literal = literal_of(node)
    match node:
        case Reference():
            return node.symbol.kind
        case _ if type(literal) in _KINDS:
            return _KINDS[type(literal)]
        case ast.Compare() | ast.BoolOp() | ast.UnaryOp(op=ast.Not()):
            return BOOLEAN
        case ast.UnaryOp():
            return NUMBER
        case ast.BinOp(left=left, op=ast.Add(), right=right):
            return TEXT if TEXT in (kind_of(left), kind_of(right)) else NUMBER
        case ast.BinOp():
            return NUMBER
        case ast.IfExp(body=body, orelse=orelse):
            return kind_of(body) if kind_of(body) == kind_of(orelse) else UNKNOWN
        case ast.Call(func=ast.Name(id=name)):
            return _RESULTS.get(name, NUMBER)
        case ast.Name(id="pi"):
            return NUMBER
        case ast.Name(id="prefix"):
            return TEXT
    return UNKNOWN


def as_expression(parts: Parts) -> ast.expr:
    """Return a text as one expression."""
    parts = tuple(with_whole_paths(parts))
    if not parts:
        return constant("")
    if len(parts) == 1:
        return parts[0] if isinstance(parts[0], ast.expr) else constant(parts[0])
    nodes = [part if isinstance(part, ast.expr) else constant(part) for part in parts]
    texts = [node if kind_of(node) == TEXT else call("str", node) for node in nodes]
    whole = texts[0]
    for text in texts[1:]:
        whole = ast.BinOp(left=whole, op=ast.Add(), right=text)
    return whole


_PATH_END = re.compile(r"[\s\"'<>,;]")


def with_whole_paths(parts: Parts) -> Iterator[Part]:
    """Yield the pieces of a text, in which each `path('package://…')` has the whole path that follows it."""
    made: list[Part] = []
    for part in parts:
        last = made[-1] if made else None
        if not isinstance(last, ast.Call) or not is_path(last):
            made.append(part)
            continue
        tail, rest = part, ""
        if isinstance(part, str) and (end := _PATH_END.search(part)):
            tail, rest = part[: end.start()], part[end.start() :]
        address = joined(as_parts(last.args[0]), (tail,) if tail else ())
        made[-1] = call("path", as_expression(address))
        if rest:
            made.append(rest)
    yield from made


def is_path(part: Part) -> bool:
    """Whether a piece of a text is the path of a file or folder of a package."""
    return isinstance(part, ast.Call) and getattr(part.func, "id", "") == "path"


def as_parts(node: ast.expr) -> Parts:
    """Return an expression as a text: sums of texts as their pieces."""
    literal = literal_of(node)
    if isinstance(literal, str):
        return (literal,) if literal else ()
    match node:
        case ast.BinOp(left=left, op=ast.Add(), right=right) if kind_of(node) == TEXT:
            return joined(as_parts(left), as_parts(right))
        case ast.Call(func=ast.Name(id="str"), args=[inner]):
            return (inner,)
    return (node,)


def joined(*texts: Parts) -> Parts:
    """Return texts as one, with neighbouring literal pieces as one piece; properties may double it again and again."""
    parts: list[Part] = []
    for text in texts:
        for part in text:
            if isinstance(part, str) and parts and isinstance(parts[-1], str):
                parts[-1] += part
            elif part != "":
                parts.append(part)
    if sum(len(part) if isinstance(part, str) else 1 for part in parts) > _MOST_CHARACTERS:
        raise TooLargeError(f"a text of more than {_MOST_CHARACTERS} characters")
    return tuple(parts)


def same_text(one: Parts, other: Parts) -> bool:
    """Whether two texts are the same pieces, with the same symbols."""

    def written(parts: Parts) -> list[str]:
        return [
            part if isinstance(part, str) else f"{ast.dump(part)} {[id(s) for s in _ordered(part)]}" for part in parts
        ]

    return written(one) == written(other)


def _ordered(node: ast.AST) -> list[Symbol]:
    return [one.symbol for one in ast.walk(node) if isinstance(one, Reference)]


def is_literal(parts: Parts) -> bool:
    """Whether a text has no expressions."""
    return all(isinstance(part, str) for part in parts)


def value_of(parts: Parts) -> ast.expr:
    """Return the text of a property as its value: a literal, an expression, or a text."""
    if is_literal(parts):
        return constant(read_literal("".join(map(str, parts))))
    match parts:
        case (Reference(symbol=symbol),):
            return refer(symbol)
        case ("-" | "+" as sign, ast.expr() as node) if kind_of(node) == NUMBER:
            return ast.UnaryOp(op=ast.USub(), operand=node) if sign == "-" else node
    return as_expression(parts)
