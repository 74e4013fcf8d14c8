"""Write a tree as tidy YAML that reads back to the same tree."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from types import MappingProxyType
from typing import TypeAlias

from linkforge_compile.syntax.nodes import (
    YamlFault,
    YamlList,
    YamlMap,
    YamlNode,
    YamlScalar,
    is_cut_expression,
    scalar_value,
)
from linkforge_compile.units import Quantity, number_text

WIDTH = 100
"""The most columns of a line with brackets; longer lists and maps are written in block style."""

Comments: TypeAlias = Mapping[YamlNode, str]
"""Comments by the entry's key or list item that they are written above."""

_INDENT = "  "
_MOST_NESTED = 3
"""The most levels of brackets on a line."""

# Text in YAML 1.2, but in 1.1 a boolean, a number to base 2, 8 or 60, one with grouped digits, a date, a merge or a
# default. `y` and `n` are omitted: few readers take them for booleans, and `axis: y` is common.
_MISREAD = re.compile(
    r"""(?i: yes | no | on | off )
      | [-+]? 0b [01_]+
      | [-+]? 0 o? [0-7_]+
      | [-+]? 0x [0-9a-fA-F_]+
      | [-+]? [0-9] [0-9_]* (?: : [0-5]? [0-9] )* (?: \. [0-9_]* )? (?: [eE] [-+]? [0-9]+ )?
      | [-+]? \. [0-9_]* (?: [eE] [-+]? [0-9]+ )?
      | [0-9]{4} - [0-9]{1,2} - [0-9]{1,2} .*
      | << | =""",
    re.VERBOSE,
)
_INDICATORS = tuple("?:,[]{}#&*!|>'\"%@`")
_BETWEEN_BRACKETS = re.compile(r"[\[\]{},]|:\?")
_ESCAPES = str.maketrans({"\\": "\\\\", '"': '\\"', "\n": "\\n", "\t": "\\t", "\r": "\\r"})


def write(tree: YamlMap, comments: Comments = MappingProxyType({}), endings: Comments = MappingProxyType({})) -> str:
    """Return YAML that `read` turns into the same tree, except for spans and faulty entries.

    `endings` are comments below the last entry or item of a map or list; those of `tree` end the file. Characters
    that no spec may contain are written as they are, so `read` rejects them.
    """
    return "".join(f"{line}\n" for line in _Layout(comments, endings).document(tree))


class _Layout:
    """Lays out nodes as lines; `indent` is that of entries and items."""

    def __init__(self, comments: Comments, endings: Comments) -> None:
        self._comments, self._endings = comments, endings
        self._keys: dict[tuple[str, bool], str] = {}

    def document(self, tree: YamlMap) -> Iterator[str]:
        """Yield the lines of a file: sections are separated by empty lines and never in brackets."""
        was_section = False
        for place, entry in enumerate(tree):
            is_section = isinstance(entry.value, YamlMap) and len(entry.value) > 0
            if place and (is_section or was_section):
                yield ""
            was_section = is_section
            yield from self._comment(entry.key, "")
            key = f"{self._key(entry.name, in_brackets=False)}:"
            if is_section:
                yield key
                yield from self._block(entry.value, _INDENT)
            else:
                yield from self._value(key, entry.value, "")
        if tree in self._endings:
            yield ""
            yield from _commented(self._endings[tree], "")

    def _block(self, node: YamlNode, indent: str) -> Iterator[str]:
        if isinstance(node, YamlMap):
            for entry in node:
                if isinstance(entry.value, YamlFault):
                    continue
                yield from self._comment(entry.key, indent)
                yield from self._value(f"{indent}{self._key(entry.name, in_brackets=False)}:", entry.value, indent)
        elif isinstance(node, YamlList):
            for item in node:
                yield from self._comment(item, indent)
                yield from self._item(item, indent)
        yield from _commented(self._endings.get(node, ""), indent)

    def _value(self, key: str, node: YamlNode, indent: str) -> Iterator[str]:
        """Yield the lines of an entry: on the line of its key, or below it."""
        if isinstance(node, YamlScalar):
            yield from _scalar_lines(key, node, indent)
        elif brackets := self._fitting(node, len(key)):
            yield f"{key} {brackets}"
        else:
            yield key
            yield from self._block(node, indent + _INDENT)

    def _item(self, node: YamlNode, indent: str) -> Iterator[str]:
        """Yield the lines of a list item, the first of them after the dash."""
        dash = f"{indent}-"
        if isinstance(node, YamlScalar):
            yield from _scalar_lines(dash, node, indent)
        elif brackets := self._fitting(node, len(dash)):
            yield f"{dash} {brackets}"
        else:
            first, *rest = self._block(node, indent + _INDENT)
            yield f"{dash} {first.lstrip(' ')}"
            yield from rest

    def _fitting(self, node: YamlNode, column: int) -> str | None:
        """Return a list or map in brackets, None if it does not fit after the column or nests too deep."""
        width = WIDTH - column - 1
        text = self._in_brackets(node, _MOST_NESTED, width)
        return text if text is not None and len(text) <= width else None

    def _in_brackets(self, node: YamlNode, levels: int, width: int) -> str | None:
        """Return a node for use inside brackets; None if it cannot be or is longer than `width`."""
        if isinstance(node, YamlScalar):
            return None if _is_paragraph(node) else _scalar(node, in_brackets=True)
        if not isinstance(node, YamlMap | YamlList) or (len(node) and (not levels or node in self._endings)):
            return None
        # Stop as soon as it is too long: each level tries again.
        inside = []
        for part in self._parts(node, levels - 1, width):
            width -= 0 if part is None else len(part) + len(", ")
            if part is None or width < 0:
                return None
            inside.append(part)
        return f"{{{', '.join(inside)}}}" if isinstance(node, YamlMap) else f"[{', '.join(inside)}]"

    def _parts(self, node: YamlMap | YamlList, levels: int, width: int) -> Iterator[str | None]:
        """Yield the entries or items for use inside brackets, None for one that cannot be."""
        if isinstance(node, YamlList):
            for item in node:
                # Two commas with nothing between them make no item.
                cannot = item in self._comments or _is_empty(item)
                yield None if cannot else self._in_brackets(item, levels, width)
            return
        for entry in node:
            value = None if entry.key in self._comments else self._in_brackets(entry.value, levels, width)
            yield None if value is None else f"{self._key(entry.name, in_brackets=True)}: {value}"

    def _key(self, name: str, *, in_brackets: bool) -> str:
        """Return a key, quoted where needed; cached, because a spec repeats a few keys."""
        variant = name, in_brackets
        if variant not in self._keys:
            self._keys[variant] = _text(name, in_brackets=in_brackets)
        return self._keys[variant]

    def _comment(self, node: YamlNode, indent: str) -> Iterator[str]:
        yield from _commented(self._comments.get(node, ""), indent)


