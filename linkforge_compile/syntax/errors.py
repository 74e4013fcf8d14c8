"""Explain the errors of the YAML parser in terms of what the user wrote."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence

from yaml import MarkedYAMLError
from yaml.events import CollectionStartEvent, ScalarEvent

from linkforge_compile.diagnostics import Diagnostic, Note
from linkforge_compile.diagnostics.codes import syntax as codes
from linkforge_compile.diagnostics.codes.expressions import UNCLOSED_EXPRESSION
from linkforge_compile.diagnostics.fix import Fix
from linkforge_compile.source import Span
from linkforge_compile.source.characters import LIKE_SPACES, code_point
from linkforge_compile.syntax.fixes import (
    brace_rest,
    closing_index,
    indent_with_spaces,
    list_on_next_line,
    put_in_quotes,
    quote_rest,
    replace_like_spaces,
    sides_of_conflict,
    single_quotes,
    space_after_dash,
)
from linkforge_compile.syntax.nodes import IN_QUOTES, MAX_DEPTH, XACRO_EXPRESSION, is_cut_expression, xacro_facts
from linkforge_compile.syntax.parser import Marks
from linkforge_compile.syntax.parser_failure import Failure, strip_comment

_LINE = re.compile(r"[^\r\n]+")
_MARK_OF_COMMENT = re.compile(r"(?<!\S)#")
_COMMENT_AS_VALUE = re.compile(r"[:,\[][ \t]{1,9}(#[^\s#,\]}]+)[^\r\n]*")
_WORD = re.compile(r"\w[\w$().-]*")
_FIRST_WORD = re.compile(r"([A-Za-z]\w*) +\S")
_ITEM_STUCK_TO_DASH = re.compile(r"\s*(-[^\s-]\S*)")
_KEY_STUCK_TO_DASH = re.compile(r"\s*(-(?:<<|[^\W\d])[^\s:]*:)(?!\S)")
_TWO_KEYS = re.compile(r"([\w.-]+):\s+(\w+)\Z")
_AFTER_COLON = re.compile(r"^.*:\s+")
_ESCAPE_OF_NUMBER = re.compile(r"\\(?:u[0-9A-Fa-f]{4}|U[0-9A-Fa-f]{8})")
_MERGE_CONFLICT = re.compile(r"^(?:<{7} .*|={7}$|>{7} .*)", re.MULTILINE)
_LINE_OF_ENTRY = re.compile(r"\s*(?:-[ \t]+)?[\w$().-]+:(?!\S)")


def explain_cut_expression(event: ScalarEvent, marks: Marks) -> Diagnostic:
    """Return the error for an expression that ends before its `)`: it needs quotes, or the `)` is missing."""
    assert event.start_mark is not None, "the parser marks every event"
    assert event.end_mark is not None, "the parser marks every event"
    opening = marks.text.rfind("$(", event.start_mark.index, event.end_mark.index)
    if closing := closing_index(marks.text, opening + len("$(")):
        fix = put_in_quotes(marks.file, marks.scalar_ends(event)[0], closing)
        return codes.UNQUOTED_EXPRESSION.at(marks.scalar(event)).with_fix(fix)
    return UNCLOSED_EXPRESSION.at(marks.part(opening, len("$(")))


def _explain(
    error: MarkedYAMLError, marks: Marks, last_scalar: ScalarEvent | None, brackets: Sequence[CollectionStartEvent]
) -> Diagnostic:
    end = len(marks.text)
    at = min(error.problem_mark.index, end) if error.problem_mark else end
    began = error.context_mark.index if error.context_mark else at
    failure = Failure(error.problem or "", error.context or "", at, began, marks, last_scalar, brackets)
    if quoted := failure.quoted_text_before():
        return _explain_after_quote(failure, quoted)
    for line in (failure.line_above(), failure.here.line):
        if (like_space := failure.match_line(LIKE_SPACES, line)) and (character := like_space.text):
            fault = codes.TAB_INDENTATION.at(like_space, found=f"{code_point(character)}, which looks like one")
            return fault.with_fix(replace_like_spaces(marks.file))
    for pattern, explain in _EXPLANATIONS:
        if re.search(pattern, failure.problem):
            return explain(failure)
    return codes.MALFORMED_YAML.at(failure.here, problem=failure.problem)


def explain_parser_error(
    error: MarkedYAMLError,
    marks: Marks,
    last_scalar: ScalarEvent | None,
    brackets: Sequence[CollectionStartEvent],
) -> Iterator[Diagnostic]:
    """Yield the diagnostic for a parser's error; for an expression of xacro, one for each in the file.

    `last_scalar` is the last one that could be read, `brackets` are the flow lists and maps that are open.
    A file carried over from xacro has many such expressions, but the parser stops at the first.
    """
    if conflict := _MERGE_CONFLICT.search(marks.text):
        fault = codes.MERGE_CONFLICT.at(marks.part(conflict.start(), len(conflict[0])))
        yield fault.with_fix(*sides_of_conflict(marks.file, conflict.start()))
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


def _explain_tab(failure: Failure) -> Diagnostic:
    fault = codes.TAB_INDENTATION.at(failure.here, found="a tab")
    return fault if failure.before.strip() else fault.with_fix(indent_with_spaces(failure.marks.file))


def _explain_reserved_character(failure: Failure) -> Diagnostic:
    if failure.character == "\t":
        return _explain_tab(failure)
    fault = codes.RESERVED_START.at(failure.here, character=failure.character, notes=failure.bracket_notes())
    return fault.with_fix(quote_rest(failure.marks.file, failure.at, is_flow=bool(failure.brackets)))


def _explain_reserved_start(failure: Failure) -> Diagnostic:
    fault = codes.RESERVED_START.at(failure.marks.part(failure.began, 1), character=failure.marks.text[failure.began])
    return fault.with_fix(quote_rest(failure.marks.file, failure.began, is_flow=bool(failure.brackets)))


def _explain_colon(failure: Failure) -> Diagnostic:
    """Explain a colon: a second one on its line, or the first after a fault in the line above."""
    if re.search(r":\s", failure.before):
        keys = _TWO_KEYS.search(failure.before)
        or_map = f", or a map in braces: '{keys[1]}: {{{keys[2]}: …}}'" if keys else ""
        file, begin = failure.marks.file, failure.at - len(_AFTER_COLON.sub("", failure.before))
        in_braces = brace_rest(file, begin) if keys and not failure.brackets else None
        in_quotes = quote_rest(file, begin, is_flow=bool(failure.brackets))
        return codes.SECOND_COLON.at(failure.here, or_map=or_map).with_fix(in_braces, in_quotes)
    if fault := _find_fault_above(failure):
        return fault
    indentation = len(failure.before) - len(failure.before.lstrip())
    line = failure.here.line
    return codes.TOO_DEEPLY_INDENTED.at(Span(failure.marks.file, line, indentation + 1, line, failure.here.column))


def _find_fault_above(failure: Failure) -> Diagnostic | None:
    above = failure.line_above()
    if not above:
        return None
    if fault := failure.missing_space(above, _KEY_STUCK_TO_DASH):
        return fault
    content = strip_comment(failure.marks.file.line(above))
    begins = strip_comment(failure.marks.file.line(failure.line_above(above))).endswith(":")
    is_first = begins and _FIRST_WORD.match(content) and ": " not in content
    return _report_missing_colon(failure, above) if is_first or _WORD.fullmatch(content) else None


def _report_missing_colon(failure: Failure, line: int) -> Diagnostic:
    """Report a key without a colon: the whole line, or its first word if nothing is indented below it."""
    written = failure.marks.file.line(line)
    content = strip_comment(written)
    begin = written.find(content) + 1
    first = _FIRST_WORD.match(content)
    if first and len(written) - len(written.lstrip()) >= len(failure.before) - len(failure.before.lstrip()):
        content = first[1]
    return codes.MISSING_COLON.at(Span(failure.marks.file, line, begin, line, begin + len(content)), text=content)


def _explain_missing_colon(failure: Failure) -> Diagnostic:
    line = failure.marks.part(failure.began, 0).line
    return failure.missing_space(line, _ITEM_STUCK_TO_DASH) or _report_missing_colon(failure, line)


def _explain_line(failure: Failure) -> Diagnostic:
    """Explain why a line is no entry of the map or list around it."""
    here = failure.here
    if failure.before.strip():
        if failure.character in ("}", "]"):
            return codes.BRACKET_TOO_MANY.at(here, bracket=failure.character)
        if failure.character == "," and failure.before.rstrip().endswith(("}", "]")):
            return codes.COMMA_AFTER_VALUE.at(here)
        return codes.TEXT_AFTER_VALUE.at(here).with_fix(_quote_value(failure))
    if stuck := failure.match_line(_ITEM_STUCK_TO_DASH, here.line):
        return space_after_dash(stuck, stuck.text or "")
    if fault := _find_fault_above(failure):
        return fault
    in_map = "mapping" in failure.construct
    if in_map and re.match(r"-\s", failure.marks.text[failure.at :]):
        return codes.ITEM_AMONG_KEYS.at(here)
    if not in_map and here.column == failure.marks.part(failure.began, 0).column:
        return codes.KEY_AMONG_ITEMS.at(here)
    above = here.file.line(failure.line_above())
    deeper = len(failure.before) > len(above) - len(above.lstrip())
    return (codes.TOO_DEEPLY_INDENTED if deeper else codes.UNEVEN_INDENTATION).at(here)


def _explain_bracket(failure: Failure) -> Diagnostic:
    last, text = failure.last_scalar, failure.marks.text
    if last and not last.style and is_cut_expression(last.value):
        return explain_cut_expression(last, failure.marks)
    xacro = XACRO_EXPRESSION.match(text, max(failure.at - len("$"), 0))
    if xacro:
        return _xacro_expression(xacro, failure.marks)
    opening = failure.marks.part(failure.began, 1)
    closing = "]" if "sequence" in failure.construct else "}"
    if comment := _find_comment_with(closing, failure):
        fault = codes.COMMENT_TAKES_BRACKET.at(comment, text=comment.text, closing=closing)
        return fault.replacing("", f"'{comment.text}'")
    return codes.UNCLOSED_BRACKET.at(failure.here, closing=closing, notes=[Note("opened here", opening)])


def _find_comment_with(closing: str, failure: Failure) -> Span | None:
    """Return the first word of a comment with a bracket in it that was intended as a value, such as #ff0000."""
    for comment in _COMMENT_AS_VALUE.finditer(failure.marks.text, failure.began, failure.at):
        span = failure.marks.part(comment.start(1), len(comment[1]))
        before = IN_QUOTES.sub("", span.file.line(span.line)[: span.column - 1])
        if closing in comment[0] and not re.search("['\"]", before):
            return span
    return None


