"""Fixes of a text that is not YAML as the language reads it."""

from __future__ import annotations

import re
from collections.abc import Iterable

from linkforge_compile.diagnostics import Diagnostic
from linkforge_compile.diagnostics.codes import syntax as codes
from linkforge_compile.diagnostics.fix import Edit, Fix
from linkforge_compile.source import SourceFile, Span

_INDENTATION = re.compile(r"[ \t]*\t[ \t]*(?=\S)")
_TABS = re.compile(r"\t+")
_LIKE_SPACES = re.compile(r"(?:[ \t]*[\u00a0\u2000-\u200b\u202f\u3000])+[ \t]*")

_STEP, _TAB_STOP = 2, 4
"""Spaces of a level of indentation, and columns between tab stops where tabs are mixed with spaces."""

_IN_EXPRESSION = re.compile(r"'[^'\r\n]*'|\"[^\"\r\n]*\"|\$\(|[][(){}]")
_LONGEST_EXPRESSION = 2_000
_REST_OF_ITEM = re.compile(r"([^\s,\[\]{}#]*)[ \t]*(?=[,\]}\r\n]|$)")

_REST = re.compile(r"(?:(?!\s#)[^\r\n])*")
_REST_IN_FLOW = re.compile(r"(?:(?!\s#)[^\r\n,\[\]{}])*")
_DOUBLE_QUOTED = re.compile(r'"((?:[^"\\\r\n]|\\[^\r\n])*)"')
_CONFLICT = re.compile(
    r"<{7} [^\n]*\n(?P<first>(?:(?![|=>]{7})[^\n]*\n)*)(?:\|{7}[^\n]*\n(?:(?!={7})[^\n]*\n)*)?={7}\r?\n"
    r"(?P<second>(?:(?!>{7} )[^\n]*\n)*)>{7} [^\n]*\n?"
)
_ESCAPES = re.compile(r"\\[0abt\tnvfre\"/\\N_LPxuU]")


def space_after_colon(span: Span, text: str) -> Diagnostic:
    """Return the error for a key and its value without a space between them, such as `mass:3`."""
    return codes.SPACE_AFTER_COLON.at(span, text=text, ours=text.replace(":", ": ", 1))


def space_after_dash(span: Span, text: str) -> Diagnostic:
    """Return the error for a dash and its item without a space between them, such as `-base`."""
    return codes.SPACE_AFTER_DASH.at(span, text=text, ours=text.replace("-", "- ", 1))


def indent_with_spaces(file: SourceFile) -> Fix | None:
    """Return the fix that writes spaces for the tabs that indent lines; safe if nothing else indents any line."""
    matches = ((line, _INDENTATION.match(text)) for line, text in enumerate(file.lines, start=1))
    indentations = [(line, found[0]) for line, found in matches if found]
    is_pure = all(_TABS.fullmatch(found) for _, found in indentations) and not any(
        line.startswith(" ") and line.strip() for line in file.lines
    )
    edits = [
        Edit(Span(file, line, 1, line, len(found) + 1), _spaces(found, is_pure=is_pure)) for line, found in indentations
    ]
    return Fix("indent with spaces", tuple(edits), is_safe=is_pure) if edits else None


def _spaces(indentation: str, *, is_pure: bool) -> str:
    return " " * (_STEP * len(indentation) if is_pure else len(indentation.expandtabs(_TAB_STOP)))


def replace_like_spaces(file: SourceFile, lines: Iterable[int] | None = None) -> Fix | None:
    """Return the fix that writes spaces for what looks like spaces in the indentation of some lines; None for all."""
    lines = range(1, len(file.lines) + 1) if lines is None else lines
    edits = [
        Edit(Span(file, line, 1, line, found.end() + 1), " " * found.end())
        for line in lines
        if (found := _LIKE_SPACES.match(file.line(line))) and "\t" not in found[0]
    ]
    return Fix("indent with spaces", tuple(edits), is_safe=True) if edits else None


def indent_line(span: Span, spaces: int) -> Fix:
    """Return the fix that begins a line with spaces; `span` begins with its first other character."""
    place = Span(span.file, span.line, 1, span.line, span.column)
    return Fix("indent this line further", (Edit(place, " " * spaces),), is_safe=True)


