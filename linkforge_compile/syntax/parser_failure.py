"""Where the YAML parser stopped, and what is written around that place."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from yaml.events import CollectionStartEvent, ScalarEvent

from linkforge_compile.diagnostics import Diagnostic, Note
from linkforge_compile.source import Span
from linkforge_compile.syntax.fixes import space_after_colon, space_after_dash
from linkforge_compile.syntax.parser import Marks

_COMMENT = re.compile(r"(?:^|\s)#.*")
_KEY_STUCK_TO_VALUE = re.compile(r"\s*(?:-\s+)?([^\s:'\"]+:(?!//)[^\s:]\S*)")


@dataclass(frozen=True)
class Failure:
    """An error of the parser: it stopped at index `at` of the text, in a construct that began at `began`."""

    problem: str
    construct: str
    at: int
    began: int
    marks: Marks
    last_scalar: ScalarEvent | None
    brackets: Sequence[CollectionStartEvent]

    @property
    def character(self) -> str:
        """The character at which the parser stopped, "" at the end of the file."""
        return self.marks.text[self.at : self.at + 1]

    @property
    def here(self) -> Span:
        """The span of that character, empty at the end of a line."""
        return self.marks.part(self.at, len(self.character.strip("\r\n")))

    @property
    def before(self) -> str:
        """The text before it on its line."""
        here = self.here
        return here.file.line(here.line)[: here.column - 1]

    def match_line(self, pattern: re.Pattern[str], line: int) -> Span | None:
        """Return the span of the first group of a pattern matched at the start of a line."""
        found = pattern.match(self.marks.file.line(line))
        return Span(self.marks.file, line, found.start(1) + 1, line, found.end(1) + 1) if found else None

    def missing_space(self, line: int, stuck_to_dash: re.Pattern[str]) -> Diagnostic | None:
        """Return the error for a line without the space after its dash or its colon, None for other lines."""
        for pattern, fault in ((stuck_to_dash, space_after_dash), (_KEY_STUCK_TO_VALUE, space_after_colon)):
            if stuck := self.match_line(pattern, line):
                return fault(stuck, stuck.text or "")
        return None

    def quoted_text_before(self) -> Span | None:
        """Return the span of a quoted text of several lines that ends just before the error."""
        last = self.last_scalar
        if last is None or last.style not in ("'", '"'):
            return None
        span = self.marks.scalar(last)
        is_just_before = span.end_line == self.here.line and not self.before[span.end_column - 1 :].strip()
        return span if is_just_before and span.line < span.end_line else None

    def bracket_notes(self) -> list[Note]:
        """Return a note on the innermost open bracket, if it is on a line above: it may not be closed."""
        begins = [self.marks.begin(bracket) for bracket in self.brackets]
        # A pair in a list, `[a: 1]`, is a map without a bracket.
        opened = [self.marks.part(begin, 1) for begin in begins if self.marks.text[begin] in "[{&!"]
        return [Note("inside the bracket that opens here", one) for one in opened[-1:] if one.line < self.here.line]

    def line_above(self, line: int | None = None) -> int:
        """Return the number of the last line above a line (by default the error's) that is not empty; 0 for none."""
        line = (self.here.line if line is None else line) - 1
        while line and not strip_comment(self.marks.file.line(line)):
            line -= 1
        return line


def strip_comment(line: str) -> str:
    return _COMMENT.sub("", line).strip()