def _explain_after_quote(failure: Failure, quoted: Span) -> Diagnostic:
    """Report a missing closing quote, whose text ends at the next quote lines below, or text after a closing quote."""
    opening = Span(quoted.file, quoted.line, quoted.column, quoted.line, quoted.column + 1)
    lines = range(quoted.line + 1, quoted.end_line + 1)
    if any(_LINE_OF_ENTRY.match(quoted.file.line(line)) for line in lines):
        ending = Span(quoted.file, quoted.end_line, quoted.end_column - 1, quoted.end_line, quoted.end_column)
        return codes.UNCLOSED_QUOTE.at(opening, notes=[Note("the next quote of its kind is here", ending)])
    fault = codes.TEXT_AFTER_VALUE.at(failure.here, notes=[Note("the text in quotes begins here", opening)])
    return fault.with_fix(_quote_value(failure))


def _quote_value(failure: Failure) -> Fix | None:
    """Return the fix that puts a text in quotes and what follows it on its last line in quotes of the other kind."""
    last, marks = failure.last_scalar, failure.marks
    if last is None or last.style not in ("'", '"') or failure.brackets:
        return None
    begin, end = marks.scalar_ends(last)
    if marks.text[end : failure.at].strip():
        return None
    return quote_rest(marks.file, begin, after=end)