def closing_index(text: str, start: int) -> int | None:
    """Return the index after the `)` of the `$(` before `start`; None if there is none in what may be an expression."""
    closing = [")"]
    for token in _IN_EXPRESSION.finditer(text, start, start + _LONGEST_EXPRESSION):
        if token[0] in ("(", "["):
            closing.append(")" if token[0] == "(" else "]")
        elif token[0][0] not in "'\"" and token[0] != closing.pop():
            return None
        if not closing:
            return token.end()
    return None


def put_in_quotes(file: SourceFile, begin: int, closing: int) -> Fix | None:
    """Return the fix for the item of a flow list or map that begins at an index and whose expression ends at another.

    None if more text than a word follows, or if both kinds of quotes are in it.
    """
    rest = _REST_OF_ITEM.match(file.counted, closing)
    written = file.counted[begin : rest.end(1)] if rest else ""
    quote = next((quote for quote in ('"', "'") if quote not in written and "\\" not in written), None)
    if not rest or quote is None:
        return None
    new = f"{quote}{written}{quote}"
    return Fix(f"write '{new}'", (Edit(file.between(begin, rest.end(1)), new),), is_safe=True)


def quote_rest(file: SourceFile, begin: int, *, is_flow: bool = False, after: int | None = None) -> Fix | None:
    """Return the fix that puts text from an index to the end of its value in quotes; None if it has both kinds.

    It ends on the line of the index `after`, by default on that of its begin.
    """
    end = _end_of_rest(file, begin if after is None else after, is_flow=is_flow)
    written = file.counted[begin:end]
    if not written:
        return None
    quote = next((quote for quote in ("'", '"') if quote not in written), None)
    if quote is None or (quote == '"' and "\\" in written):
        return None
    edits = (Edit(file.between(begin, begin), quote), Edit(file.between(end, end), quote))
    return Fix("put it in quotes", edits)


def brace_rest(file: SourceFile, begin: int) -> Fix | None:
    """Return the fix that puts what follows an index on its line in braces; None if lines below belong to it."""
    end = _end_of_rest(file, begin, is_flow=False)
    place = file.between(begin, end)
    below, indentation = file.line(place.line + 1), len(file.line(place.line)) - len(file.line(place.line).lstrip())
    if begin == end or file.counted[end - 1] == ":" or below[: indentation + 1].isspace():
        return None
    edits = (Edit(file.between(begin, begin), "{"), Edit(file.between(end, end), "}"))
    return Fix("put it in braces", edits)


def single_quotes(file: SourceFile, begin: int) -> Fix | None:
    """Return the fix that puts a text in double quotes in single ones; None if that changes more of it."""
    found = _DOUBLE_QUOTED.match(file.counted, begin)
    if found is None or "'" in found[1] or _ESCAPES.search(found[1]):
        return None
    return Fix(f"write '{found[1]}' in single quotes", (Edit(file.between(*found.span()), f"'{found[1]}'"),))


def sides_of_conflict(file: SourceFile, begin: int) -> tuple[Fix, ...]:
    """Return the fixes that keep one side of a merge conflict that begins at an index; () for one that is not whole."""
    found = _CONFLICT.match(file.counted, begin)
    if found is None:
        return ()
    whole = file.between(*found.span())
    return tuple(Fix(f"keep the {side} side", (Edit(whole, found[side]),)) for side in ("first", "second"))


def list_on_next_line(file: SourceFile, dash: Span) -> Fix:
    """Return the fix that begins a list below its key; its items are aligned with those that are there."""
    line, below = file.line(dash.line), file.line(dash.line + 1)
    key = len(line) - len(line.lstrip())
    depth = len(below) - len(below.lstrip())
    column = depth if below.lstrip().startswith("- ") and depth > key else key + _STEP
    before = Span(file, dash.line, len(line[: dash.column - 1].rstrip()) + 1, dash.line, dash.column)
    return Fix("begin the list on a new line", (Edit(before, f"{file.newline}{' ' * column}"),))


def _end_of_rest(file: SourceFile, begin: int, *, is_flow: bool) -> int:
    """Return the index at which the text of a value ends that begins at another one."""
    found = (_REST_IN_FLOW if is_flow else _REST).match(file.counted, begin)
    return begin + len(found[0].rstrip()) if found else begin
