"""Fixes: edits of a file that remove the cause of a diagnostic."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import NamedTuple

from linkforge_compile.source import SourceFile, Span
from linkforge_compile.source.characters import on_one_line

_LONGEST = 2_000
"""Characters of a text in which a word is looked for, and of what replaces it."""

_PLAIN = re.compile(r"[\w./+~°µμ-](?:[\w ./+~*^()²³·°-]*[\w./+~*^()²³·°-])?")
"""A word that means the same without quotes, also in a flow list or map."""


class Edit(NamedTuple):
    """The text that replaces what a span contains; an empty span is a place at which to insert it."""

    span: Span
    text: str

    @property
    def range(self) -> tuple[int, int]:
        """The indexes of its begin and end in the text of the file, without byte order mark."""
        return self.span.file.index_of(*self.span.start), self.span.file.index_of(*self.span.end)


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

    def within(self, span: Span | None) -> Fix | None:
        """Return the fix of a text in a spec; None if the span does not have `old` exactly once.

        An expression computes the value that a message shows, so nothing in one is replaced by a word.
        """
        if span is None or span.file.is_xml:
            return None
        begin, end = span.file.index_of(*span.start), span.file.index_of(*span.end)
        if end - begin > _LONGEST or len(self.new) > _LONGEST:
            return None
        text = span.file.counted[begin:end]
        if self.old and (text.count(self.old) != 1 or ("$(" in text and not self.old.startswith("$"))):
            return None
        at = begin + (text.find(self.old) if self.old else 0)
        place = span.file.between(at, at + len(self.old or text))
        title = f"write '{self.new}'" if self.new else f"leave out '{self.old}'"
        return Fix(title, (Edit(place, self.new),), self.is_safe)

    def is_word_for(self, span: Span | None) -> bool:
        """Whether `new` keeps its meaning in place of a name, in the quotes that the span has or without any."""
        quote = span.file.counted[span.file.index_of(*span.start)] if span and span.start != span.end else ""
        return not {*"'\"\\\n"} & {*self.new} if quote in ("'", '"') else _PLAIN.fullmatch(self.new) is not None


def without_overlaps(fixes: Iterable[Fix]) -> list[Fix]:
    """Return the fixes that can be applied together: of two that change the same text, the first."""
    taken: dict[str, list[tuple[int, int]]] = {}
    kept = []
    for fix in fixes:
        places = [(taken.setdefault(edit.span.file.name, []), *edit.range) for edit in fix.edits]
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
    text, mark = file.counted, file.text[: len(file.text) - len(file.counted)]
    parts, at = [mark], 0
    for begin, end, new in sorted((*edit.range, edit.text) for edit in edits):
        assert begin >= at, "edits do not overlap"
        parts += (text[at:begin], new)
        at = end
    return "".join((*parts, text[at:]))