def _commented(text: str, indent: str) -> Iterator[str]:
    for line in text.splitlines():
        yield f"{indent}# {line}".rstrip()


def _scalar_lines(start: str, node: YamlScalar, indent: str) -> Iterator[str]:
    if not _is_paragraph(node):
        yield f"{start} {_scalar(node, in_brackets=False)}".rstrip(" ")
        return
    *lines, last = node.text.split("\n")
    yield f"{start} |" if not last else f"{start} |-"
    for line in lines if not last else (*lines, last):
        yield f"{indent}{_INDENT}{line}" if line else ""


def _is_paragraph(node: YamlScalar) -> bool:
    """Whether a scalar is text of several lines that can be written as a block."""
    if not isinstance(node.value, str) or "\n" not in node.text:
        return False
    lines = node.text.removesuffix("\n").split("\n")
    return bool(lines[0] and lines[-1]) and all(
        line.isprintable() and not line.endswith(" ") and not (line.startswith(" ") and line is lines[0])
        for line in lines
    )


def _is_empty(node: YamlNode) -> bool:
    return isinstance(node, YamlScalar) and node.value is None and not node.text


def _scalar(node: YamlScalar, *, in_brackets: bool) -> str:
    """Return a scalar as it was written, or its computed value as text."""
    value = node.value
    if isinstance(value, str):
        return _text(node.text, in_brackets=in_brackets)
    if isinstance(value, Quantity):
        return f"{number_text(value.value)} {value.dimension.si_unit}"
    if repr(scalar_value(node.text)) == repr(value):
        return node.text
    if value is None:
        return "null"
    if isinstance(value, bool):
        return str(value).lower()
    return number_text(value) if math.isfinite(value) else f"{value}".replace("inf", ".inf").replace("nan", ".nan")


def _text(text: str, *, in_brackets: bool) -> str:
    return text if _is_plain(text, in_brackets) else f'"{text.translate(_ESCAPES)}"'


def _is_plain(text: str, in_brackets: bool) -> bool:
    """Whether text needs no quotes: every reader reads all of it, as text."""
    return (
        isinstance(scalar_value(text), str)
        and not _MISREAD.fullmatch(text)
        and text.isprintable()
        and text.strip() == text
        and not text.startswith(("- ", "---", "...", *_INDICATORS))
        and text != "-"
        and not text.endswith(":")
        and ": " not in text
        and " #" not in text
        and not (in_brackets and (_BETWEEN_BRACKETS.search(text) or is_cut_expression(text)))
    )
