"""`linkforge format`: changes the white space of specs to one style, and nothing else."""

from __future__ import annotations

import argparse
from collections.abc import Collection, Iterable, Iterator, Mapping
from pathlib import Path

from linkforge_compile.cli import FAULTY_SPEC, OK, UsageError
from linkforge_compile.cli.options import STDIN, add_outside_option, read_stdin
from linkforge_compile.cli.output import unified, write_changed, write_to_stdout
from linkforge_compile.cli.reports import add_report_options, print_failure, print_status, report
from linkforge_compile.cli.specs import count, find_specs_of
from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.roots import exists, is_file
from linkforge_compile.source import SourceFile

_EXAMPLES = """\
The format has two spaces per level, lists indented below their key, {a: 1, b: 2} and [1, 2], two or more spaces before
a comment, and at most one blank line. Lines, keys, quotes and numbers do not change, and aligned columns remain
aligned.

examples:
  linkforge format                                  every spec below, except in hidden folders, build, install and log
  linkforge format robots/ parts/leg.yaml
  linkforge format --check                          in CI: exit code 1 if a spec would change
  linkforge format --diff arm.robot.yaml            show what would change
  linkforge format - < arm.robot.yaml               as editors call it: standard input to standard output
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = _EXAMPLES
    parser.add_argument(
        "words",
        metavar="SPEC",
        nargs="*",
        help="specs, other YAML files, or folders (default: .); - for standard input, to standard output",
    )
    parser.add_argument("--check", action="store_true", help="write nothing; fail if a file would change")
    parser.add_argument("--diff", action="store_true", help="print what would change, and write no file")
    add_outside_option(parser)
    add_report_options(parser)
    parser.set_defaults(packages=[])


def run(arguments: argparse.Namespace) -> int:
    from linkforge_compile.diagnostics import Diagnostics

    found = find_specs_of(arguments.words or ["."], arguments)
    if "-" in found.specs and len(found.specs) > 1:
        raise UsageError("takes - alone, for standard input, or files and folders")
    sink = Diagnostics()
    sink.report_all(found.faults)
    formatted = dict(_format(found.specs, sink))
    changed = {source: text for source, text in formatted.items() if text != source.text}
    has_errors = report(sink.sorted(), arguments)
    if arguments.diff:
        write_to_stdout("".join(unified(one.shown, one.text, text, "formatted") for one, text in changed.items()))
    elif not arguments.check:
        _write(formatted)
    _print_status(formatted, changed, len(found.specs) - len(formatted), arguments)
    return FAULTY_SPEC if has_errors or (arguments.check and changed) else OK


def _format(specs: Iterable[str], sink: Diagnostics) -> Iterator[tuple[SourceFile, str]]:
    """Yield the files that can be read, each with its formatted text."""
    from linkforge_compile.formatter import format_source

    for spec in specs:
        source = _read(spec, sink)
        formatted = format_source(source, sink) if source else None
        if source and formatted is not None:
            yield source, formatted


def _read(spec: str, sink: Diagnostics) -> SourceFile | None:
    """Read a file in YAML; None after a reported error, UsageError for another kind of file."""
    from linkforge_compile.load import Loader
    from linkforge_compile.source import SourceFile

    if spec == "-":
        source: SourceFile | None = SourceFile(STDIN, read_stdin())
    elif exists(path := Path(spec)) and not is_file(path):
        raise UsageError(f"takes files and folders, found '{spec}'; use - for standard input")
    else:
        source = Loader().open_text(path, sink)
    if source and source.is_xml:
        raise UsageError(f"takes specs in YAML, and '{source.shown}' is XML")
    return source


def _write(formatted: Mapping[SourceFile, str]) -> None:
    """Write the files that change, and what comes from standard input to standard output."""
    files = {source.path: text for source, text in formatted.items() if source.path}
    write_changed(files, next((text for source, text in formatted.items() if source.path is None), None))


def _print_status(
    formatted: Collection[SourceFile], changed: Collection[SourceFile], faulty: int, arguments: argparse.Namespace
) -> None:
    """Print which files change, and how many do not; what fails `--check` is printed with `--quiet` too.

    `faulty` is how many files have errors that keep them from being formatted.
    """
    writes = not (arguments.check or arguments.diff)
    for source in changed:
        if arguments.check:
            print_failure(f"would format {source.shown}", arguments)
        elif writes and source.path:
            print_status(f"formatted {source.shown}", arguments)
    if any(source.path for source in formatted):
        unchanged = len(formatted) - len(changed)
        done = f"{count(len(changed), 'file')} {'formatted' if writes else 'would change'}, {unchanged}"
        errors = f", {faulty} with errors" if faulty else ""
        print_status(f"{done if changed else count(unchanged, 'file')} unchanged{errors}", arguments)
