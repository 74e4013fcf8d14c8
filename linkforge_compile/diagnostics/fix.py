"""Fixes: edits of a file that remove the cause of a diagnostic."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import NamedTuple

from linkforge_compile.source import SourceFile, Span
from linkforge_compile.source.characters import on_one_line

_LONGEST = 2_000
"""Characters of a text in which a word is looked for, and of what replaces it."""

_PREFIX = "$(prefix)"
"""The prefix of a module, which messages show as it is in the robot."""

_QUOTES = ("'", '"')
_MARKS_OF_FLOW = (",", "[", "]", "{", "}")

_PLAIN = re.compile(r"[\w./+~°µμ-](?:[\w ./+~*^()²³·°-]*[\w./+~*^()²³·°-])?")
"""A word that means the same without quotes, also in a flow list or map."""


class Edit(NamedTuple):
    """The text that replaces what a span contains; an empty span is a place at which to insert it."""

    span: Span
    text: str


@dataclass(frozen=True)
class Fix:
    """Edits of one or several files that belong together, and what they do, such as "write 'rod'".

    A safe one is certain: it is what the author intended, and changes nothing that compiles today.
    """

    title: str
    edits: tuple[Edit, ...]
    is_safe: bool = False

    def __post_init__(self) -> None:
        object.__setattr__(self, "title", on_one_line(self.title))


class Replacement(NamedTuple):
    """What to write in place of a part of a span; of the whole span if `old` is empty."""

    old: str
    new: str
    is_safe: bool = False
    is_whole: bool = False
    """Whether `old` has to be all that the span contains, without the quotes around it, which are replaced too."""

    def filled(self, facts: Mapping[str, object]) -> Replacement | None:
        """Return it with facts for its `{name}` fields; None if there is no such fact."""
        try:
            return self._replace(old=self.old.format_map(facts), new=self.new.format_map(facts))
        except KeyError:
            return None

    def within(self, span: Span | None) -> Fix | None:
        """Return the fix of a text in a spec; None if the span does not have `old` exactly once.

        An expression computes the value that a message shows, so nothing in one is replaced by a word.
        """
        if span is None or span.file.is_xml:
            return None
        begin, end = span.range
        if end - begin > _LONGEST or len(self.new) > _LONGEST:
            return None
        text = span.full_text
        if after_prefix := self._after_prefix(text):
            return after_prefix.within(span.file.between(begin + text.index(_PREFIX) + len(_PREFIX), end))
        if (self.old and text.count(self.old) != 1) or ("$(" in text and "$" not in self.old):
            return None
        title = f"write '{self.new}'" if self.new else f"remove '{self.old}'"
        quote = text[0] if text and text[0] in _QUOTES else ""
        if not self.old or self.is_whole:
            if self.old not in (text, text.strip(quote), ""):
                return None
            return Fix(title, (Edit(span, _in_quotes(self.new, quote)),), self.is_safe)
        at = begin + text.find(self.old)
        if quote and at > begin and {quote, "\\"} & {*self.new}:
            return None
        return Fix(title, (Edit(span.file.between(at, at + len(self.old)), self.new),), self.is_safe)

    def _after_prefix(self, text: str) -> Replacement | None:
        """Return what to write after the `$(prefix)` that begins a text; None for other texts and prefixes."""
        before, prefix, name = text.strip("'\"").partition(_PREFIX)
        own = self.old.removesuffix(name)
        is_name = prefix and name and not before and own != self.old and self.new.startswith(own)
        return self._replace(old=name, new=self.new.removeprefix(own)) if is_name else None

    def is_word_for(self, span: Span | None) -> bool:
        """Whether `new` keeps its meaning in place of a name, in the quotes that the span has or without any."""
        quote = span.full_text[:1] if span else ""
        return not {*"'\"\\\n"} & {*self.new} if quote in _QUOTES else _PLAIN.fullmatch(self.new) is not None


def _in_quotes(value: str, quote: str) -> str:
    """Return a value in quotes if it is an expression that needs them, or had them."""
    if "$(" not in value or not (quote or any(mark in value for mark in _MARKS_OF_FLOW)):
        return value
    other = next((one for one in (quote, '"', "'") if one and one not in value), None)
    return f"{other}{value}{other}" if other and "\\" not in value else value


def shift_lines(place: Span, columns: int) -> tuple[Edit, ...]:
    """Return the edits that move the lines of a place to the right, or to the left as far as they have spaces.

    Empty lines stay as they are. The line on which a place ends before its first column is none of its lines.
    """
    edits = []
    for line in range(place.line, place.end_line + (place.end_column > 1)):
        text = place.file.line(line)
        if text.strip() and columns:
            removed = min(max(-columns, 0), len(text) - len(text.lstrip(" ")))
            edits.append(Edit(Span(place.file, line, 1, line, 1 + removed), " " * columns))
    return tuple(edits)


def shift_lines_below(place: Span, columns: int) -> tuple[Edit, ...]:
    """Return the edits that move the lines of a place but for the first one."""
    return shift_lines(place._replace(line=place.line + 1), columns)


def without_overlaps(fixes: Iterable[Fix]) -> list[Fix]:
    """Return the fixes that can be applied together: of two that change the same text, the first."""
    taken: dict[str, list[tuple[int, int]]] = {}
    kept = []
    for fix in fixes:
        places = [(taken.setdefault(edit.span.file.name, []), *edit.span.range) for edit in fix.edits]
        if not any(
            begin <= end_of_other and begin_of_other <= end
            for others, begin, end in places
            for begin_of_other, end_of_other in others
        ):
            kept.append(fix)
            for others, begin, end in places:
                others.append((begin, end))
    return kept


def apply_edits(file: SourceFile, edits: Iterable[Edit]) -> str:
    """Return the text of a file with its byte order mark after edits, none of which overlap."""
    text = file.counted
    return file.text.removesuffix(text) + edited(file.between(0, len(text)), edits)


def edited(place: Span, edits: Iterable[Edit]) -> str:
    """Return the text of a place after edits in it, none of which overlap."""
    text, (at, end) = place.file.counted, place.range
    parts: list[str] = []
    for begin, after, new in sorted((*edit.span.range, edit.text) for edit in edits):
        assert begin >= at, "edits do not overlap"
        parts += (text[at:begin], new)
        at = after
    return "".join((*parts, text[at:end]))
