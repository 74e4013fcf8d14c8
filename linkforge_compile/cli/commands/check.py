"""`linkforge check`: all errors and warnings of specs in one report."""

from __future__ import annotations

import time
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, NoReturn, TypeAlias

from linkforge_compile.cli import FAULTY_SPEC, OK, UsageError
from linkforge_compile.cli.options import (
    add_format_options,
    add_spec_options,
    check_settings_of,
    check_spec,
    refuse_options_of_other_formats,
    split_assignments,
)
from linkforge_compile.cli.reports import (
    add_report_options,
    add_strict_option,
    errors_of,
    format_diagnostics,
    select,
    write_to_stderr,
)
from linkforge_compile.cli.specs import FoundSpecs, SpecReport, count, find_parts, find_specs_of, is_folder
from linkforge_compile.cli.targets import add_for_option, refuse_formats_as_specs
from linkforge_compile.formats import formats_or_default

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
  linkforge check --for mjcf --strict arm.robot.yaml    the parts that MJCF cannot represent, as errors
  linkforge check --format github *.robot.yaml      as annotations of a pull request, on standard output
  linkforge check --ignore LF5003 arm.robot.yaml    without these warnings; --select LF5 reports only those
  linkforge check --watch                           again whenever a file changes, until Ctrl-C
  linkforge check --fix                             apply safe fixes, such as '$(reach)' for '${reach}'
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.usage = "linkforge check [options] [SPEC ...] [NAME:=VALUE ...]"
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
    parser.add_argument(
        "--fix", action="store_true", help="apply the safe fixes to the files, then report the remaining diagnostics"
    )
    parser.add_argument(
        "--watch", action="store_true", help="check again whenever one of the files changes, until Ctrl-C"
    )
    parser.add_argument("--diff", action="store_true", help="with --fix, print what would change, and write no file")
    add_spec_options(parser, variants_help="repeat it to check others in the same report")
    add_format_options(parser)
    add_for_option(
        parser, "report what this output format cannot represent, instead of URDF and SRDF; repeat it for others"
    )
    add_report_options(parser, is_product=True)
    add_strict_option(parser)


def run(arguments: argparse.Namespace) -> int:
    if arguments.watch:
        _watch(arguments)
    report = _check_all(arguments)
    return FAULTY_SPEC if errors_of(report.diagnostics) else OK


def _watch(arguments: argparse.Namespace) -> NoReturn:
    from linkforge_compile.cli.watching import SpecSearch, Watched, repeat_on_changes
    from linkforge_compile.editor.folders import folders_of_specs
    from linkforge_compile.file_watcher import FileWatcher

    if arguments.diagnostics != "text":
        raise UsageError(f"--watch prints text for people, not {arguments.diagnostics}")
    if arguments.fix:
        raise UsageError("takes --watch or --fix, not both: a file would change while it is edited")
    words = split_assignments(arguments.words)[0] or ["."]
    if "-" in words:
        raise UsageError("--watch takes files, not standard input")
    roots = [Path(word) for word in words if is_folder(word)]
    watcher = FileWatcher()

    def check() -> Watched:
        search = SpecSearch(
            lambda: [folder for root in roots for folder in folders_of_specs(root)],
            lambda: find_specs_of(words, arguments).specs,
        )
        began = time.time_ns()
        watcher.track(_check_all(arguments).watched, began)
        return Watched(watcher.paths or roots, lambda: tuple(dict.fromkeys((*watcher.poll(), *search.poll()))))

    repeat_on_changes("check", check, arguments)


def _check_all(arguments: argparse.Namespace) -> _Report:
    """Check all specs and print the report."""
    words, assignments = split_assignments(arguments.words)
    found = _find_specs(words, arguments)
    _refuse_options_of_each_other(arguments, found)

    def check(buffers: Mapping[str, str]) -> _Report:
        checks = {spec: _merge_runs(_check(spec, assignments, arguments, buffers)) for spec in found.specs}
        return _report_of(checks, found.faults, arguments)

    if arguments.fix:
        from linkforge_compile.cli.fixing import fix_files

        report = fix_files(check, found.specs, arguments)
    else:
        report = check({})
    _print(report, arguments)
    return report


def _find_specs(words: Sequence[str], arguments: argparse.Namespace) -> FoundSpecs:
    """Return the specs to check; UsageError for formats in place of specs, and for options of other formats."""
    refuse_formats_as_specs(words, "--for")
    requested = [one.name for one in formats_or_default(arguments.formats)]
    refuse_options_of_other_formats(arguments, requested, "--for")
    return find_specs_of(words or ["."], arguments)


