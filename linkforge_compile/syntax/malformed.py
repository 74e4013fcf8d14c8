"""What is wrong with text that no YAML parser can read, in the words of who wrote it."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from yaml import MarkedYAMLError
from yaml.events import CollectionStartEvent, ScalarEvent

from linkforge_compile.diagnostics import Diagnostic, Note
from linkforge_compile.diagnostics.codes import syntax as codes
from linkforge_compile.diagnostics.codes.expressions import UNCLOSED_EXPRESSION
from linkforge_compile.source import Span
from linkforge_compile.source.characters import LIKE_SPACES, code_point
from linkforge_compile.syntax.marks import Marks
from linkforge_compile.syntax.scalars import IN_QUOTES, is_cut_expression
from linkforge_compile.syntax.xacro import XACRO_EXPRESSION, xacro_facts

_LINE = re.compile(r"[^\r\n]+")
_MARK_OF_COMMENT = re.compile(r"(?<!\S)#")
_COMMENT = re.compile(r"(?:^|\s)#.*")
_COMMENT_AS_VALUE = re.compile(r"[:,\[][ \t]{1,9}(#[^\s#,\]}]+)[^\r\n]*")
_KEY_STUCK_TO_VALUE = re.compile(r"\s*(?:-\s+)?([^\s:'\"]+:(?!//)[^\s:]\S*)")
_WORD = re.compile(r"\w[\w$().-]*")
_FIRST_WORD = re.compile(r"([A-Za-z]\w*) +\S")
_ITEM_STUCK_TO_DASH = re.compile(r"\s*(-[^\s-]\S*)")
_KEY_STUCK_TO_DASH = re.compile(r"\s*(-(?:<<|[^\W\d])[^\s:]*:)(?!\S)")
_TWO_KEYS = re.compile(r"([\w.-]+):\s+(\w+)\Z")
_IN_EXPRESSION = re.compile(r"'[^'\r\n]*'|\"[^\"\r\n]*\"|\$\(|[][(){}]")
_LONGEST_EXPRESSION = 2_000
_ESCAPE_OF_NUMBER = re.compile(r"\\(?:u[0-9A-Fa-f]{4}|U[0-9A-Fa-f]{8})")
_MERGE_CONFLICT = re.compile(r"^(?:<{7} .*|={7}$|>{7} .*)", re.MULTILINE)
_LINE_OF_ENTRY = re.compile(r"\s*(?:-[ \t]+)?[\w$().-]+:(?!\S)")


def explain_cut(event: ScalarEvent, marks: Marks) -> Diagnostic:
    """Return what is wrong with an expression that ended before its `)`: it needs quotes, or there is none."""
    assert event.start_mark is not None, "the parser marks every event"
    assert event.end_mark is not None, "the parser marks every event"
    opening = marks.text.rfind("$(", event.start_mark.index, event.end_mark.index)
    if _closes(marks.text, opening + len("$(")):
        return codes.UNQUOTED_EXPRESSION.at(marks.scalar(event))
    return UNCLOSED_EXPRESSION.at(marks.part(opening, len("$(")))


def _closes(text: str, start: int) -> bool:
    """Whether a `)` comes for the parenthesis before `start`, before what stands in no expression."""
    closing = [")"]
    for token in _IN_EXPRESSION.finditer(text, start, start + _LONGEST_EXPRESSION):
        if token[0] in ("(", "["):
            closing.append(")" if token[0] == "(" else "]")
        elif token[0][0] not in "'\"" and token[0] != closing.pop():
            return False
        if not closing:
            return True
    return False


@dataclass(frozen=True)
class _Trouble:
    """Where the parser stopped, as indexes into the text: at `at`, reading what began at `began`."""

    problem: str
    construct: str
    at: int
    began: int
    marks: Marks
    last_scalar: ScalarEvent | None
    brackets: Sequence[CollectionStartEvent]

    @property
    def character(self) -> str:
        """The character where it stopped, "" at the end of the file."""
        return self.marks.text[self.at : self.at + 1]

    @property
    def here(self) -> Span:
        return self.marks.part(self.at, len(self.character.strip("\r\n")))

    @property
    def before(self) -> str:
        """What stands before it on its line."""
        here = self.here
        return here.file.line(here.line)[: here.column - 1]

    def found(self, pattern: re.Pattern[str], line: int) -> Span | None:
        """Return the span of the first group of a pattern that a line begins with."""
        found = pattern.match(self.marks.file.line(line))
        return Span(self.marks.file, line, found.start(1) + 1, line, found.end(1) + 1) if found else None

    def quoted_before(self) -> Span | None:
        """Return the text in quotes that ended just before it, if that goes over several lines."""
        last = self.last_scalar
        if last is None or last.style not in ("'", '"'):
            return None
        span = self.marks.scalar(last)
        is_just_before = span.end_line == self.here.line and not self.before[span.end_column - 1 :].strip()
        return span if is_just_before and span.line < span.end_line else None

    def around(self) -> list[Note]:
        """Return where the bracket opens that all this stands in, if above: it may lack its end."""
        begins = [self.marks.begin(bracket) for bracket in self.brackets]
        # A pair in a list, `[a: 1]`, is a map without a bracket.
        opened = [self.marks.part(begin, 1) for begin in begins if self.marks.text[begin] in "[{&!"]
        return [Note("inside the bracket that opens here", one) for one in opened[-1:] if one.line < self.here.line]

    def line_above(self, line: int | None = None) -> int:
        """Return the number of the last line above one, unless said this one, that says something; 0 for none."""
        line = (self.here.line if line is None else line) - 1
        while line and not _said(self.marks.file.line(line)):
            line -= 1
        return line


def _explain(
    error: MarkedYAMLError, marks: Marks, last_scalar: ScalarEvent | None, brackets: Sequence[CollectionStartEvent]
) -> Diagnostic:
    end = len(marks.text)
    at = min(error.problem_mark.index, end) if error.problem_mark else end
    began = error.context_mark.index if error.context_mark else at
    trouble = _Trouble(error.problem or "", error.context or "", at, began, marks, last_scalar, brackets)
    if quoted := trouble.quoted_before():
        return _text_in_quotes_ended(trouble, quoted)
    for line in (trouble.line_above(), trouble.here.line):
        if (like_space := trouble.found(LIKE_SPACES, line)) and (character := like_space.text):
            return codes.TAB_INDENTATION.at(like_space, found=f"{code_point(character)}, which looks like one")
    for pattern, tell in _SENTENCES:
        if re.search(pattern, trouble.problem):
            return tell(trouble)
    return codes.MALFORMED_YAML.at(trouble.here, problem=trouble.problem)


def explain_every(
    error: MarkedYAMLError,
    marks: Marks,
    last_scalar: ScalarEvent | None,
    brackets: Sequence[CollectionStartEvent],
) -> Iterator[Diagnostic]:
    """Yield the diagnostic for a parser's error; where that is a habit of xacro, with every other like it in the file.

    `last_scalar` is the last one that could be read, `brackets` are the flow lists and maps that are open there.
    Reading ends at the first, and whoever carries a file over has a hundred of them.
    """
    if conflict := _MERGE_CONFLICT.search(marks.text):
        yield codes.MERGE_CONFLICT.at(marks.part(conflict.start(), len(conflict[0])))
        return
    first = _explain(error, marks, last_scalar, brackets)
    yield first
    if first.code is codes.XACRO_EXPRESSION:
        for line in _LINE.finditer(marks.text):
            comment = _MARK_OF_COMMENT.search(marks.text, line.start(), line.end())
            end = comment.start() if comment else line.end()
            yield from (
                _xacro_expression(each, marks) for each in XACRO_EXPRESSION.finditer(marks.text, line.start(), end)
            )


def _xacro_expression(found: re.Match[str], marks: Marks) -> Diagnostic:
    [facts] = xacro_facts(found[0])
    span = marks.part(found.start(), len(found[0]))
    return codes.XACRO_EXPRESSION.at(span, text=facts["text"], ours=facts["ours"])


def _said(line: str) -> str:
    return _COMMENT.sub("", line).strip()


def _tab(trouble: _Trouble) -> Diagnostic:
    return codes.TAB_INDENTATION.at(trouble.here, found="a tab")


def _reserved_character(trouble: _Trouble) -> Diagnostic:
    if trouble.character == "\t":
        return _tab(trouble)
    return codes.RESERVED_START.at(trouble.here, character=trouble.character, notes=trouble.around())


def _reserved_start(trouble: _Trouble) -> Diagnostic:
    return codes.RESERVED_START.at(trouble.marks.part(trouble.began, 1), character=trouble.marks.text[trouble.began])


def _colon_not_expected(trouble: _Trouble) -> Diagnostic:
    """Tell a second `: ` on a line from a fault of the line above that only shows at this one's colon."""
    if re.search(r":\s", trouble.before):
        keys = _TWO_KEYS.search(trouble.before)
        or_map = f", or a map in braces: '{keys[1]}: {{{keys[2]}: …}}'" if keys else ""
        return codes.SECOND_COLON.at(trouble.here, or_map=or_map)
    if fault := _faulty_key_above(trouble):
        return fault
    indentation = len(trouble.before) - len(trouble.before.lstrip())
    line = trouble.here.line
    return codes.TOO_DEEPLY_INDENTED.at(Span(trouble.marks.file, line, indentation + 1, line, trouble.here.column))


