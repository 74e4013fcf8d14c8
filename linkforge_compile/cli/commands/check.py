"""`linkforge check`: all errors and warnings of specs in one report."""

from __future__ import annotations

import os
from collections.abc import Callable, Collection, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from linkforge_compile.cli import FAULTY_SPEC, OK, UsageError
from linkforge_compile.cli.options import (
    add_spec_options,
    check_settings_of,
    check_spec,
    packages_of,
    split_assignments,
)
from linkforge_compile.cli.reports import add_report_options, errors_of, format_diagnostics, select, write_to_stderr

if TYPE_CHECKING:
    import argparse

    from linkforge_compile.diagnostics import Diagnostic
    from linkforge_compile.pipeline import Compilation

    _Compilations: TypeAlias = Mapping[str | None, Compilation | None]

_EXAMPLES = """\
A required parameter without a value is not an error here; values that depend on it are not checked.

examples:
  linkforge check robots/*.robot.yaml
  linkforge check                                   every spec below, except in hidden folders, build, install and log
  linkforge check arm.robot.yaml hardware:=mock
  linkforge check --all-variants arm.robot.yaml     with the defaults and with each of its variants
  linkforge check --format github *.robot.yaml      as annotations of a pull request, on standard output
  linkforge check --ignore LF5003 arm.robot.yaml    without these warnings; --select LF5 reports only those
"""


