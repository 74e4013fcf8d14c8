"""Nodes of the positioned tree, each with its span in the file, and the values of plain scalars by YAML 1.2.

Every stage up to lowering reads and makes these nodes. Expanding replaces a scalar that holds an expression
by a node of its value with the expression's span.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import NamedTuple, TypeAlias

from linkforge_compile.source import SourceFile, Span, span_of
from linkforge_compile.units import Quantity

ScalarValue: TypeAlias = None | bool | int | float | str | Quantity

MAX_DEPTH = 100
"""How deep lists and maps may nest; later stages walk the tree by recursion."""


class YamlScalar(NamedTuple):
    """A scalar: its text as written (without quotes) and its value in YAML 1.2's core schema.

    Only an evaluated expression or a variable has a Quantity as its value; a quantity in the file is a str.
    Fields that are text or names read `text`, so that `version: 1.0` stays "1.0"; numbers read `value`.

    `place` is a span, or the file that it was read from between the indexes `begin` and `end` (None: the length
    of the text), from which the span is computed on demand.
    """

    text: str
    value: ScalarValue
    place: Span | SourceFile
    begin: int = 0
    end: int | None = None

    @property
    def span(self) -> Span:
        return span_of(self.place, self.begin, self.begin + len(self.text) if self.end is None else self.end)

    def child(self, key: str | int) -> None:
        return None

    def key_span(self, key: str) -> None:
        return None

    def __deepcopy__(self, memo: object) -> YamlScalar:
        return self

    # Nodes are equal by identity: two with the same text at one place may come from two parts.

    def __eq__(self, other: object) -> bool:
        return self is other

    def __ne__(self, other: object) -> bool:
        return self is not other

    def __hash__(self) -> int:
        return id(self)


@dataclass(frozen=True, slots=True, eq=False)
class YamlList:
    """A sequence in block or flow style; its place is that of a scalar."""

    items: tuple[YamlNode, ...]
    place: Span | SourceFile
    begin: int = 0
    end: int = 0

    @property
    def span(self) -> Span:
        return span_of(self.place, self.begin, self.end)

    def child(self, key: str | int) -> YamlNode | None:
        return self.items[key] if isinstance(key, int) and 0 <= key < len(self.items) else None

    def key_span(self, key: str) -> None:
        return None

    def __iter__(self) -> Iterator[YamlNode]:
        return iter(self.items)

    def __len__(self) -> int:
        return len(self.items)

    def __deepcopy__(self, memo: object) -> YamlList:
        return self


class YamlEntry(NamedTuple):
    """A key and its value; the key is a scalar whose text is the name.

    `replaced` is the entry of the same name that this one replaced: the one changed by an override, or a default.
    Merged maps have it at their own entries.
    """

    key: YamlScalar
    value: YamlNode
    replaced: YamlEntry | None = None

    @property
    def name(self) -> str:
        return self.key.text

    def __deepcopy__(self, memo: object) -> YamlEntry:
        return self

    def __eq__(self, other: object) -> bool:
        return self is other

    def __ne__(self, other: object) -> bool:
        return self is not other

    def __hash__(self) -> int:
        return id(self)


@dataclass(frozen=True, slots=True, eq=False)
class YamlMap:
    """A mapping in the order written, its keys unique by their text; its place is that of a scalar."""

    entries: Mapping[str, YamlEntry]
    place: Span | SourceFile
    begin: int = 0
    end: int = 0

    @property
    def span(self) -> Span:
        return span_of(self.place, self.begin, self.end)

    def get(self, key: str) -> YamlNode | None:
        """Return the value of `key`; None if there is none or it is null."""
        entry = self.entries.get(key)
        if entry is None:
            return None
        value = entry.value
        return None if isinstance(value, YamlScalar) and value.value is None else value

    def section(self, key: str) -> Mapping[str, YamlEntry]:
        """Return the entries of the map under `key`; none if there is no map."""
        value = self.child(key)
        return value.entries if isinstance(value, YamlMap) else {}

    def text(self, key: str) -> str | None:
        """Return the text of the scalar under `key`; None if there is none or it is null."""
        value = self.get(key)
        return value.text if isinstance(value, YamlScalar) else None

    def with_value(self, key: str, value: YamlNode) -> YamlMap:
        """Return the map with another value under `key`; a new key comes last, at the place of the value."""
        known = self.entries.get(key)
        entry = YamlEntry(known.key if known else YamlScalar(key, key, value.span), value)
        return YamlMap({**self.entries, key: entry}, self.span)

    def only(self, keep: Callable[[YamlEntry], bool]) -> YamlMap:
        """Return the map without the entries that `keep` refuses."""
        return YamlMap({name: entry for name, entry in self.entries.items() if keep(entry)}, self.span)

    def without(self, *keys: str) -> YamlMap:
        gone = frozenset(keys)
        return self.only(lambda entry: entry.name not in gone)

    def mapped(self, change: Callable[[YamlEntry], YamlNode]) -> YamlMap:
        """Return the map with the values that `change` returns."""
        return YamlMap({one.name: YamlEntry(one.key, change(one)) for one in self}, self.span)

    def child(self, key: str | int) -> YamlNode | None:
        entry = self.entries.get(str(key))
        return entry.value if entry else None

    def key_span(self, key: str) -> Span | None:
        entry = self.entries.get(key)
        return entry.key.span if entry else None

    def __iter__(self) -> Iterator[YamlEntry]:
        return iter(self.entries.values())

    def __len__(self) -> int:
        return len(self.entries)

    def __deepcopy__(self, memo: object) -> YamlMap:
        return self


@dataclass(frozen=True, slots=True, eq=False)
class YamlFault:
    """Takes the place of a faulty node after its error was reported; later stages skip it.

    `keys` are those of all maps in that node: names that other parts may refer to.
    """

    span: Span
    keys: frozenset[str] = frozenset()

    def child(self, key: str | int) -> None:
        return None

    def key_span(self, key: str) -> None:
        return None

    def __deepcopy__(self, memo: object) -> YamlFault:
        return self


YamlNode: TypeAlias = YamlScalar | YamlList | YamlMap | YamlFault

Tags: TypeAlias = Mapping[str, Callable[[YamlScalar], YamlNode]]
"""Functions by tag that make a node of a scalar with that tag and report its errors."""


def to_fault(node: YamlNode) -> YamlFault:
    """Return the YamlFault that replaces a faulty node."""
    return node if isinstance(node, YamlFault) else YamlFault(node.span, frozenset(_keys_in(node)))


def names_at_fault(node: YamlNode | None) -> Iterator[str]:
    """Yield the keys of a map whose values are faulty, and the keys in those values."""
    for entry in node if isinstance(node, YamlMap) else ():
        if isinstance(entry.value, YamlFault):
            yield entry.name
            yield from entry.value.keys


def _keys_in(node: YamlNode) -> Iterator[str]:
    if isinstance(node, YamlMap):
        yield from node.entries
    for inner in node if isinstance(node, YamlList) else ():
        yield from _keys_in(inner)
    for entry in node if isinstance(node, YamlMap) else ():
        yield from _keys_in(entry.value)


def is_null(node: YamlNode) -> bool:
    """Whether a node is null or empty."""
    return isinstance(node, YamlScalar) and node.value is None


def leaves_in(node: YamlNode) -> Iterator[YamlNode]:
    """Yield all keys, scalars and empty nodes in a node."""
    match node:
        case YamlMap() if node.entries:
            for entry in node:
                yield entry.key
                yield from leaves_in(entry.value)
        case YamlList() if node.items:
            for item in node:
                yield from leaves_in(item)
        case _:
            yield node


_WORDS: dict[str, ScalarValue] = {
    **dict.fromkeys(("", "~", "null", "Null", "NULL")),
    **dict.fromkeys(("true", "True", "TRUE"), True),
    **dict.fromkeys(("false", "False", "FALSE"), False),
    **dict.fromkeys((sign + word for sign in ("", "+") for word in (".inf", ".Inf", ".INF")), math.inf),
    **dict.fromkeys(("-.inf", "-.Inf", "-.INF"), -math.inf),
    **dict.fromkeys((".nan", ".NaN", ".NAN"), math.nan),
}

YAML_1_1_BOOLEANS = {"yes": "true", "on": "true", "no": "false", "off": "false"}
"""Words, in any case, that YAML 1.1 reads as booleans and YAML 1.2 as text, and what to write for each."""

_NUMBER = re.compile(
    r"""(?P<decimal> [-+]? [0-9]+ )
      | (?P<octal> 0o [0-7]+ )
      | (?P<hexadecimal> 0x [0-9a-fA-F]+ )
      | (?P<fraction> [-+]? (?: \.[0-9]+ | [0-9]+ (?: \.[0-9]* )? ) (?: [eE] [-+]? [0-9]+ )? )""",
    re.VERBOSE,
)
IN_QUOTES = re.compile(r"'[^']*'|\"[^\"]*\"")

_BASES = {"decimal": 10, "octal": 8, "hexadecimal": 16}
_MOST_DIGITS = 400
"""More than the 309 digits of a double; Python refuses integers of more than 4,300."""


def scalar_value(text: str) -> ScalarValue:
    """Return null, a boolean or a number if the plain text is one, else the text itself.

    A quantity such as `90 deg` is text here. Numbers beyond a double are infinite, integers too.
    """
    if text in _WORDS:
        return _WORDS[text]
    match = _NUMBER.fullmatch(text)
    if match is None:
        return text
    base = _BASES.get(str(match.lastgroup))
    if base is None:
        return float(text)
    return _whole_number(text, base)


def is_overflow(text: str, value: ScalarValue) -> bool:
    """Whether plain text is a number too large for a double; `.inf` is not."""
    return isinstance(value, float) and math.isinf(value) and text not in _WORDS


def has_expression(text: str) -> bool:
    """Whether text holds an expression `$(...)`, or `$$(` for a literal `$(`."""
    return "$(" in text


_OPENING = re.compile(r"(?<!\$)\$\(")


def is_cut_expression(text: str) -> bool:
    """Whether a plain scalar holds `$(` without its `)`, because a comma or bracket of a flow list ended it."""
    opening = _OPENING.search(text)
    if opening is None:
        return False
    rest = IN_QUOTES.sub("", text[opening.start() :])
    return rest.count("(") > rest.count(")")


def word_value(text: str) -> ScalarValue:
    """Return the value that text has without quotes; the text itself where it needs quotes.

    Without quotes, null would be no value, and a number too large for a double an error.
    """
    value = scalar_value(text)
    return text if value is None or is_overflow(text, value) else value


def _whole_number(text: str, base: int) -> int | float:
    too_large = -math.inf if text.startswith("-") else math.inf
    if len(text) > _MOST_DIGITS:
        return too_large
    number = int(text, base)
    try:
        float(number)
    except OverflowError:
        return too_large
    return number


# Expressions of xacro, which newcomers write

XACRO_EXPRESSION = re.compile(r"\$\{(?P<within>[^{}\r\n]*)\}")


def xacro_facts(text: str) -> tuple[dict[str, str], ...]:
    """Return for each `${length / 2}` in a text the facts of the code XACRO_EXPRESSION."""
    found = XACRO_EXPRESSION.finditer(text)
    return tuple({"text": each[0], "ours": f"$({each['within'].strip()})"} for each in found)
