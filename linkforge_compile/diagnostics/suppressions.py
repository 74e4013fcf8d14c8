"""Comments of a spec that ask not to be told something: what they take away, and what is wrong with them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple

from linkforge_compile.diagnostics.codes import REGISTER
from linkforge_compile.diagnostics.codes.syntax import (
    IGNORE_MISWRITTEN,
    IGNORE_OF_ERROR,
    IGNORE_OF_UNKNOWN_CODE,
    IGNORE_WITHOUT_CODE,
    NOTHING_TO_IGNORE,
)
from linkforge_compile.diagnostics.diagnostic import Diagnostic, Severity
from linkforge_compile.diagnostics.sink import Diagnostics
from linkforge_compile.source import Span


class Suppression(NamedTuple):
    """One comment: on `line` of its file the codes are not to be told; each is with where it is written.

    One that is not understood ignores nothing.
    """

    span: Span
    line: int
    codes: tuple[tuple[str, Span], ...]
    is_understood: bool = True


def apply_suppressions(
    diagnostics: tuple[Diagnostic, ...], suppressions: tuple[Suppression, ...], *, is_whole: bool
) -> tuple[Diagnostic, ...]:
    """Return a report in reading order without what is ignored, and with what is wrong with the comments.

    Errors stay. `is_whole` says that nothing kept a stage from looking: only then is it known what is not told.
    """
    # By the file's name, as one that is included twice is two files with the same comments.
    asked = {
        (ignore.span.file.name, ignore.line, code)
        for ignore in suppressions
        if ignore.is_understood
        for code, _ in ignore.codes
    }
    ignored = {_key(one) for one in diagnostics if one.severity is not Severity.ERROR} & asked
    kept = [one for one in diagnostics if one.severity is Severity.ERROR or _key(one) not in ignored]
    # A file may be all comments: no more is told of them than of anything else.
    faults, told = Diagnostics(), set()
    for fault in (fault for ignore in suppressions for fault in _faults(ignore, ignored, is_whole)):
        if (line := hash(str(fault))) not in told:
            told.add(line)
            faults.report(fault)
    return tuple(sorted((*kept, *faults.sorted()), key=lambda one: one.order))


def _key(diagnostic: Diagnostic) -> tuple[str, int, str]:
    span = diagnostic.span
    return (span.file.name, span.line, diagnostic.code.id) if span else ("", 0, diagnostic.code.id)


def _faults(ignore: Suppression, ignored: Iterable[tuple[str, int, str]], is_whole: bool) -> Iterator[Diagnostic]:
    if not ignore.is_understood:
        codes = ", ".join(dict.fromkeys(code.upper() for code, _ in ignore.codes)) or "and codes such as LF6003"
        yield IGNORE_MISWRITTEN.at(ignore.span, codes=codes)
        return
    if not ignore.codes:
        yield IGNORE_WITHOUT_CODE.at(ignore.span)
    for code, span in ignore.codes:
        if code not in REGISTER:
            family = next(
                (one for one in sorted(REGISTER) if one.startswith(code.upper()) and len(one) > len(code)), None
            )
            hint = f"; write each in full, such as {family}" if family else ""
            yield IGNORE_OF_UNKNOWN_CODE.at(span, name=code, hint=hint, near=() if hint else REGISTER)
        elif REGISTER[code].severity is Severity.ERROR:
            yield IGNORE_OF_ERROR.at(span, code=code)
        elif is_whole and (span.file.name, ignore.line, code) not in ignored:
            yield NOTHING_TO_IGNORE.at(span, code=code, line=ignore.line)
