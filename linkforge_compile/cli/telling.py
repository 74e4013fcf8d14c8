"""How a command tells what it found: in which form, which of it, and where."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from linkforge_compile.cli.colour import WHEN, is_coloured
from linkforge_compile.diagnostics import Diagnostic, Severity
from linkforge_compile.diagnostics.render import FORMS
from linkforge_compile.source.characters import on_one_line

if TYPE_CHECKING:
    import argparse

    from linkforge_compile.diagnostics import Code


def add_telling_options(parser: argparse.ArgumentParser, *, is_product: bool = False) -> None:
    """Add them; `is_product` for a command that makes nothing but diagnostics, where `--format` means them too."""
    group = parser.add_argument_group("diagnostics")
    group.add_argument(
        "--diagnostics",
        *(["--format"] if is_product else []),
        choices=FORMS,
        default="text",
        help="how they are written: text (unless said), json, github (annotations) or sarif",
    )
    group.add_argument(
        "--select", metavar="CODES", type=_codes, action="extend", default=[], help="only these warnings and notes"
    )
    group.add_argument(
        "--ignore",
        metavar="CODES",
        type=_ignorable_codes,
        action="extend",
        default=[],
        help="not these warnings and notes; codes or their beginnings, such as LF5,LF6003",
    )
    group.add_argument("--werror", action="store_true", help="take warnings for errors")
    group.add_argument("-q", "--quiet", action="store_true", help="tell errors only, and nothing when all is well")
    group.add_argument("--color", choices=WHEN, default="auto", help="whether text is coloured (on a terminal)")


def selected(diagnostics: Iterable[Diagnostic], arguments: argparse.Namespace) -> tuple[Diagnostic, ...]:
    """Return what the options leave of a report, weighed as they say."""
    diagnostics = tuple(diagnostics)
    if not diagnostics:
        return ()
    from linkforge_compile.diagnostics.selection import Selection

    selection = Selection(tuple(arguments.select), tuple(arguments.ignore), arguments.werror, arguments.quiet)
    return selection.of(diagnostics)


def tell(diagnostics: Iterable[Diagnostic], arguments: argparse.Namespace) -> bool:
    """Write what the options leave to standard error, and return whether there are errors among it."""
    told = selected(diagnostics, arguments)
    to_stderr(written(told, arguments))
    return has_errors(told)


def has_errors(diagnostics: Iterable[Diagnostic]) -> bool:
    return any(diagnostic.severity is Severity.ERROR for diagnostic in diagnostics)


def say(line: str, arguments: argparse.Namespace) -> None:
    """Write what was done to standard error, unless that is to be quiet or to hold one document for a program."""
    if not arguments.quiet:
        say_failure(line, arguments)


def say_failure(line: str, arguments: argparse.Namespace) -> None:
    """Write what did not succeed to standard error, unless that is to hold one document for a program."""
    if getattr(arguments, "diagnostics", "text") in {"text", "github"}:
        line_to_stderr(line)


def line_to_stderr(line: str) -> None:
    """Write one line to standard error, where names of files can neither end it nor drive the terminal."""
    to_stderr(f"{on_one_line(line)}\n")


def to_stderr(text: str) -> None:
    """Write to standard error, which whoever started the command may have closed."""
    if sys.stderr is not None:
        sys.stderr.write(text)


def written(diagnostics: tuple[Diagnostic, ...], arguments: argparse.Namespace) -> str:
    """Return the diagnostics in the form that was asked for."""
    # A build on GitHub may run in any folder of the checkout; its annotations name files from the top.
    root = Path(os.environ.get("GITHUB_WORKSPACE") or Path.cwd()).absolute()
    match arguments.diagnostics:
        case "json":
            from linkforge_compile.diagnostics.render.json import render_json

            return render_json(diagnostics)
        case "github":
            from linkforge_compile.diagnostics.render.github import render_github

            return render_github(diagnostics, root=root)
        case "sarif":
            from linkforge_compile._version import __version__
            from linkforge_compile.diagnostics.render.sarif import render_sarif

            return render_sarif(diagnostics, root=root, version=__version__, manual=_page)
    return _text(diagnostics, arguments.color)


def _text(diagnostics: tuple[Diagnostic, ...], color: str) -> str:
    if not diagnostics:
        return ""
    from linkforge_compile.diagnostics.render.text import render_first

    text = render_first(diagnostics, colour=is_coloured(sys.stderr, color))
    if sys.stderr is None or not sys.stderr.isatty():
        return text
    worst = next((one for one in diagnostics if one.severity is Severity.ERROR), diagnostics[0])
    return f"{text}{worst.code.help} for more\n"


def _page(code: Code) -> str:
    from linkforge_compile.cli.manual import page

    return page(code.id, styled=False)


def _codes(text: str) -> list[str]:
    """Read codes and beginnings of codes, parted by commas or spaces."""
    import argparse

    from linkforge_compile.diagnostics.codes import REGISTER
    from linkforge_compile.diagnostics.suggest import did_you_mean

    codes = text.upper().replace(",", " ").split()
    for code in codes:
        if not any(known.startswith(code) for known in REGISTER):
            raise argparse.ArgumentTypeError(f"no diagnostic has the code '{code}'{did_you_mean(code, REGISTER)}")
    return codes


def _ignorable_codes(text: str) -> list[str]:
    import argparse

    from linkforge_compile.diagnostics.codes import REGISTER

    codes = _codes(text)
    for code in codes:
        meant = {one.severity for one in REGISTER.values() if one.id.startswith(code)}
        if meant == {Severity.ERROR}:
            kind = "is an error" if code in REGISTER else "stands for errors only"
            raise argparse.ArgumentTypeError(f"{code} {kind}, which cannot be ignored")
    return codes
