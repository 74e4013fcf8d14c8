"""Reads the simple YAML of which nearly all specs consist, in half the time that libyaml's events take in Python.

Simple is: block maps and lists, lists in [..] and maps in {..}, in one or several lines; plain words and numbers and
texts in quotes, each on one line and without escapes; raw text behind `|`; comments; no tabs. Whatever else a text
holds, and every text with a fault, is for `event_reader.py`: no fault is told here, and of all that is read here the
other makes the same nodes, to which `tests/syntax/test_quick_reader.py` holds both.

One pattern takes a key with the word or number behind it, which is most of a robot, and is none too exact: what was cut
out is looked up, and only a text that was not there before is held to what YAML says of plain text.
"""

from __future__ import annotations

import re
from typing import Final

from linkforge_compile.pattern import pattern
from linkforge_compile.source import SourceFile
from linkforge_compile.syntax.nodes import MAX_DEPTH, YamlEntry, YamlList, YamlMap, YamlNode, YamlScalar, new
from linkforge_compile.syntax.plain_text import BEGIN, INSIDE, INSIDE_BRACKETS, QUOTED, PlainTexts
from linkforge_compile.syntax.scalars import scalar_value
from linkforge_compile.unjudged import unjudged

_new_map, _new_list = unjudged(YamlMap), unjudged(YamlList)

_END: Final = "\0"
"""Ends the text, which has none itself."""

_LONGEST_KEY: Final = 1000
"""How long keys may be here; libyaml takes those whose colon is within 1,024 characters."""

_KEY = rf"([A-Za-z_][A-Za-z0-9_.-]{{0,{_LONGEST_KEY - 1}}}+):"

_LINE = re.compile(rf"{_KEY}(?: ({BEGIN}[^\n:#]*+)\n( *+)(?![ #\n])|(?=[ \n]))").match
"""A key and its colon; where plain text is behind them, that too, and the blanks before what is on the next line."""

_PAIR_IN_BRACES = re.compile(rf"{_KEY} (?:({BEGIN}[^\n:#,\[\]{{}}?]*+)(, ?|\}}))?").match
"""The same in braces, with what closes the entry or the map."""

_PLAIN_ITEMS = re.compile(r"([^\n:#,\[\]{}\"'?]++(?:, [^\n:#,\[\]{}\"'?]++){0,999})(, |\])").match
"""Plain texts in a list, up to its closing bracket or for as many as the pattern takes."""

_DASH = re.compile(r"-( +)(?=[^ \n#])").match
_BLANKS = re.compile("[ \n]*").match
_COMMENTS = re.compile(r"(?:#[^\n]*\n[ \n]*){1,999}").match
_RAW = pattern(r"\|(-?)\n( +)(?=[^ \n])")  # few files have any


def read_quickly(file: SourceFile, most: int) -> tuple[YamlNode, int] | None:
    """Return the top of a file's one document and how many nodes it has, each `<` in their texts counted as one.

    The file has no characters that YAML forbids. None for all that is not simple, has more than `most` nodes, or is
    nested too deep.
    """
    text = file.counted.replace("\r\n", " \n")
    if "\t" in text or "\r" in text:
        return None
    reader = _Reader(file, text, most)
    try:
        return reader.document(), reader.size
    except _NotSimpleError:
        return None


class _NotSimpleError(Exception):
    """A text is not as simple as what is read here, or at fault."""