def _explain_escape(failure: Failure) -> Diagnostic:
    text = failure.marks.text
    backslash = text.rfind("\\", failure.began, failure.at + 1)
    if escape := _ESCAPE_OF_NUMBER.match(text, backslash):
        number = int(escape[0][2:], 16)
        half = ", half of a character; write the whole character" if 0xD800 <= number < 0xE000 else ""
        place = failure.marks.part(backslash, len(escape[0]))
        return codes.FORBIDDEN_CHARACTER.at(place, character=f"U+{number:04X}{half}")
    span = failure.marks.part(backslash, 2)
    return codes.UNKNOWN_ESCAPE.at(span, text=span.text).with_fix(single_quotes(failure.marks.file, failure.began))


def _explain_list_on_key_line(failure: Failure) -> Diagnostic:
    fix = list_on_next_line(failure.marks.file, failure.here)
    return codes.LIST_ON_KEY_LINE.at(failure.here).with_fix(fix)


def _explain_tag(failure: Failure) -> Diagnostic:
    """Report a tag with a broken escape, such as !caf%E9."""
    text = failure.marks.text
    start = max(text.rfind("!", 0, failure.at + 1), 0)
    tag = text[start : failure.at + 1].split("\n")[0]
    return codes.TAG.at(failure.marks.part(start, max(len(tag), 1)), tag=tag)


