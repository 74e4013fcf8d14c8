"""`linkforge check --fix`: applies the safe fixes of a report and writes the files."""

from __future__ import annotations

import argparse
import os
from collections.abc import Callable, Collection, Iterable, Mapping
from pathlib import Path
from typing import TypeVar

from linkforge_compile.cli.reports import print_status
from linkforge_compile.cli.specs import count
from linkforge_compile.fixing import Report, apply_safe_fixes, files_to_fix
from linkforge_compile.roots import identity, top_of
from linkforge_compile.source.characters import on_one_line

_Report = TypeVar("_Report", bound=Report)


def fix_files(
    check: Callable[[Mapping[str, str]], _Report], specs: Iterable[str], arguments: argparse.Namespace
) -> _Report:
    """Apply safe fixes until none is left, write the files, and return the report of what remains.

    `check` reports on the specs with texts in place of files, by real path. Only files of the packages or repositories
    of the specs are changed. A fix that brings an error is not applied.
    """
    tops = {Path(identity(top_of(Path(spec)))) for spec in specs}
    fixed = apply_safe_fixes(check, lambda path: _may_change(path, tops))
    _write(fixed.texts, fixed.numbers, arguments)
    for line in fixed.refused:
        print_status(line, arguments)
    for path in sorted(files_to_fix(fixed.report)):
        if _is_in(path, tops) and path.is_file() and not os.access(path, os.W_OK):
            print_status(f"did not change {path}: it is read-only", arguments)
    return fixed.report


def _may_change(path: Path, tops: Collection[Path]) -> bool:
    """Whether a file may be written, is in one of the folders, and is UTF-8."""
    if not _is_in(path, tops) or not os.access(path, os.W_OK) or not path.is_file():
        return False
    try:
        path.read_text("utf-8")
    except (OSError, UnicodeDecodeError):
        return False
    return True


def _is_in(path: Path, tops: Collection[Path]) -> bool:
    """Whether a file, or the one that it links to, is in one of the folders."""
    real = Path(identity(path))
    return any(real.is_relative_to(top) for top in tops)


def _write(texts: Mapping[Path, str], numbers: Mapping[Path, int], arguments: argparse.Namespace) -> None:
    """Write the files, or print their differences, and how many problems were fixed in each."""
    from linkforge_compile.cli.output import unified, write_changed, write_to_stdout

    if arguments.diff:
        for path, text in texts.items():
            write_to_stdout(unified(on_one_line(str(path)), path.read_bytes().decode(), text, "fixed"))
    else:
        write_changed(texts)
    for path, number in numbers.items():
        print_status(f"{'would fix' if arguments.diff else 'fixed'} {count(number, 'problem')} in {path}", arguments)
