"""Reads the simple YAML of which nearly all specs consist, in half the time that libyaml's events take in Python.

Simple is: block maps and lists, lists in [..] and maps in {..}, in one or several lines; plain words and numbers and
texts in quotes, each on one line; raw text behind `|`; comments. Whatever else a text holds, and every text with a
fault, is for `event_reader.py`: no fault is told here, and of all that is read here the other makes the same nodes, to
which `tests/syntax/test_quick_reader.py` holds both.

One pattern takes a key with the word or number behind it, which is most of a robot, and is none too exact: what was cut
out is looked up, and only a text that was not there before is held to what YAML says of plain text.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Final, TypeAlias

from linkforge_compile.pattern import pattern
from linkforge_compile.source import SourceFile
from linkforge_compile.syntax.nodes import MAX_DEPTH, ScalarValue, YamlEntry, YamlList, YamlMap, YamlNode, YamlScalar
from linkforge_compile.syntax.scalars import is_cut_expression, is_overflow, scalar_value
from linkforge_compile.unjudged import unjudged

_Match: TypeAlias = Callable[..., re.Match[str] | None]
"""What matches a compiled pattern with a text, from an index on where one is given."""

_new = tuple.__new__  # the constructor of a named tuple takes twice as long
_made_map, _made_list = unjudged(YamlMap), unjudged(YamlList)

_END: Final = "\0"
"""Ends the text, which has none itself."""

_LONGEST_KEY: Final = 1000
"""How long keys may be here: of one far from its colon libyaml knows nothing any more."""

# Sets of characters are of ASCII: of these `re` makes a table, where it would ask for each character what `\w` takes.
# Groups repeat so many times at most, since `re` remembers each: texts with more of them are not simple.
_FIRST = r"(?!-(?![\w.$(/])|\.\.\.)[A-Za-z0-9_$(/+~^<=.-]"
_PLAIN = re.compile(rf"{_FIRST}[^ \n:#]*(?:(?: *:(?=[^ \n\0])|#| +(?=[^ \n:#\0]))[^ \n:#]*){{0,999}}").match
_PLAIN_INSIDE = re.compile(
    rf"{_FIRST}[^ \n:#,\[\]{{}}?]*(?:(?::(?=[\w/])|#| +(?=[^ \n:#,\[\]{{}}?]))[^ \n:#,\[\]{{}}?]*){{0,999}}"
).match
_QUOTED = re.compile(r"\"[^\"\\\n]*\"|'[^'\n]*'(?!')").match

_LINE = re.compile(
    r"([A-Za-z_][A-Za-z0-9_.-]*+):(?: ([A-Za-z0-9_$(/+~^<=.-][^\n:#]*+)\n( *+)(?![ #\n])|(?=[ \n]))"
).match
"""A key and its colon; where plain text is behind them, that too, and the blanks before what is on the next line."""

_PAIR_INSIDE = re.compile(r"([A-Za-z_][A-Za-z0-9_.-]*+): (?:([A-Za-z0-9_$(/+~^<=.-][^\n:#,\[\]{}?]*+)(, ?|\}))?").match
"""The same in braces, with what closes the entry or the map."""

_WORDS = re.compile(r"([^\n:#,\[\]{}\"'?]++(?:, [^\n:#,\[\]{}\"'?]++){0,999})(, |\])").match
"""Plain texts in a list, up to its closing bracket or for as many as the pattern takes."""

_DASH = re.compile(r"-( +)(?=[^ \n#])").match
_BLANKS = re.compile("[ \n]*").match
_COMMENTS = re.compile(r"(?:#[^\n]*\n[ \n]*){1,999}").match
_RAW = pattern(r"\|(-?)\n( +)(?=[^ \n])")


class NotSimpleError(Exception):
    """A text is not as simple as what is read here, or at fault."""


def read_quickly(file: SourceFile, text: str, most: int) -> tuple[YamlNode, int]:
    """Return the top of a text's one document and how many nodes it has, each `<` in their texts counted as one.

    `text` is the file's, without a byte order mark, and has no characters that YAML forbids.
    Raises NotSimpleError for all that is not simple, has more than `most` nodes, or is nested too deep.
    """
    text = text.replace("\r\n", " \n")
    if "\t" in text or "\r" in text:
        raise NotSimpleError
    reader = _Reader(file, text, most)
    return reader.document(), reader.size


class _Plain:
    """Plain texts of one style, with what they mean, of all that was read so far."""

    def __init__(self, match: _Match, *, is_inside: bool) -> None:
        self.match = match
        self._is_inside = is_inside
        self.values: dict[str, ScalarValue] = {}

    def knows(self, text: str) -> bool:
        """Whether a text that was cut out is one, which is in `values` then; one with tags is read apart."""
        if text in self.values:
            return True
        found = self.match(text)
        if found is None or found.end() < len(text) or "<" in text:
            return False
        try:
            self.values[text] = self.value(text)
        except NotSimpleError:
            return False
        return True

    def value(self, text: str) -> ScalarValue:
        value = scalar_value(text)
        if is_overflow(text, value) or (self._is_inside and is_cut_expression(text)):
            raise NotSimpleError
        return value


class _Reader:
    """One pass over a text.

    What has been read ends at `end`; in block style the next node begins at `at`, behind `indent` blanks on its line.
    """

    def __init__(self, file: SourceFile, text: str, most: int) -> None:
        self.size = 1
        self._file, self._most = file, most
        self._text = f"{text}\n{_END}"
        self._at = self._indent = self._end = 0
        self._plain = _Plain(_PLAIN, is_inside=False)
        self._plain_inside = _Plain(_PLAIN_INSIDE, is_inside=True)

    def document(self) -> YamlNode:
        self._at = self._skipped(0)
        self._indent = self._at - self._text.rfind("\n", 0, self._at) - 1
        node = self._block(1)
        if self._text[self._at] != _END:
            raise NotSimpleError
        return node

    def _count(self, nodes: int) -> None:
        self.size += nodes
        if self.size > self._most:
            raise NotSimpleError

    def _descend(self, depth: int) -> None:
        if depth > MAX_DEPTH:
            raise NotSimpleError

    def _skipped(self, at: int) -> int:
        """Return where the next thing stands that is neither a blank, a line's end, nor a comment."""
        text = self._text
        if text[at] == " " and text[at + 1] not in " #\n":
            return at + 1
        while True:
            found = _BLANKS(text, at)
            assert found is not None, "it matches nothing, too"
            at = found.end()
            # Behind what is no blank it is part of a word.
            if text[at] != "#" or (at and text[at - 1] not in " \n"):
                return at
            comments = _COMMENTS(text, at)
            assert comments is not None, "the text ends with a line"
            at = comments.end()

    def _go_on(self) -> None:
        """Go on to where the next node in block style begins, which is on another line."""
        self._at = at = self._skipped(self._end)
        line = self._text.rfind("\n", self._end, at)
        if line < 0:
            raise NotSimpleError
        self._indent = at - line - 1

    def _block(self, depth: int) -> YamlNode:
        """Read the node that begins on a line of its own, or behind a dash."""
        text, at = self._text, self._at
        if text[at] == "-" and _DASH(text, at):
            return self._block_list(depth)
        if _LINE(text, at) or self._odd_key(at, self._plain):
            return self._block_map(depth)
        node = self._inline(at, depth)
        self._go_on()
        return node

    def _block_map(self, depth: int) -> YamlMap:
        self._descend(depth)
        text, file, known = self._text, self._file, self._plain
        values, most = known.values, self._most
        begin = at = self._at
        indent = deep = self._indent
        entries: dict[str, YamlEntry] = {}
        value: YamlNode
        while deep == indent and text[at] != _END:
            key_at, plain = at, None
            if found := _LINE(text, at):
                name, plain, blanks = found.groups()
            elif not (name := self._odd_key(at, known)):
                raise NotSimpleError
            if found and plain is not None and (plain in values or known.knows(plain)):
                at += len(name) + 2
                value = _new(YamlScalar, (plain, values[plain], file, at, None))
                self._end = at + len(plain)
                at, deep = found.end(), len(blanks)
            else:
                value = self._value(at + len(name) + 1, depth + 1)
                at, deep = self._at, self._indent
            if name in entries or len(entries) > most:
                raise NotSimpleError
            entries[name] = _new(YamlEntry, (_new(YamlScalar, (name, name, file, key_at, None)), value, None))
            if deep > indent:
                raise NotSimpleError
        self._at, self._indent = at, deep
        self._count(2 * len(entries))
        return _made_map(entries, file, begin, self._end)

    def _odd_key(self, at: int, known: _Plain) -> str:
        """Return the key at `at` that has blanks or colons in it, or begins as few do; empty where there is none."""
        found = known.match(self._text, at)
        if found is None or found[0] == "<<" or len(found[0]) > _LONGEST_KEY:
            return ""
        end = found.end()
        return found[0] if self._text[end] == ":" and self._text[end + 1] in " \n" else ""

    def _value(self, at: int, depth: int) -> YamlNode:
        """Read what a key's colon, which ends at `at`, says, and go on."""
        text, indent = self._text, self._indent
        begin = self._skipped(at)
        line = text.rfind("\n", at, begin)
        if line < 0:
            if text[begin] == "|":
                return self._raw(begin, indent)
            node = self._inline(begin, depth)
            self._go_on()
            return node
        self._end, self._at, self._indent = at, begin, begin - line - 1
        if self._indent > indent or (self._indent == indent and _DASH(text, begin)):
            return self._block(depth)
        return _new(YamlScalar, ("", None, self._file, at, None))

    def _inline(self, at: int, depth: int) -> YamlNode:
        """Read the node at `at`, which ends on its line but for brackets, in block style."""
        if self._text[at] in "[{\"'":
            return self._inside(at, depth)
        return self._word(at, self._plain)

    def _word(self, at: int, known: _Plain) -> YamlScalar:
        found = known.match(self._text, at)
        if found is None:
            raise NotSimpleError
        text = found[0]
        self.size += text.count("<")
        self._end = found.end()
        return _new(YamlScalar, (text, known.value(text), self._file, at, None))

    def _quoted(self, at: int) -> YamlScalar:
        found = _QUOTED(self._text, at)
        if found is None:
            raise NotSimpleError
        text = found[0][1:-1]
        self.size += text.count("<")
        self._end = found.end()
        return YamlScalar(text, text, self._file, at, self._end)

    def _raw(self, at: int, indent: int) -> YamlScalar:
        """Read the lines of text behind `|`, which are indented deeper than what it belongs to, and go on."""
        found = _RAW.match(self._text, at)
        if found is None or len(found[2]) <= indent:
            raise NotSimpleError
        blanks = found[2]
        behind = re.compile(rf"\n(?!{blanks}|\n)").search(self._text, found.end())
        assert behind is not None, "the text ends with a line"
        lines = self._text[found.start(2) : behind.start()].rstrip("\n")
        self._end = end = found.start(2) + len(lines)
        if " \n" in lines or lines.endswith(" ") or self._text[end + 1] == _END:
            raise NotSimpleError
        text = "\n".join(line[len(blanks) :] for line in lines.split("\n")) + ("" if found[1] else "\n")
        self.size += text.count("<")
        self._go_on()
        return YamlScalar(text, text, self._file, at, end)

    def _block_list(self, depth: int) -> YamlList:
        self._descend(depth)
        begin, indent = self._at, self._indent
        items: list[YamlNode] = []
        while self._indent == indent and (dash := _DASH(self._text, self._at)):
            self._at = dash.end()
            self._indent += 1 + len(dash[1])
            is_raw = self._text[self._at] == "|"
            items.append(self._raw(self._at, indent) if is_raw else self._block(depth + 1))
        if self._indent > indent:
            raise NotSimpleError
        self._count(len(items))
        return _made_list(tuple(items), self._file, begin, self._end)

    def _inside(self, at: int, depth: int) -> YamlNode:
        """Read the node at `at`, in brackets or itself in some."""
        opening = self._text[at]
        if opening == "{":
            return self._map_inside(at, depth)
        if opening == "[":
            return self._list_inside(at, depth)
        return self._quoted(at) if opening in "\"'" else self._word(at, self._plain_inside)

    def _closing(self, closing: str) -> bool:
        """Pass what ends an item in brackets; whether it closes them."""
        text, end = self._text, self._end
        if text[end] in " \n":
            end = self._skipped(end)
        if text[end] == closing:
            self._end = end + 1
            return True
        if text[end] != ",":
            raise NotSimpleError
        self._end = self._skipped(end + 1)
        return False

    def _list_inside(self, begin: int, depth: int) -> YamlList:
        self._descend(depth)
        items = self._words(begin + 1)
        if items is None:
            items = []
            self._end = self._skipped(begin + 1)
            is_closed = self._text[self._end] == "]" and self._closing("]")
            while not is_closed:
                items.append(self._inside(self._end, depth + 1))
                self._count(1)
                is_closed = self._closing("]")
        return _made_list(tuple(items), self._file, begin, self._end)

    def _words(self, at: int) -> list[YamlNode] | None:
        """Read a list that has plain texts in it up to its bracket, None where it has something else."""
        file, known = self._file, self._plain_inside
        values, most = known.values, self._most
        items: list[YamlNode] = []
        closing = ", "
        while closing == ", " and (found := _WORDS(self._text, at)):
            words, closing = found.groups()
            for text in words.split(", "):
                if text not in values and not known.knows(text):
                    return None
                items.append(_new(YamlScalar, (text, values[text], file, at, None)))
                at += len(text) + 2
            if len(items) > most:
                raise NotSimpleError
        if closing == ", ":
            return None
        self._count(len(items))
        self._end = at - 1
        return items

    def _map_inside(self, begin: int, depth: int) -> YamlMap:
        self._descend(depth)
        text, file, known = self._text, self._file, self._plain_inside
        values, most = known.values, self._most
        entries: dict[str, YamlEntry] = {}
        at = begin + 1 if text[begin + 1] not in " \n" else self._skipped(begin + 1)
        is_closed = text[at] == "}"
        if is_closed:
            at += 1
        value: YamlNode
        while not is_closed:
            key_at, plain = at, None
            if found := _PAIR_INSIDE(text, at):
                name, plain, closing = found.groups()
            elif not (name := self._odd_key(at, known)) or is_cut_expression(name):
                raise NotSimpleError
            if found and plain is not None and (plain in values or known.knows(plain)):
                value = _new(YamlScalar, (plain, values[plain], file, at + len(name) + 2, None))
                at, is_closed = found.end(), closing == "}"
                if text[at] in " \n" and not is_closed:
                    at = self._skipped(at)
            else:
                value = self._inside(self._skipped(at + len(name) + 1), depth + 1)
                is_closed = self._closing("}")
                at = self._end
            if name in entries or len(entries) > most:
                raise NotSimpleError
            entries[name] = _new(YamlEntry, (_new(YamlScalar, (name, name, file, key_at, None)), value, None))
        self._count(2 * len(entries))
        self._end = at
        return _made_map(entries, file, begin, at)