def _faulty_key_above(trouble: _Trouble) -> Diagnostic | None:
    above = trouble.line_above()
    if not above:
        return None
    if stuck := trouble.found(_KEY_STUCK_TO_DASH, above):
        return codes.SPACE_AFTER_DASH.at(stuck, text=stuck.text)
    if stuck := trouble.found(_KEY_STUCK_TO_VALUE, above):
        return codes.SPACE_AFTER_COLON.at(stuck, text=stuck.text)
    said = _said(trouble.marks.file.line(above))
    begins = _said(trouble.marks.file.line(trouble.line_above(above))).endswith(":")
    is_first = begins and _FIRST_WORD.match(said) and ": " not in said
    return _missing_colon(trouble, above) if is_first or _WORD.fullmatch(said) else None


def _missing_colon(trouble: _Trouble, line: int) -> Diagnostic:
    """Tell of a key without a colon: of a line that has nothing below it, the first word."""
    written = trouble.marks.file.line(line)
    said = _said(written)
    begin = written.find(said) + 1
    first = _FIRST_WORD.match(said)
    if first and len(written) - len(written.lstrip()) >= len(trouble.before) - len(trouble.before.lstrip()):
        said = first[1]
    return codes.MISSING_COLON.at(Span(trouble.marks.file, line, begin, line, begin + len(said)), text=said)