_MAX_SPECS = 5_000
"""The most specs in one folder; more are hardly the sources of robots."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = _EXAMPLES
    parser.add_argument(
        "words",
        metavar="SPEC",
        nargs="*",
        help="specs, NAME.robot.yaml, or folders (default: .); - for standard input",
    )
    parser.add_argument(
        "--all-variants", action="store_true", help="check the defaults and every variant of each spec, in one report"
    )
    add_spec_options(parser)
    add_report_options(parser, is_product=True)


def run(arguments: argparse.Namespace) -> int:
    from linkforge_compile.diagnostics.codes.modules import NO_SPEC_BELOW
    from linkforge_compile.diagnostics.render_text import summary

    words, assignments = split_assignments(arguments.words)
    unread: list[Diagnostic] = []
    specs_by_word = {word: _find_specs(word, arguments, unread.append) for word in words or ["."]}
    specs = list(dict.fromkeys(spec for some in specs_by_word.values() for spec in some))
    if arguments.all_variants and arguments.variant is not None:
        raise UsageError("takes --variant or --all-variants, not both")
    if arguments.all_variants and "-" in specs:
        raise UsageError("--all-variants takes files, not standard input")
    # Specs that use the same module repeat its diagnostics: report and count each once.
    found = {str(one): one for one in unread}
    if not unread:
        empty = (NO_SPEC_BELOW.at(None, path=word) for word, below in specs_by_word.items() if not below)
        found = {str(one): one for one in empty}
    reports = _without_parts({spec: _merge_runs(_check(spec, assignments, arguments)) for spec in specs})
    for report in reports.values():
        for diagnostic in report.diagnostics:
            found.setdefault(str(diagnostic), diagnostic)
    chosen = select(found.values(), arguments)
    _print(chosen, arguments)
    if not arguments.quiet:
        variants = _variants_summary(reports.values()) if arguments.all_variants else ""
        write_to_stderr(f"checked {_count(len(reports), 'spec')}{variants}: {summary(chosen)}\n")
    return FAULTY_SPEC if errors_of(chosen) else OK


def _find_specs(word: str, arguments: argparse.Namespace, report: Callable[[Diagnostic], object]) -> tuple[str, ...]:
    """Return the specs that a word of the command line names: itself, or every spec below a folder.

    Folders that cannot be read, in which specs may be, are reported, and links that may not be followed.
    """
    # Path.is_dir raises for a name that is too long.
    if not os.path.isdir(word):  # noqa: PTH112
        return (word,)
    from linkforge_compile.diagnostics import Note
    from linkforge_compile.diagnostics.codes.modules import OUTSIDE_ROOTS, UNREADABLE_FILE
    from linkforge_compile.editor.folders import TooManyFilesError, find_specs
    from linkforge_compile.roots import ANYWHERE, Roots

    folder = Path(word)
    roots = ANYWHERE if arguments.allow_outside else Roots.around(folder, map(Path, packages_of(arguments).values()))

    def unread(error: OSError) -> None:
        report(UNREADABLE_FILE.at(None, path=error.filename, reason=(error.strerror or "").lower()))

    def outside(link: Path) -> None:
        report(OUTSIDE_ROOTS.at(None, path=link, name="NAME", notes=map(Note, roots.reasons(link))))

    try:
        return tuple(map(str, find_specs(folder, _MAX_SPECS, roots=roots, unread=unread, outside=outside)))
    except TooManyFilesError as error:
        raise UsageError(f"there are {error} below '{word}'; name the folders of the robots") from error


def _check(spec: str, assignments: list[str], arguments: argparse.Namespace) -> _Compilations:
    """Return the results by variant, where None means the defaults."""
    if not arguments.all_variants:
        return {arguments.variant: check_spec(spec, assignments, arguments)}
    from linkforge_compile.pipeline import check_each_variant

    return check_each_variant(Path(spec), check_settings_of(assignments, arguments))


def _print(diagnostics: tuple[Diagnostic, ...], arguments: argparse.Namespace) -> None:
    """Print text for people on standard error, and forms for programs on standard output."""
    text = format_diagnostics(diagnostics, arguments)
    if arguments.diagnostics == "text":
        write_to_stderr(text)
    else:
        from linkforge_compile.cli.output import write_to_stdout

        write_to_stdout(text)


class _Report(NamedTuple):
    """The diagnostics of a spec, the numbers of its variants, and the real paths of its files."""

    diagnostics: tuple[Diagnostic, ...]
    variants: int
    unchecked: int
    files: frozenset[str]


def _merge_runs(compilations: _Compilations) -> _Report:
    """Return the report of a spec, with the diagnostics of all its variants merged."""
    from linkforge_compile.diagnostics.reports import merge_reports

    checked = {variant: one for variant, one in compilations.items() if one is not None}
    runs = {
        "the defaults" if variant is None else f"variant '{variant}'": one.diagnostics
        for variant, one in checked.items()
    }
    files = frozenset(os.path.realpath(file) for one in checked.values() for file in one.files)
    return _Report(merge_reports(runs), len(checked) - 1, len(compilations) - len(checked), files)


def _variants_summary(reports: Collection[_Report]) -> str:
    """Return how many variants of the specs were checked, and how many were not, for the summary."""
    words = f" with the defaults and {_count(sum(report.variants for report in reports), 'variant')}"
    unchecked = sum(report.unchecked for report in reports)
    return f"{words}, but not with {unchecked:,} more" if unchecked else words


def _without_parts(reports: Mapping[str, _Report]) -> dict[str, _Report]:
    """Leave out files without a name that are parts of a checked spec, whose report has their diagnostics.

    For a nameless file that is used as a module, that report includes the missing name.
    """
    from linkforge_compile.diagnostics.codes.schema import MISSING_NAME

    def lacks_name(spec: str, report: _Report) -> bool:
        spans = (one.span for one in report.diagnostics if one.code is MISSING_NAME)
        return any(span is not None and span.file.path == Path(spec) for span in spans)

    nameless = {spec for spec, report in reports.items() if lacks_name(spec, report)}
    checked = {file for spec, report in reports.items() if spec not in nameless for file in report.files}
    parts = {spec for spec in nameless if os.path.realpath(spec) in checked}
    return {spec: report for spec, report in reports.items() if spec not in parts}


def _count(count: int, noun: str) -> str:
    return f"{count or 'no'} {noun}{'' if count == 1 else 's'}"
