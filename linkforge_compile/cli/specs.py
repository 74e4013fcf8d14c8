"""Finds the specs that the words of a command line name: themselves, or every spec below a folder."""

from __future__ import annotations

import os
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.cli import UsageError
from linkforge_compile.cli.options import compile_spec, packages_of, require_one_spec, split_assignments
from linkforge_compile.cli.reports import report
from linkforge_compile.diagnostics import Code, Diagnostic, Note
from linkforge_compile.diagnostics.codes.modules import NO_SPEC_BELOW, OUTSIDE_ROOTS, UNREADABLE_FILE

if TYPE_CHECKING:
    import argparse

    from linkforge_compile.core.models.robot import Robot

_MAX_SPECS = 5_000
"""The most specs in one folder; more are hardly the sources of robots."""


class FoundSpecs(NamedTuple):
    """The specs in the order named, those of them that were found in folders, and what could not be searched."""

    specs: tuple[str, ...]
    in_folders: frozenset[str]
    faults: tuple[Diagnostic, ...]


def is_folder(word: str) -> bool:
    """Whether a word of the command line names a folder."""
    # Path.is_dir raises for a name that is too long.
    return os.path.isdir(word)  # noqa: PTH112


def find_specs_of(words: Sequence[str], arguments: argparse.Namespace) -> FoundSpecs:
    """Return the specs that words name, each once; a folder names every spec below it.

    Folders that cannot be read, in which specs may be, are reported, and links that may not be followed.
    """
    unread: list[Diagnostic] = []
    by_word = {word: _find(word, arguments, unread.append) if is_folder(word) else (word,) for word in words}
    specs = _without_repeats(spec for some in by_word.values() for spec in some)
    in_folders = frozenset(spec for word, some in by_word.items() if is_folder(word) for spec in some)
    empty = (NO_SPEC_BELOW.at(None, path=word) for word, below in by_word.items() if not below)
    return FoundSpecs(specs, in_folders.difference(words), tuple(unread or empty))


def _without_repeats(specs: Iterable[str]) -> tuple[str, ...]:
    """Return the specs without those that are another one by a longer way, such as `./arm.robot.yaml`.

    A link to a spec is one by itself: its outputs have its own name.
    """
    by_path: dict[str, str] = {}
    for spec in specs:
        folder, name = os.path.split(spec)
        by_path.setdefault(spec if spec == "-" else os.path.join(os.path.realpath(folder), name), spec)  # noqa: PTH118
    return tuple(by_path.values())


def _find(word: str, arguments: argparse.Namespace, report: Callable[[Diagnostic], object]) -> tuple[str, ...]:
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


class OneSpec(NamedTuple):
    """The spec of a command line, its robot, and the files that it was made from."""

    spec: str
    robot: Robot
    files: tuple[Path, ...]


def compile_one(arguments: argparse.Namespace) -> OneSpec | None:
    """Compile the one spec of a command line, and report on it; None if it has errors."""
    words, assignments = split_assignments(arguments.words)
    spec = require_one_spec(words)
    compilation = compile_spec(spec, assignments, arguments)
    if report(compilation.diagnostics, arguments) or compilation.robot is None:
        return None
    return OneSpec(spec, compilation.robot, compilation.files)


class SpecReport(NamedTuple):
    """The diagnostics of a spec, and the files that it was made from."""

    diagnostics: tuple[Diagnostic, ...]
    files: Collection[Path]


def find_parts(reports: Mapping[str, SpecReport], codes: Collection[Code]) -> frozenset[str]:
    """Return the specs that are parts of others, and by themselves lack what the `codes` report, such as a name.

    The report of the other spec has their diagnostics, among them what a module lacks that is used.
    """

    def lacks(spec: str, report: SpecReport) -> bool:
        spans = (one.span for one in report.diagnostics if one.code in codes)
        return any(span is not None and span.file.path == Path(spec) for span in spans)

    lacking = {spec for spec, report in reports.items() if lacks(spec, report)}
    whole = (report for spec, report in reports.items() if spec not in lacking)
    files = {os.path.realpath(file) for report in whole for file in report.files}
    return frozenset(spec for spec in lacking if os.path.realpath(spec) in files)


def count(number: int, noun: str) -> str:
    """Return such as "1 spec", "2 specs" or "no specs"."""
    return f"{number or 'no'} {noun}{'' if number == 1 else 's'}"