class _Reader:
    """One pass over a text.

    What has been read ends at `end`; in block style the next node begins at `at`, behind `indent` blanks on its line.
    """

    def __init__(self, file: SourceFile, text: str, most: int) -> None:
        self.size = 0
        self._file, self._most = file, most
        self._text = f"{text}\n{_END}"
        self._at = self._indent = self._end = 0
        self._plain = PlainTexts(INSIDE, are_in_brackets=False)
        self._plain_in_brackets = PlainTexts(INSIDE_BRACKETS, are_in_brackets=True)

    def document(self) -> YamlNode:
        self._count(1)
        self._at = self._skipped(0)
        self._indent = self._at - self._text.rfind("\n", 0, self._at) - 1
        node = self._block(1)
        if self._text[self._at] != _END:
            raise _NotSimpleError
        return node

    def _count(self, nodes: int) -> None:
        self.size += nodes
        if self.size > self._most:
            raise _NotSimpleError

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
            raise _NotSimpleError
        self._indent = at - line - 1

    # In block style

    def _block(self, depth: int) -> YamlNode:
        """Read the node that begins on a line of its own, or behind a dash."""
        text, at = self._text, self._at
        if text[at] == "-" and _DASH(text, at):
            return self._block_list(depth)
        if _LINE(text, at) or ((found := self._plain.match(text, at)) and text[found.end()] == ":"):
            return self._block_map(depth)
        node = self._on_one_line(at, depth)
        self._go_on()
        return node

    def _block_map(self, depth: int) -> YamlMap:
        text, file, plain, values = self._text, self._file, self._plain, self._plain.values
        begin = at = self._at
        indent = deep = self._indent
        entries: dict[str, YamlEntry] = {}
        uncounted, room = 0, self._room(depth)
        value: YamlNode
        while deep == indent and text[at] != _END:
            if found := _LINE(text, at):
                name, word, blanks = found.groups()
            else:
                name, word = self._odd_key(at, plain), None
            key = new(YamlScalar, (name, name, file, at, None))
            uncounted += 2
            if found and word is not None and (word in values or plain.learns(word)):
                at += len(name) + 2
                value = new(YamlScalar, (word, values[word], file, at, None))
                self._end = at + len(word)
                at, deep = found.end(), len(blanks)
            else:
                self.size += uncounted
                value = self._value(at + len(name) + 1, depth + 1)
                at, deep = self._at, self._indent
                uncounted, room = 0, self._most - self.size
            if name in entries or uncounted > room or deep > indent:
                raise _NotSimpleError
            entries[name] = new(YamlEntry, (key, value, None))
        self._at, self._indent = at, deep
        self.size += uncounted
        return _new_map(entries, file, begin, self._end)

    def _room(self, depth: int) -> int:
        """Return how many more nodes there may be, in what is nested so deep."""
        if depth > MAX_DEPTH:
            raise _NotSimpleError
        return self._most - self.size

    def _odd_key(self, at: int, plain: PlainTexts) -> str:
        """Return the key at `at` that has blanks or colons in it, or begins as few do."""
        found = plain.match(self._text, at)
        if found is None or found[0] == "<<" or len(found[0]) > _LONGEST_KEY or not plain.may_mean(found[0], found[0]):
            raise _NotSimpleError
        end = found.end()
        if self._text[end] != ":" or self._text[end + 1] not in " \n":
            raise _NotSimpleError
        return found[0]

    def _value(self, at: int, depth: int) -> YamlNode:
        """Read what a key's colon, which ends at `at`, says, and go on."""
        text, indent = self._text, self._indent
        begin = self._skipped(at)
        line = text.rfind("\n", at, begin)
        if line < 0:
            if text[begin] == "|":
                return self._raw(begin, indent)
            node = self._on_one_line(begin, depth)
            self._go_on()
            return node
        self._end, self._at, self._indent = at, begin, begin - line - 1
        if self._indent > indent or (self._indent == indent and _DASH(text, begin)):
            return self._block(depth)
        return new(YamlScalar, ("", None, self._file, at, None))

    def _on_one_line(self, at: int, depth: int) -> YamlNode:
        """Read the node at `at`, of which only brackets may take several lines."""
        if self._text[at] in "[{\"'":
            return self._in_brackets(at, depth)
        return self._plain_text(at, self._plain)

    def _block_list(self, depth: int) -> YamlList:
        self._room(depth)
        begin, indent = self._at, self._indent
        items: list[YamlNode] = []
        while self._indent == indent and (dash := _DASH(self._text, self._at)):
            self._count(1)
            self._at = dash.end()
            self._indent += 1 + len(dash[1])
            is_raw = self._text[self._at] == "|"
            items.append(self._raw(self._at, indent) if is_raw else self._block(depth + 1))
        if self._indent > indent:
            raise _NotSimpleError
        return _new_list(tuple(items), self._file, begin, self._end)

    # Texts

    def _plain_text(self, at: int, plain: PlainTexts) -> YamlScalar:
        found = plain.match(self._text, at)
        if found is None or not plain.may_mean(text := found[0], value := scalar_value(text)):
            raise _NotSimpleError
        self._count(text.count("<"))
        self._end = found.end()
        return new(YamlScalar, (text, value, self._file, at, None))

    def _quoted(self, at: int) -> YamlScalar:
        found = QUOTED(self._text, at)
        if found is None:
            raise _NotSimpleError
        text = found[0][1:-1]
        self._count(text.count("<"))
        self._end = found.end()
        return new(YamlScalar, (text, text, self._file, at, self._end))

    def _raw(self, at: int, indent: int) -> YamlScalar:
        """Read the lines of text behind `|`, which are indented deeper than what they belong to, and go on."""
        found = _RAW.match(self._text, at)
        if found is None or len(found[2]) <= indent:
            raise _NotSimpleError
        blanks, begin = found[2], found.start(2)
        behind = self._text.find("\n", begin)
        while self._text.startswith((blanks, "\n"), behind + 1):
            behind = self._text.find("\n", behind + 1)
        lines = self._text[begin:behind].rstrip("\n")
        end = begin + len(lines)
        # Which blanks at a line's end, and which at the text's, belong to it, libyaml knows.
        if " \n" in lines or lines[-1].isspace() or self._text[end + 1] == _END:
            raise _NotSimpleError
        self._end = end
        self._go_on()
        if f"\n{blanks}" in self._text[end : self._at]:
            raise _NotSimpleError
        text = lines.replace(f"\n{blanks}", "\n")[len(blanks) :] + ("" if found[1] else "\n")
        self._count(text.count("<"))
        return new(YamlScalar, (text, text, self._file, at, end))

    # In brackets

    def _in_brackets(self, at: int, depth: int) -> YamlNode:
        """Read the node at `at`, which is in brackets, or begins with one or a quote."""
        opening = self._text[at]
        if opening == "{":
            return self._map_in_braces(at, depth)
        if opening == "[":
            return self._list_in_brackets(at, depth)
        return self._quoted(at) if opening in "\"'" else self._plain_text(at, self._plain_in_brackets)

    def _closes(self, closing: str) -> bool:
        """Pass what stands between what was read and the next item; whether there is none, and that is passed too."""
        text, end = self._text, self._end
        if text[end] in " \n":
            end = self._skipped(end)
        if text[end] == ",":
            end = self._skipped(end + 1)
        elif text[end] != closing:
            raise _NotSimpleError
        is_closed = text[end] == closing
        self._end = end + is_closed
        return is_closed

    def _list_in_brackets(self, begin: int, depth: int) -> YamlList:
        self._room(depth)
        items = self._plain_items(begin + 1)
        if items is None:
            items = []
            self._end = self._skipped(begin + 1)
            is_closed = self._text[self._end] == "]" and self._closes("]")
            while not is_closed:
                self._count(1)
                items.append(self._in_brackets(self._end, depth + 1))
                is_closed = self._closes("]")
        return _new_list(tuple(items), self._file, begin, self._end)

    def _plain_items(self, at: int) -> list[YamlNode] | None:
        """Read a list that has plain texts in it up to its bracket, None where it has something else."""
        file, plain, room = self._file, self._plain_in_brackets, self._most - self.size
        values = plain.values
        items: list[YamlNode] = []
        closing = ", "
        while closing == ", " and (found := _PLAIN_ITEMS(self._text, at)):
            words, closing = found.groups()
            for word in words.split(", "):
                if word not in values and not plain.learns(word):
                    return None
                items.append(new(YamlScalar, (word, values[word], file, at, None)))
                at += len(word) + 2
            if len(items) > room:
                raise _NotSimpleError
        if closing == ", ":
            return None
        self.size += len(items)
        self._end = at - 1
        return items

    def _map_in_braces(self, begin: int, depth: int) -> YamlMap:
        text, file, plain = self._text, self._file, self._plain_in_brackets
        values = plain.values
        entries: dict[str, YamlEntry] = {}
        uncounted, room = 0, self._room(depth)
        at = self._skipped(begin + 1)
        is_closed = text[at] == "}"
        at += is_closed
        value: YamlNode
        while not is_closed:
            if found := _PAIR_IN_BRACES(text, at):
                name, word, closing = found.groups()
            else:
                name, word = self._odd_key(at, plain), None
            key = new(YamlScalar, (name, name, file, at, None))
            uncounted += 2
            if found and word is not None and (word in values or plain.learns(word)):
                value = new(YamlScalar, (word, values[word], file, at + len(name) + 2, None))
                at, is_closed = found.end(), closing == "}"
                if not is_closed and text[at] in " \n#}":
                    at = self._skipped(at)
                    is_closed = text[at] == "}"
                    at += is_closed
            else:
                self.size += uncounted
                value = self._in_brackets(self._skipped(at + len(name) + 1), depth + 1)
                is_closed = self._closes("}")
                at = self._end
                uncounted, room = 0, self._most - self.size
            if name in entries or uncounted > room:
                raise _NotSimpleError
            entries[name] = new(YamlEntry, (key, value, None))
        self.size += uncounted
        self._end = at
        return _new_map(entries, file, begin, at)
