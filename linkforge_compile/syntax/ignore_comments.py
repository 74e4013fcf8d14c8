"""Finds `# linkforge: ignore LF6003`, which no YAML parser tells of, in a file's text."""

from __future__ import annotations

import re
from collections.abc import Iterator

import yaml
from yaml.events import ScalarEvent

from linkforge_compile.diagnostics.ignores import Ignore
from linkforge_compile.source import SourceFile, Span
from linkforge_compile.syntax.marks import Marks
from linkforge_compile.syntax.reader import MAX_READ_TWICE, PARSER

# A search for plain text is a hundred times as fast as one for the pattern, and most files end here.
_WORDS = re.compile(r"linkforge:[ \t]*ignore")
_COMMENT = re.compile(r"(?<!\S)#[ \t]*linkforge:[ \t]*ignore(?!\w)(?P<codes>(?:[ \t,]+(?i:LF)\w+)*)")
_CODE = re.compile(r"LF\w+", re.IGNORECASE)
_NOTHING_BUT_COMMENT = re.compile(r"\s*(#.*)?")


def ignore_comments(file: SourceFile) -> Iterator[Ignore]:
    """Yield the comments that name codes to ignore: those of their line, or of the next where they stand alone.

    What follows the codes is the author's reason. A file without the words costs one search.
    """
    if not _WORDS.search(file.text):
        return
    marks = Marks(file, file.text.removeprefix("\ufeff"))
    found = list(_COMMENT.finditer(marks.text))
    if not found or (texts := _texts(marks)) is None:
        return
    for comment in found:
        span = marks.part(comment.start(), len(comment[0]))
        if any(text.start <= span.start < text.end for text in texts):
            continue
        codes = (
            (code[0], marks.part(code.start(), len(code[0])))
            for code in _CODE.finditer(marks.text, *comment.span("codes"))
        )
        yield Ignore(span, _line_meant(file, span), tuple(codes))


def _line_meant(file: SourceFile, comment: Span) -> int:
    """Return the line that a comment is about: its own, or where it has no other words the next that has some."""
    line = comment.line
    while line < len(file.lines) and _NOTHING_BUT_COMMENT.fullmatch(file.line(line)):
        line += 1
    return line


def _texts(marks: Marks) -> tuple[Span, ...] | None:
    """Return where the file's scalars are: what looks like a comment in them is none. None for what is no YAML."""
    for parser in (PARSER, yaml.BaseLoader):
        try:
            events = yaml.parse(marks.text, Loader=parser)
            return tuple(marks.scalar(event) for event in events if isinstance(event, ScalarEvent))
        except yaml.YAMLError:
            # As when the file was read: what libyaml refuses, PyYAML's slow parser may take.
            if len(marks.text) > MAX_READ_TWICE:
                break
    return None