def _colon_expected(trouble: _Trouble) -> Diagnostic:
    line = trouble.marks.part(trouble.began, 0).line
    if stuck := trouble.found(_ITEM_STUCK_TO_DASH, line):
        return codes.SPACE_AFTER_DASH.at(stuck, text=stuck.text)
    if stuck := trouble.found(_KEY_STUCK_TO_VALUE, line):
        return codes.SPACE_AFTER_COLON.at(stuck, text=stuck.text)
    return _missing_colon(trouble, line)


def _entry_expected(trouble: _Trouble) -> Diagnostic:
    """Tell why a line is no entry of the map or list around it."""
    here = trouble.here
    if trouble.before.strip():
        if trouble.character in ("}", "]"):
            return codes.BRACKET_TOO_MANY.at(here, bracket=trouble.character)
        if trouble.character == "," and trouble.before.rstrip().endswith(("}", "]")):
            return codes.COMMA_AFTER_VALUE.at(here)
        return codes.TEXT_AFTER_VALUE.at(here)
    if stuck := trouble.found(_ITEM_STUCK_TO_DASH, here.line):
        return codes.SPACE_AFTER_DASH.at(stuck, text=stuck.text)
    if fault := _faulty_key_above(trouble):
        return fault
    in_map = "mapping" in trouble.construct
    if in_map and re.match(r"-\s", trouble.marks.text[trouble.at :]):
        return codes.ITEM_AMONG_KEYS.at(here)
    if not in_map and here.column == trouble.marks.part(trouble.began, 0).column:
        return codes.KEY_AMONG_ITEMS.at(here)
    above = here.file.line(trouble.line_above())
    deeper = len(trouble.before) > len(above) - len(above.lstrip())
    return (codes.TOO_DEEPLY_INDENTED if deeper else codes.UNEVEN_INDENTATION).at(here)


def _bracket_expected(trouble: _Trouble) -> Diagnostic:
    last, text = trouble.last_scalar, trouble.marks.text
    if last and not last.style and is_cut_expression(last.value):
        return explain_cut(last, trouble.marks)
    xacro = XACRO_EXPRESSION.match(text, max(trouble.at - len("$"), 0))
    if xacro:
        return _xacro_expression(xacro, trouble.marks)
    opening = trouble.marks.part(trouble.began, 1)
    closing = "]" if "sequence" in trouble.construct else "}"
    if comment := _comment_with(closing, trouble):
        return codes.COMMENT_TAKES_BRACKET.at(comment, text=comment.text, closing=closing)
    return codes.UNCLOSED_BRACKET.at(trouble.here, closing=closing, notes=[Note("opened here", opening)])


