"""Find comments such as `# linkforge: ignore LF6003` in the text of a file."""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Callable, Iterator

import yaml
from yaml.events import ScalarEvent

from linkforge_compile.diagnostics.reports import Suppression
from linkforge_compile.limits import Budget, Limit
from linkforge_compile.source import SourceFile, Span
from linkforge_compile.syntax.marks import Marks
from linkforge_compile.syntax.reader import MAX_READ_TWICE, PARSER

IGNORE_WORDS = re.compile(r"linkforge[: \t]+(?:ignore|disable|suppress|skip|noqa|nolint)\b")
"""Found in every text that has such a comment; a search for it is much faster than for a whole comment."""

_COMMENT = re.compile(r"(?<!\S)#[ \t]*linkforge:[ \t]*ignore(?!\w)(?P<codes>(?:[ \t,]+(?i:LF)\w+)*)")
_LIKE_A_COMMENT = re.compile(rf"(?<!\S)#[^#\r\n]*?(?<!\w){IGNORE_WORDS.pattern}(?:[ \t,:=]+(?i:LF)\w+)*")
_CODE = re.compile(r"LF\w+", re.IGNORECASE)
_NOTHING_BUT_COMMENT = re.compile(r"\s*(#.*)?")


def suppressions_in(file: SourceFile, budget: Budget | None = None) -> Iterator[Suppression]:
    """Yield the comments that name codes to ignore, on their own line or, if alone on it, on the next.

    The text after the codes is the author's reason. Comments that are spelled otherwise, such as
    `# linkforge: disable LF6003`, are yielded as not understood. Each is charged to the budget.
    """
    marks = Marks(file)
    if not _LIKE_A_COMMENT.search(marks.text) or (texts := _texts(marks)) is None:
        return
    budget = budget or Budget()
    starts, line_of = [text.start for text in texts], _find_lines(file)
    for found in _LIKE_A_COMMENT.finditer(marks.text):
        comment = _COMMENT.match(marks.text, found.start())
        comment, is_understood = comment or found, comment is not None
        span = marks.part(comment.start(), len(comment[0]))
        before = bisect_right(starts, span.start)
        if before and span.start < texts[before - 1].end:
            continue
        # A comment without a code is reported as well.
        budget.spend(Limit.IGNORED_CODES, max(1, len(_CODE.findall(comment[0]))), span)
        codes = (
            (code[0], marks.part(code.start(), len(code[0]))) for code in _CODE.finditer(marks.text, *comment.span())
        )
        yield Suppression(span, line_of(span.line), tuple(codes), is_understood)


def _find_lines(file: SourceFile) -> Callable[[int], int]:
    """Return a function from the line of a comment to the line that it is about.

    It must be called with increasing lines, and looks at each line once, however many comments there are.
    """
    target = 0

    def line_of(line: int) -> int:
        nonlocal target
        target = max(target, line)
        while target < len(file.lines) and _NOTHING_BUT_COMMENT.fullmatch(file.line(target)):
            target += 1
        return target

    return line_of


def _texts(marks: Marks) -> tuple[Span, ...] | None:
    """Return the spans of the file's scalars, in which a `#` begins no comment; None if it is not YAML."""
    for parser in (PARSER, yaml.BaseLoader):
        try:
            events = yaml.parse(marks.text, Loader=parser)
            return tuple(marks.scalar(event) for event in events if isinstance(event, ScalarEvent))
        except yaml.YAMLError:
            # As in the reader: what libyaml rejects, PyYAML's slow parser may accept.
            if len(marks.text) > MAX_READ_TWICE:
                break
    return None
