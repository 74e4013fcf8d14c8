"""Finds `# linkforge: ignore LF6003`, which no YAML parser tells of, in a file's text."""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Callable, Iterator

import yaml
from yaml.events import ScalarEvent

from linkforge_compile.diagnostics.ignores import Ignore
from linkforge_compile.limits import Budget, Limit
from linkforge_compile.source import SourceFile, Span
from linkforge_compile.syntax.event_reader import MAX_READ_TWICE, PARSER
from linkforge_compile.syntax.ignore_words import IGNORE_WORDS
from linkforge_compile.syntax.marks import Marks

_COMMENT = re.compile(r"(?<!\S)#[ \t]*linkforge:[ \t]*ignore(?!\w)(?P<codes>(?:[ \t,]+(?i:LF)\w+)*)")
_MEANT_AS_ONE = re.compile(rf"(?<!\S)#[^#\r\n]*?(?<!\w){IGNORE_WORDS.pattern}(?:[ \t,:=]+(?i:LF)\w+)*")
_CODE = re.compile(r"LF\w+", re.IGNORECASE)
_NOTHING_BUT_COMMENT = re.compile(r"\s*(#.*)?")


def ignore_comments(file: SourceFile, budget: Budget | None = None) -> Iterator[Ignore]:
    """Yield the comments that name codes to ignore: those of their line, or of the next where they stand alone.

    What follows the codes is the author's reason. One that is meant so and written otherwise, such as
    `# linkforge: disable LF6003`, comes as well, not understood. They are counted in the budget, without one in their
    own.
    """
    marks = Marks(file)
    if not _MEANT_AS_ONE.search(marks.text) or (texts := _texts(marks)) is None:
        return
    budget = budget or Budget()
    starts, line_meant = [text.start for text in texts], _lines_meant(file)
    for meant in _MEANT_AS_ONE.finditer(marks.text):
        comment = _COMMENT.match(marks.text, meant.start())
        comment, is_understood = comment or meant, comment is not None
        span = marks.part(comment.start(), len(comment[0]))
        before = bisect_right(starts, span.start)
        if before and span.start < texts[before - 1].end:
            continue
        # A comment without a code is one thing to tell of as well.
        budget.spend(Limit.IGNORED_CODES, max(1, len(_CODE.findall(comment[0]))), span)
        codes = (
            (code[0], marks.part(code.start(), len(code[0]))) for code in _CODE.finditer(marks.text, *comment.span())
        )
        yield Ignore(span, line_meant(span.line), tuple(codes), is_understood)


def _lines_meant(file: SourceFile) -> Callable[[int], int]:
    """Return what gives the line that a comment on a line is about: that, or the next that has other words.

    It is asked for lines from the first to the last, and looks at each line once, however many comments there are.
    """
    meant = 0

    def line_meant(line: int) -> int:
        nonlocal meant
        meant = max(meant, line)
        while meant < len(file.lines) and _NOTHING_BUT_COMMENT.fullmatch(file.line(meant)):
            meant += 1
        return meant

    return line_meant


def _texts(marks: Marks) -> tuple[Span, ...] | None:
    """Return where the file's scalars are, in its order: what looks like a comment in them is none.

    None for what is no YAML.
    """
    for parser in (PARSER, yaml.BaseLoader):
        try:
            events = yaml.parse(marks.text, Loader=parser)
            return tuple(marks.scalar(event) for event in events if isinstance(event, ScalarEvent))
        except yaml.YAMLError:
            # As when the file was read: what libyaml refuses, PyYAML's slow parser may take.
            if len(marks.text) > MAX_READ_TWICE:
                break
    return None
