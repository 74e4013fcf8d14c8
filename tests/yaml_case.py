"""Tests of specs with their expected diagnostics at the end of the line, compared as sets.

    child: fore_arm   # E[LF4102]:12 no link named 'fore_arm'; did you mean 'forearm'?

is the severity (E, W or N), the code, the column and the whole message; ` ## ` parts several. An expectation on
a line of its own begins with one `^` for each line that it points up.
"""

import re
from collections.abc import Iterator
from pathlib import Path
from textwrap import dedent
from typing import NamedTuple

from linkforge_compile import Compilation, Import, Severity, compile_file, compile_text

SEVERITIES = {"E": Severity.ERROR, "W": Severity.WARNING, "N": Severity.NOTE}
EXPECTATION = re.compile(r"(?P<up>\^*)(?P<severity>[EWN])\[(?P<code>LF\d{4})\]:(?P<column>\d+) (?P<message>.+)")


class Finding(NamedTuple):
    """A diagnostic as a person would write it down."""

    file: str
    line: int
    column: int
    severity: Severity
    code: str
    message: str


def expected(file: str, text: str) -> Iterator[Finding]:
    for number, line in enumerate(text.splitlines(), start=1):
        _, marker, comment = line.partition("# ")
        while marker and not EXPECTATION.match(comment):
            _, marker, comment = comment.partition("# ")
        for part in comment.split(" ## ") if marker else ():
            match = EXPECTATION.fullmatch(part.strip())
            assert match, f"{file}:{number}: no expectation: {part}"
            yield Finding(
                file,
                number - len(match["up"]),
                int(match["column"]),
                SEVERITIES[match["severity"]],
                match["code"],
                match["message"],
            )


def findings_of(compilation: Compilation | Import) -> set[Finding]:
    assert all(diagnostic.span for diagnostic in compilation.diagnostics), "a spec's fault without a place"
    return {
        Finding(
            Path(diagnostic.span.file.name).name,
            diagnostic.span.line,
            diagnostic.span.column,
            diagnostic.severity,
            diagnostic.code.id,
            diagnostic.message,
        )
        for diagnostic in compilation.diagnostics
        if diagnostic.span
    }


def check_case(path: Path) -> None:
    """Compile a spec file; compare its diagnostics with those expected in it and in its modules."""
    compilation = compile_file(path, parameters=[])  # as the command line does, which the cases speak of
    files = {path, *compilation.files}
    wanted = {one for file in files for one in expected(file.name, file.read_text("utf-8", errors="replace"))}
    assert findings_of(compilation) == wanted


def compile_yaml(text: str, **options: object) -> Compilation:
    """Compile a spec in a test, compare its diagnostics with the expected ones, and return the compilation."""
    text = dedent(text).lstrip("\n")
    compilation = compile_text(text, name="test.robot.yaml", **options)  # type: ignore[arg-type]  # passed on as they are
    assert findings_of(compilation) == set(expected("test.robot.yaml", text))
    return compilation
