"""Diagnostics as text: the line that tools parse, the source line under it, and a caret under the words at fault."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

from linkforge_compile.diagnostics.diagnostic import Diagnostic, Note, Severity
from linkforge_compile.diagnostics.terminal import BOLD, RESET, width_of
from linkforge_compile.source import Span

_COLOURS = {Severity.ERROR: "\033[1;31m", Severity.WARNING: "\033[1;33m", Severity.NOTE: "\033[1;36m"}

# A spec generated on one line, or a list of a thousand numbers, must not fill the screen.
_WIDEST_LINE = 160
_CONTEXT_BEFORE = 60

MOST_OF_ONE_NAME = 3
"""How many uses of one undeclared name the text shows; all of them may have one cause, in the declaration."""

MOST_SHOWN = 100
"""How many diagnostics the text shows; the first ones may be the cause of the others."""


def render_first(diagnostics: Sequence[Diagnostic], *, colour: bool = False) -> str:
    """Return the first diagnostics, errors before others, as `render_text` does, and how many more there are.

    Of each undeclared name only the first uses are shown. Diagnostics that end the report are always shown. Losses that
    `count_losses` marks are counted only.
    """
    losses = [one for one in diagnostics if one.is_only_counted]
    diagnostics = tuple(_shorten_floods([one for one in diagnostics if not one.is_only_counted]))
    errors = [one for one in diagnostics if one.severity is Severity.ERROR][:MOST_SHOWN]
    others = [one for one in diagnostics if one.severity is not Severity.ERROR][: MOST_SHOWN - len(errors)]
    ends = [one for one in diagnostics if one.code.ends_report]
    shown = set(map(id, (*errors, *others, *ends)))
    text = render_text((one for one in diagnostics if id(one) in shown), colour=colour)
    rest = [one for one in diagnostics if id(one) not in shown]
    text += f"… and {_counts(rest, Severity)} more\n" if rest else ""
    return (
        text + f"{_counts(losses, Severity)} about output formats not shown while there are errors\n"
        if losses
        else text
    )


def _shorten_floods(diagnostics: Sequence[Diagnostic]) -> Iterator[Diagnostic]:
    """Yield diagnostics in their order; of each undeclared name the first MOST_OF_ONE_NAME, and how many more."""
    of_a_name = defaultdict[tuple[str, str, int, str], list[Diagnostic]](list)
    for one in diagnostics:
        if one.code.is_unknown_name and one.span:
            of_a_name[one.code.id, one.message, one.full_text_hash, one.span.file.name].append(one)
    floods = [same for same in of_a_name.values() if len(same) > MOST_OF_ONE_NAME]
    left_out = {id(one) for same in floods for one in same[MOST_OF_ONE_NAME:]}
    lasts = {id(same[MOST_OF_ONE_NAME - 1]): same for same in floods}
    for one in diagnostics:
        if id(one) in lasts:
            following = lasts[id(one)][MOST_OF_ONE_NAME:]
            note = Note(f"and {len(following):,} more like this, the next one here", following[0].span)
            yield replace(one, notes=(*one.notes, note), omitted=one.omitted + len(following))
        elif id(one) not in left_out:
            yield one


def render_text(diagnostics: Iterable[Diagnostic], *, colour: bool = False) -> str:
    """Return `file:line:col: error: message [LFnnnn]` with the source under each; empty for none."""
    return "".join(f"{line}\n" for diagnostic in diagnostics for line in _lines(diagnostic, colour))


def summary(diagnostics: Iterable[Diagnostic]) -> str:
    """Return such as "2 errors, 1 warning"; "no errors" if there is neither."""
    return _counts(diagnostics, (Severity.ERROR, Severity.WARNING)) or "no errors"


def _counts(diagnostics: Iterable[Diagnostic], severities: Iterable[Severity]) -> str:
    """Return such as "2 errors, 1 warning", with those that are omitted; empty for none."""
    found = Counter[Severity]()
    for diagnostic in diagnostics:
        found[diagnostic.severity] += 1 + diagnostic.omitted
    counts = [(found[severity], severity) for severity in severities]
    return ", ".join(f"{count:,} {severity}{'s' if count > 1 else ''}" for count, severity in counts if count)


def _lines(diagnostic: Diagnostic, colour: bool) -> Iterator[str]:
    severity = diagnostic.severity
    yield _headline(diagnostic.span, severity, f"{diagnostic.message} [{diagnostic.code.id}]", colour)
    yield from snippet(diagnostic.span, _COLOURS[severity] if colour else "")
    for note in diagnostic.notes:
        yield _headline(note.span, Severity.NOTE, note.message, colour)
        if not note.is_brief:
            yield from snippet(note.span, _COLOURS[Severity.NOTE] if colour else "")


def _headline(span: Span | None, severity: Severity, message: str, colour: bool) -> str:
    place = f"{span}: " if span else ""
    if not colour:
        return f"{place}{severity}: {message}"
    return f"{BOLD}{place}{_COLOURS[severity]}{severity}:{RESET}{BOLD} {message}{RESET}"


def snippet(span: Span | None, colour: str = "") -> Iterator[str]:
    """Yield the first line of the span and a caret line in the colour, an ANSI sequence or "" for none.

    Yield nothing if the file has no such line, or if it is blank.
    """
    if span is None or not (line := span.file.line(span.line)).strip(" "):
        return
    if not line.strip():
        line = line.replace("\t", "→")
    start, end = span.column - 1, span.end_column - 1 if span.end_line == span.line else len(line)
    if len(line) > _WIDEST_LINE:
        cut = max(0, start - _CONTEXT_BEFORE)
        line = ("…" if cut else "") + line[cut : cut + _WIDEST_LINE] + "…"
        start, end = (place - cut + bool(cut) for place in (start, end))
    number = str(span.line)
    marked = line[start : min(end, len(line))]
    caret = "^" * max(1, width_of(marked))
    yield f" {number:>5} | {_visible(line)}"
    yield f" {'':>5} | {_padding(line[:start])}{colour}{caret}{RESET if colour else ''}"


def _padding(text: str) -> str:
    """Return white space as wide as `text`; tabs stay tabs, and a wide character gives two spaces."""
    return "".join("\t" if char == "\t" else " " * width_of(char) for char in text)


def _visible(line: str) -> str:
    """Return the line with control characters shown as a mark, so that a spec cannot drive the terminal."""
    return "".join(char if char == "\t" or char.isprintable() else "\N{REPLACEMENT CHARACTER}" for char in line)
