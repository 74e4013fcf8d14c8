"""Prints diagnostics and status lines as the options of a command choose, and the manual pages of codes."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from time import monotonic
from typing import TYPE_CHECKING, TextIO, TypeVar

from linkforge_compile.cli import UsageError
from linkforge_compile.diagnostics import Code, Diagnostic, Severity
from linkforge_compile.diagnostics.codes import OUTPUT_CODES
from linkforge_compile.diagnostics.terminal import BOLD, CYAN, RESET
from linkforge_compile.source.characters import on_one_line

if TYPE_CHECKING:
    import argparse

    from linkforge_compile.diagnostics.reports import Selection
    from linkforge_compile.source import Span

PATIENCE = 2.0
"""Time until `progress_after` prints its message [s]."""

PROGRESS_INTERVAL = 2.0
"""Time between two messages of `progress` [s]."""

ANY_CODE = "LF"
"""How all codes begin."""

_Item = TypeVar("_Item")


def add_report_options(parser: argparse.ArgumentParser, *, is_product: bool = False) -> None:
    """Add the options about diagnostics, with `--format` as another name if they are all that the command prints."""
    group = parser.add_argument_group("diagnostics")
    group.add_argument(
        "--diagnostics",
        *(["--format"] if is_product else []),
        choices=("text", "json", "github", "sarif"),
        default="text",
        help="the format of diagnostics: text (default), json, github (annotations) or sarif",
    )
    group.add_argument(
        "--select",
        metavar="CODES",
        type=_parse_codes,
        action="extend",
        default=[],
        help="only these warnings and notes",
    )
    group.add_argument(
        "--ignore",
        metavar="CODES",
        type=_parse_ignorable_codes,
        action="extend",
        default=[],
        help="do not report these warnings and notes; codes or prefixes of codes, such as LF5,LF6003",
    )
    _add_raising_option(group, "--werror", ANY_CODE, "report warnings as errors")
    group.add_argument("-q", "--quiet", action="store_true", help="print errors only")
    group.add_argument(
        "--color",
        choices=("auto", "always", "never"),
        default="auto",
        help="whether to color text (default: on a terminal)",
    )


def add_strict_option(parser: argparse.ArgumentParser) -> None:
    """Add `--strict`, for commands with `add_report_options` that are about outputs."""
    about = "fail, and write nothing, if an output cannot represent a part of the robot: treat warnings LF7 as errors"
    _add_raising_option(parser, "--strict", OUTPUT_CODES, about)


def _add_raising_option(group: argparse._ActionsContainer, option: str, codes: str, about: str) -> None:
    """Add an option that makes errors of warnings whose codes begin so."""
    group.add_argument(option, dest="errors", action="append_const", const=codes, default=[], help=about)


def select(diagnostics: Iterable[Diagnostic], arguments: argparse.Namespace) -> tuple[Diagnostic, ...]:
    """Return the diagnostics that the options select, with the severities that the options set."""
    diagnostics = tuple(diagnostics)
    if not diagnostics:
        return ()
    return selection_of(arguments).of(diagnostics)


def selection_of(arguments: argparse.Namespace) -> Selection:
    """Return which diagnostics the options select."""
    from linkforge_compile.diagnostics.reports import Selection

    return Selection(tuple(arguments.select), tuple(arguments.ignore), tuple(arguments.errors), arguments.quiet)


def report(diagnostics: Iterable[Diagnostic], arguments: argparse.Namespace) -> bool:
    """Print the diagnostics that the options select, and return whether there is an error among them."""
    chosen = select(diagnostics, arguments)
    write_to_stderr(format_diagnostics(chosen, arguments, [chosen]))
    return bool(errors_of(chosen))


def errors_of(diagnostics: Iterable[Diagnostic]) -> list[Diagnostic]:
    return [diagnostic for diagnostic in diagnostics if diagnostic.severity is Severity.ERROR]


def print_status(line: str, arguments: argparse.Namespace) -> None:
    """Print a line of status, unless with `--quiet` or if standard error is one document for a program."""
    if not arguments.quiet:
        print_failure(line, arguments)


def print_failure(line: str, arguments: argparse.Namespace) -> None:
    """Print a line about a failure, unless standard error is one document for a program."""
    if getattr(arguments, "diagnostics", "text") in {"text", "github"}:
        print_line(line)


def print_line(line: str) -> None:
    """Print one line on standard error, with control characters in names of files escaped."""
    write_to_stderr(f"{on_one_line(line)}\n")


def write_to_stderr(text: str) -> None:
    """Write to standard error, unless it is closed or its reader is gone, which changes no exit code."""
    if sys.stderr is None:
        return
    try:
        sys.stderr.write(text)
        sys.stderr.flush()
    except BrokenPipeError:
        # Redirected, so that the final flush does not meet the closed pipe.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stderr.fileno())


def format_diagnostics(
    diagnostics: tuple[Diagnostic, ...], arguments: argparse.Namespace, runs: Iterable[Collection[Diagnostic]]
) -> str:
    """Return the diagnostics as text, in the form that the options choose; `runs` are those of `count_losses`."""
    # GitHub resolves paths in annotations from the top of the checkout, wherever the build runs.
    root = Path(os.environ.get("GITHUB_WORKSPACE") or Path.cwd()).absolute()
    match arguments.diagnostics:
        case "json":
            from linkforge_compile.diagnostics.render_forms import render_json

            return render_json(diagnostics)
        case "github":
            from linkforge_compile.diagnostics.render_forms import render_github

            return render_github(diagnostics, root=root)
        case "sarif":
            from linkforge_compile._version import __version__
            from linkforge_compile.diagnostics.render_forms import render_sarif
            from linkforge_compile.resources import manual_folder

            return render_sarif(
                diagnostics,
                root=root,
                version=__version__,
                manual=lambda code: manual_page(code.id, styled=False),
                pages=manual_folder(),
            )
    return _format_text(diagnostics, runs, arguments.color)


def _format_text(diagnostics: tuple[Diagnostic, ...], runs: Iterable[Collection[Diagnostic]], color: str) -> str:
    if not diagnostics:
        return ""
    from linkforge_compile.diagnostics.render_text import render_first
    from linkforge_compile.diagnostics.reports import count_losses

    text = render_first(count_losses(diagnostics, runs), colour=is_colored(sys.stderr, color))
    if sys.stderr is None or not sys.stderr.isatty():
        return text
    worst = next((one for one in diagnostics if one.severity is Severity.ERROR), diagnostics[0])
    return f"{text}{worst.code.help} for more\n"


def is_colored(stream: TextIO | None, when: str = "auto") -> bool:
    """Whether to color output to a stream, None if it is closed.

    In order of precedence: `--color` (`when`), NO_COLOR (no-color.org), FORCE_COLOR and CLICOLOR_FORCE, which builds
    set if their log shows colors, and whether the stream is a terminal. An empty variable, or a forcing one that is
    `0`, counts as unset.
    """
    if when != "auto":
        return when == "always"
    if os.environ.get("NO_COLOR"):
        return False
    if any(os.environ.get(name, "0") not in {"", "0"} for name in ("FORCE_COLOR", "CLICOLOR_FORCE")):
        return True
    return stream is not None and stream.isatty() and os.environ.get("TERM") != "dumb"


def place_lines(what: str, place: Span) -> Iterator[str]:
    """Yield `WHAT at FILE:LINE:COLUMN`, the source line and a caret under the place."""
    from linkforge_compile.diagnostics.render_text import snippet

    yield on_one_line(f"{what} at {place}")
    yield from snippet(place)


@contextmanager
def progress_after(doing: str, arguments: argparse.Namespace) -> Iterator[None]:
    """On a terminal, print what is being done if the body takes longer than PATIENCE: `reading robot.urdf`."""
    if sys.stderr is None or not sys.stderr.isatty():
        yield
        return
    from threading import Timer

    timer = Timer(PATIENCE, print_status, (f"still {doing}; Ctrl-C ends it", arguments))
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()


def status_at_intervals(arguments: argparse.Namespace) -> Callable[[str], None]:
    """Return a function that prints what it is told as a status, once in each PROGRESS_INTERVAL."""
    last = monotonic()

    def tell(text: str) -> None:
        nonlocal last
        if monotonic() - last > PROGRESS_INTERVAL:
            last = monotonic()
            print_status(text, arguments)

    return tell


def progress(items: Sequence[_Item], done: str, arguments: argparse.Namespace) -> Iterator[_Item]:
    """Yield items, and print each PROGRESS_INTERVAL how many of them are done, such as "compiled 12 of 30 specs".

    Nothing is printed for a build system, which prints its own status.
    """
    last = monotonic()
    for number, item in enumerate(items):
        if number and monotonic() - last > PROGRESS_INTERVAL:
            last = monotonic()
            if arguments.depfile is None:
                print_status(f"{done} {number} of {len(items)} specs", arguments)
        yield item


def _parse_codes(text: str) -> list[str]:
    """Parse codes or beginnings of codes, separated by commas or spaces."""
    import argparse

    from linkforge_compile.diagnostics.codes import REGISTER
    from linkforge_compile.diagnostics.suggest import did_you_mean

    codes = text.upper().replace(",", " ").split()
    for code in codes:
        if not any(known.startswith(code) for known in REGISTER):
            raise argparse.ArgumentTypeError(f"no diagnostic has the code '{code}'{did_you_mean(code, REGISTER)}")
    return codes


def _parse_ignorable_codes(text: str) -> list[str]:
    import argparse

    from linkforge_compile.diagnostics.codes import REGISTER

    codes = _parse_codes(text)
    for code in codes:
        severities = {one.severity for one in REGISTER.values() if one.id.startswith(code)}
        if severities == {Severity.ERROR}:
            kind = "is an error" if code in REGISTER else "selects only errors"
            raise argparse.ArgumentTypeError(f"{code} {kind}, which cannot be ignored")
    return codes


def is_code(word: str) -> bool:
    """Whether a word has the form of a code, LF and digits in either case; the code may be unknown."""
    return re.fullmatch(r"LF\d+", word, re.IGNORECASE) is not None


def manual_page(word: str, *, styled: bool) -> str:
    """Return the manual page of a code as Markdown, or styled for a terminal; UsageError for an unknown code."""
    from linkforge_compile.diagnostics.codes import REGISTER
    from linkforge_compile.diagnostics.suggest import did_you_mean
    from linkforge_compile.resources import manual_folder

    name = word.upper()
    if name not in REGISTER:
        raise UsageError(f"no diagnostic has the code '{name}'{did_you_mean(name, REGISTER)} (--codes lists all)")
    file = manual_folder() / f"{name}.md"
    text = file.read_text("utf-8") if file.is_file() else f"# {heading(REGISTER[name])}\n"
    return "".join(f"{line}\n" for line in _styled(text)) if styled else text


def heading(code: Code) -> str:
    """Return the first line of a code's page, without the `# `."""
    return f"{code.id}: {code.title}"


def register_table() -> str:
    """Return a line for each code, with its severity and title."""
    from linkforge_compile.diagnostics.codes import REGISTER

    width = max(len(code.severity) for code in REGISTER.values())
    codes = sorted(REGISTER.values(), key=lambda code: code.id)
    return "".join(f"{code.id}  {code.severity:{width}}  {code.title}\n" for code in codes)


def _styled(text: str) -> Iterator[str]:
    """Yield lines of Markdown with headings in bold, code in color and examples indented."""
    is_example = False
    for line in text.splitlines():
        if line.startswith("```"):
            is_example = not is_example
            # A fence may name the example's file.
            _, _, file = line.partition(" file=")
            if file:
                yield f"{file}:"
        elif is_example:
            yield f"    {CYAN}{line}{RESET}" if line else ""
        elif line.startswith("#"):
            yield f"{BOLD}{line.lstrip('#').lstrip()}{RESET}"
        else:
            yield re.sub(r"`([^`]+)`", rf"{CYAN}\1{RESET}", line)