def _explain_missing_value(failure: Failure) -> Diagnostic:
    found = f"'{failure.character}'" if failure.character.strip() else "the end of the file"
    return codes.MISSING_VALUE.at(failure.here, found=found, notes=failure.bracket_notes())


def _explain_document_end(failure: Failure) -> Diagnostic:
    """Report a second document, or a first line without a key, which the parser reads as a whole document."""
    if strip_comment(failure.marks.file.line(failure.line_above())) == "...":
        return codes.SEVERAL_DOCUMENTS.at(failure.here)
    if failure.character in ("}", "]"):
        return codes.BRACKET_TOO_MANY.at(failure.here, bracket=failure.character)
    return _find_fault_above(failure) or codes.TEXT_AFTER_VALUE.at(failure.here)


_EXPLANATIONS: tuple[tuple[str, Callable[[Failure], Diagnostic]], ...] = (
    # libyaml has a limit of its own since 0.2.6, and reads ahead of ours.
    ("maximum nesting depth", lambda failure: codes.TOO_DEEP.at(failure.here, limit=MAX_DEPTH)),
    (r"\btab\b", _explain_tab),
    (r"cannot start any token", _explain_reserved_character),
    (r"alphabetic or numeric|comment or (a )?line break|chomping", _explain_reserved_start),
    (r"mapping keys are not allowed", lambda failure: codes.RESERVED_START.at(failure.here, character="?")),
    (r"mapping values are not allowed", _explain_colon),
    (r"could not find expected ':'", _explain_missing_colon),
    (r"sequence entries are not allowed", _explain_list_on_key_line),
    (r"expected key|expected '-' indicator|expected <block end>", _explain_line),
    (r"expected ',' or", _explain_bracket),
    (r"unexpected (end of stream|document)", lambda each: codes.UNCLOSED_QUOTE.at(each.marks.part(each.began, 1))),
    (r"URI|UTF-8 octet", _explain_tag),
    (r"escape|hexdecimal|hexadecimal", _explain_escape),
    (r"node content", _explain_missing_value),
    (r"<document start>", _explain_document_end),
)
"""Patterns of libyaml's and PyYAML's messages, and the functions that explain them; the first match wins."""