def _refuse_options_of_each_other(arguments: argparse.Namespace, found: FoundSpecs) -> None:
    """Raise UsageError for options that do not go with each other, or with standard input."""
    if arguments.all_variants and arguments.variants:
        raise UsageError("takes --variant or --all-variants, not both")
    if arguments.all_variants and "-" in found.specs:
        raise UsageError("--all-variants takes files, not standard input")
    if len(arguments.variants) > 1 and "-" in found.specs:
        raise UsageError("several --variant take files, not standard input, which can be read once")
    if arguments.fix and "-" in found.specs:
        raise UsageError("--fix takes files, not standard input")
    if arguments.diff and (not arguments.fix or arguments.diagnostics != "text"):
        raise UsageError("--diff shows what --fix would change, and takes no other --format than text")


def _report_of(checks: Mapping[str, _Check], faults: Iterable[Diagnostic], arguments: argparse.Namespace) -> _Report:
    """Return the report of all specs; `faults` are those of the search for them."""
    from linkforge_compile.diagnostics.codes.schema import MISSING_NAME
    from linkforge_compile.diagnostics.reports import without_repeats

    # For a nameless file that is used as a module, the report of its user includes the missing name.
    parts = find_parts({spec: check.report for spec, check in checks.items()}, (MISSING_NAME,))
    wholes = [check for spec, check in checks.items() if spec not in parts]
    diagnostics = (*faults, *(one for check in wholes for one in check.report.diagnostics))
    watched = tuple(dict.fromkeys(file for check in checks.values() for file in (*check.report.files, *check.unread)))
    runs = tuple(select(run, arguments) for check in wholes for run in check.runs)
    return _Report(tuple(wholes), select(without_repeats(diagnostics), arguments), runs, watched)


def _check(
    spec: str, assignments: list[str], arguments: argparse.Namespace, buffers: Mapping[str, str]
) -> _Compilations:
    """Return the results by variant, where None means the defaults."""
    if not arguments.all_variants:
        variants = arguments.variants or [None]
        return {variant: check_spec(spec, assignments, arguments, variant, buffers) for variant in variants}
    from linkforge_compile.pipeline import check_each_variant

    return check_each_variant(Path(spec), check_settings_of(assignments, arguments)._replace(buffers=buffers))


def _print(report: _Report, arguments: argparse.Namespace) -> None:
    """Print text for people on standard error, forms for programs on standard output, and a summary."""
    from linkforge_compile.diagnostics.render_text import summary

    text = format_diagnostics(report.diagnostics, arguments, report.runs)
    if arguments.diagnostics == "text":
        write_to_stderr(text)
    else:
        from linkforge_compile.cli.output import write_to_stdout

        write_to_stdout(text)
    if not arguments.quiet:
        variants = _variants_summary(report.wholes) if arguments.all_variants else ""
        specs = count(len(report.wholes), "spec")
        write_to_stderr(f"checked {specs}{variants}: {summary(report.diagnostics)}\n")


class _Check(NamedTuple):
    """The report of a spec, and those of its variants, how many were checked and how many not, the files it lacked."""

    report: SpecReport
    runs: tuple[tuple[Diagnostic, ...], ...]
    variants: int
    unchecked: int
    unread: tuple[Path, ...]


class _Report(NamedTuple):
    """The checks of the specs that are no parts of others, the diagnostics to show, and all files read or sought.

    `runs` are the diagnostics of each spec and variant by themselves.
    """

    wholes: tuple[_Check, ...]
    diagnostics: tuple[Diagnostic, ...]
    runs: tuple[tuple[Diagnostic, ...], ...]
    watched: tuple[Path, ...]


def _merge_runs(compilations: _Compilations) -> _Check:
    """Return the report of a spec, with the diagnostics of all its variants merged."""
    from linkforge_compile.diagnostics.reports import merge_reports

    checked = {variant: one for variant, one in compilations.items() if one is not None}
    runs = {
        "the defaults" if variant is None else f"variant '{variant}'": one.diagnostics
        for variant, one in checked.items()
    }
    files = [file for one in checked.values() for file in one.files]
    unread = tuple(file for one in checked.values() for file in one.unread)
    report = SpecReport(merge_reports(runs), files)
    return _Check(report, tuple(runs.values()), len(checked) - 1, len(compilations) - len(checked), unread)


def _variants_summary(checks: Iterable[_Check]) -> str:
    """Return how many variants of the specs were checked, and how many were not, for the summary."""
    checks = tuple(checks)
    words = f" with the defaults and {count(sum(check.variants for check in checks), 'variant')}"
    unchecked = sum(check.unchecked for check in checks)
    return f"{words}, but not with {unchecked:,} more" if unchecked else words