def _comment_with(closing: str, trouble: _Trouble) -> Span | None:
    """Return the first word of a comment that was meant as a value, such as #ff0000, and holds a bracket."""
    for comment in _COMMENT_AS_VALUE.finditer(trouble.marks.text, trouble.began, trouble.at):
        span = trouble.marks.part(comment.start(1), len(comment[1]))
        before = IN_QUOTES.sub("", span.file.line(span.line)[: span.column - 1])
        if closing in comment[0] and not re.search("['\"]", before):
            return span
    return None


def _unclosed_quote(trouble: _Trouble) -> Diagnostic:
    return codes.UNCLOSED_QUOTE.at(trouble.marks.part(trouble.began, 1))


def _text_in_quotes_ended(trouble: _Trouble, quoted: Span) -> Diagnostic:
    """Tell a closing quote that is missing from text behind one; the next of its kind ends the text, lines below."""
    opening = Span(quoted.file, quoted.line, quoted.column, quoted.line, quoted.column + 1)
    lines = range(quoted.line + 1, quoted.end_line + 1)
    if any(_LINE_OF_ENTRY.match(quoted.file.line(line)) for line in lines):
        ending = Span(quoted.file, quoted.end_line, quoted.end_column - 1, quoted.end_line, quoted.end_column)
        return codes.UNCLOSED_QUOTE.at(opening, notes=[Note("the next quote of its kind is here", ending)])
    return codes.TEXT_AFTER_VALUE.at(trouble.here, notes=[Note("the text in quotes begins here", opening)])


def _unknown_escape(trouble: _Trouble) -> Diagnostic:
    text = trouble.marks.text
    backslash = text.rfind("\\", trouble.began, trouble.at + 1)
    if escape := _ESCAPE_OF_NUMBER.match(text, backslash):
        number = int(escape[0][2:], 16)
        half = ", which is half of one; write the whole one as it is" if 0xD800 <= number < 0xE000 else ""
        place = trouble.marks.part(backslash, len(escape[0]))
        return codes.FORBIDDEN_CHARACTER.at(place, character=f"U+{number:04X}{half}")
    span = trouble.marks.part(backslash, 2)
    return codes.UNKNOWN_ESCAPE.at(span, text=span.text)


def _broken_tag(trouble: _Trouble) -> Diagnostic:
    """Tell a tag with a broken escape in it, such as !caf%E9, as the tag that it is."""
    text = trouble.marks.text
    start = max(text.rfind("!", 0, trouble.at + 1), 0)
    tag = text[start : trouble.at + 1].split("\n")[0]
    return codes.TAG.at(trouble.marks.part(start, max(len(tag), 1)), tag=tag)


def _value_expected(trouble: _Trouble) -> Diagnostic:
    found = f"'{trouble.character}'" if trouble.character.strip() else "the end of the file"
    return codes.MISSING_VALUE.at(trouble.here, found=found, notes=trouble.around())


def _document_ended(trouble: _Trouble) -> Diagnostic:
    """Tell a second document from a first line that is no key, which is a document by itself to the parser."""
    if _said(trouble.marks.file.line(trouble.line_above())) == "...":
        return codes.SEVERAL_DOCUMENTS.at(trouble.here)
    if trouble.character in ("}", "]"):
        return codes.BRACKET_TOO_MANY.at(trouble.here, bracket=trouble.character)
    return _faulty_key_above(trouble) or codes.TEXT_AFTER_VALUE.at(trouble.here)


_SENTENCES: tuple[tuple[str, Callable[[_Trouble], Diagnostic]], ...] = (
    (r"\btab\b", _tab),
    (r"cannot start any token", _reserved_character),
    (r"alphabetic or numeric|comment or (a )?line break|chomping", _reserved_start),
    (r"mapping keys are not allowed", lambda trouble: codes.RESERVED_START.at(trouble.here, character="?")),
    (r"mapping values are not allowed", _colon_not_expected),
    (r"could not find expected ':'", _colon_expected),
    (r"sequence entries are not allowed", lambda trouble: codes.LIST_ON_KEY_LINE.at(trouble.here)),
    (r"expected key|expected '-' indicator|expected <block end>", _entry_expected),
    (r"expected ',' or", _bracket_expected),
    (r"unexpected (end of stream|document)", _unclosed_quote),
    (r"URI|UTF-8 octet", _broken_tag),
    (r"escape|hexdecimal|hexadecimal", _unknown_escape),
    (r"node content", _value_expected),
    (r"<document start>", _document_ended),
)
"""What libyaml's and PyYAML's own parser say, and who puts it into plain words; the first that fits."""
