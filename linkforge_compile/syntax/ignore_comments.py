"""Write the comment that suppresses a warning or note."""

from __future__ import annotations

from linkforge_compile.diagnostics import Diagnostic, Severity
from linkforge_compile.diagnostics.fix import Edit, Fix
from linkforge_compile.source import Span
from linkforge_compile.syntax.parser import Marks, find_scalars, suppressions_in

_OF_COMMENTS = "LF12"
"""How the codes about such comments begin, which no comment suppresses."""


def ignore_fix(diagnostic: Diagnostic) -> Fix | None:
    """Return the fix that suppresses a diagnostic by comments on its lines or above them.

    None for an error, and for a line that can have no comment, such as one in a URDF or in a text of several lines.
    """
    code = diagnostic.code
    spans = [one.span for one in diagnostic.members or (diagnostic,)]
    if code.severity is Severity.ERROR or code.ends_report or code.id.startswith(_OF_COMMENTS):
        return None
    by_line = {(span.file.name, span.line): span for span in spans if span}
    edits = [edit for span in by_line.values() if (edit := _comment_on(span, code.id))]
    return Fix(f"ignore {code.id} here", tuple(edits)) if len(edits) == len(by_line) > 0 and None not in spans else None


def _comment_on(span: Span, code: str) -> Edit | None:
    """Return the edit that suppresses a code on a line; None if it cannot have a comment."""
    file, line = span.file, span.line
    scalars = None if file.is_xml else find_scalars(Marks(file))
    if scalars is None:
        return None
    for comment in suppressions_in(file):
        if comment.line == line and comment.is_understood:
            end = (comment.codes[-1][1] if comment.codes else comment.span).end
            return Edit(Span(file, *end, *end), f", {code}" if comment.codes else f" {code}")
    if any(text.line < line <= text.end_line for text in scalars):
        return None
    written = file.line(line)
    indentation = written[: len(written) - len(written.lstrip(" "))]
    return Edit(Span(file, line, 1, line, 1), f"{indentation}# linkforge: ignore {code}{file.newline}")
