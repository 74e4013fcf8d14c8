"""`linkforge import --refresh`: import a spec again, and tell what of the specs that use it no longer fits."""

from __future__ import annotations

import argparse
import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, NoReturn

from linkforge_compile.cli import FAULTY_SPEC, OK, UsageError
from linkforge_compile.cli.diff_text import difference_lines
from linkforge_compile.cli.options import Parser, packages_of, parse_packages, split_assignments
from linkforge_compile.cli.reports import print_failure, print_status, progress_after, report
from linkforge_compile.cli.specs import count
from linkforge_compile.diagnostics import Diagnostic, Severity
from linkforge_compile.export_spec import UnknownPathError, explain
from linkforge_compile.export_spec.replacements import Replacement, replacements_in
from linkforge_compile.roots import Roots, identity, is_file

if TYPE_CHECKING:
    from linkforge_compile.analysis import Packages, Settings
    from linkforge_compile.compare import Difference
    from linkforge_compile.core import Robot
    from linkforge_compile.importers.origin import Head
    from linkforge_compile.importing import Import
    from linkforge_compile.source import Span


def refresh(arguments: argparse.Namespace, add_arguments: Callable[[Parser], None]) -> int:
    """Write a spec as its vendor's files are now; FAULTY_SPEC for errors, and if `--check` finds something to write.

    `add_arguments` adds those of `linkforge import`, with which the command in the spec is read.
    """
    spec = _spec_of(arguments)
    # Bytes that are no text are no part of what an import wrote.
    before = spec.read_text("utf-8", "replace")
    head = _head_of(spec, before)
    if head.is_edited and not arguments.force:
        raise UsageError(
            f"'{spec}' was edited since its import, and a refresh would undo that; move the edits to the `override` of "
            "a spec that uses it, or use --force to lose them"
        )
    parser = _HeadParser(spec)
    add_arguments(parser)
    with progress_after(f"reading {spec}", arguments):
        imported = _import_again(spec, parser.parse_words(head.words), arguments)
    is_faulty = report(imported.diagnostics, arguments) or imported.has_errors
    if imported.text is None or imported.origin is None:
        return FAULTY_SPEC
    after = imported.origin.with_head(imported.text, spec)
    if after == before:
        print_status(f"{spec} is up to date", arguments)
        return FAULTY_SPEC if is_faulty else OK
    with progress_after("compiling the specs that use it", arguments):
        users = list(_users_of(spec, after, arguments))
    _print_differences(spec, after, users, arguments)
    no_longer_fits = _report_users(users, arguments)
    if arguments.check:
        print_status(f"{spec} would be written", arguments)
        return FAULTY_SPEC
    from linkforge_compile.cli.output import write_document

    write_document(after, spec, arguments)
    return FAULTY_SPEC if is_faulty or no_longer_fits else OK


class _HeadParser(Parser):
    """Parses the command at the top of a spec; what is wrong in it is wrong in the spec."""

    def __init__(self, spec: Path) -> None:
        super().__init__(add_help=False)
        self._spec = spec

    def error(self, message: str) -> NoReturn:
        raise UsageError(f"the command at the top of '{self._spec}' is wrong: {message}; correct it")


def _spec_of(arguments: argparse.Namespace) -> Path:
    specs, assignments = split_assignments(arguments.words)
    given = [*assignments, *arguments.parameters, *filter(None, (arguments.srdf, arguments.output))]
    if given:
        raise UsageError(f"--refresh takes arguments from the spec, so '{given[0]}' is not allowed; import it anew")
    if len(specs) != 1 or not specs[0].lower().endswith((".yaml", ".yml")):
        raise UsageError("--refresh takes the spec that an import wrote")
    spec = Path(specs[0])
    if not is_file(spec):
        raise UsageError(f"there is no file '{spec}'")
    return spec


def _head_of(spec: Path, text: str) -> Head:
    from linkforge_compile.importers.origin import read_head

    head = read_head(text)
    if head is None:
        raise UsageError(
            f"'{spec}' does not begin with the command that imported it and its digests, so it is not an imported "
            f"spec; "
            "give the one that 'linkforge import' wrote, or import the robot into a new file; for migrated specs "
            "there is 'linkforge migrate --verify'"
        )
    return head


def _import_again(spec: Path, written: argparse.Namespace, arguments: argparse.Namespace) -> Import:
    """Import what the command in the spec names, as seen from the folder of the spec."""
    from linkforge_compile.importing import import_urdf

    if written.allow_outside and not arguments.allow_outside:
        raise UsageError(f"'{spec}' was imported with --allow-outside; add it if you trust the files that it names")
    robots, assignments = split_assignments(written.words)
    if len(robots) != 1:
        raise UsageError(f"the command at the top of '{spec}' names {count(len(robots), 'robot')}; correct it")
    folder, given = spec.parent, packages_of(arguments)
    robot, srdf = folder / robots[0], folder / written.srdf if written.srdf else None
    packages = {name: place for name, place in _packages_in(spec, written).items() if name not in given}
    if not arguments.allow_outside:
        _require_inside(spec, [robot, *([srdf] if srdf else []), *map(Path, packages.values())], given)
    return import_urdf(
        robot,
        srdf=srdf,
        arguments=assignments,
        packages={**packages, **given},
        allow_outside=arguments.allow_outside,
        output=folder,
    )


def _require_inside(spec: Path, named: Iterable[Path], packages: Packages) -> None:
    """Refuse files and folders that the spec, which may be a stranger's, names outside of what it may read."""
    roots = Roots.around(spec, (Path(), *map(Path, packages.values())))
    for path in named:
        if not roots.hold(path):
            raise UsageError(
                f"the command at the top of '{spec}' names '{path}', which is outside of the folders that a spec may "
                f"read: {roots}; run this in a folder around both, name the folder with --package NAME=FOLDER, or use "
                "--allow-outside if you trust the spec"
            )


def _packages_in(spec: Path, written: argparse.Namespace) -> dict[str, str]:
    try:
        packages = parse_packages(written.packages, "--package", spec.parent)
    except UsageError as error:
        raise UsageError(f"the command at the top of '{spec}' has {error}; correct it") from error
    return {name: _without_detour(folder) for name, folder in packages.items()}


def _without_detour(folder: str) -> str:
    """Return a folder as the import had it: paths in the spec, `$(find …)`, are absolute ones below it."""
    plain = os.path.normpath(folder)
    # After a link, `..` may lead elsewhere.
    return plain if os.path.realpath(plain) == os.path.realpath(folder) else folder


def _print_differences(spec: Path, after: str, users: Iterable[_User], arguments: argparse.Namespace) -> None:
    """Print what differs in the robot of the spec, if it can be compiled before and after, and what overrides hide."""
    from linkforge_compile.analysis import analyse_path
    from linkforge_compile.cli.output import write_to_stdout
    from linkforge_compile.compare import compare, removed_public_names

    old, new = (analyse_path(spec, one).compilation.robot for one in _settings(spec, after, arguments))
    if old is None or new is None:
        return
    differences = compare(old, new)
    if differences:
        differences = with_hidden_marked(differences, new, filter(None, (user.robot for user in users)))
        labels = (f"{spec} as it is", "as imported now")
        lines = difference_lines(labels, differences, removed_public_names(old, new))
        write_to_stdout("".join(f"{line}\n" for line in lines))
    else:
        print_status(f"{spec} is the same robot; its text differs", arguments)


class _User(NamedTuple):
    """A spec that reads the refreshed one, the diagnostics that it did not have before, and its robot, if any."""

    spec: Path
    news: tuple[Diagnostic, ...]
    robot: Robot | None

    @property
    def fits(self) -> bool:
        return all(one.severity is not Severity.ERROR for one in self.news)


def _report_users(users: Iterable[_User], arguments: argparse.Namespace) -> bool:
    """Report what is new in the specs that use the refreshed one; True if there are errors."""
    is_faulty = report((one for user in users for one in user.news), arguments)
    for user in users:
        if user.fits:
            print_status(f"{user.spec} still fits", arguments)
        else:
            errors = sum(one.severity is Severity.ERROR for one in user.news)
            print_failure(f"{user.spec} no longer fits: {count(errors, 'error')}", arguments)
    return is_faulty


def _users_of(spec: Path, after: str, arguments: argparse.Namespace) -> Iterator[_User]:
    """Compile the specs below the working folder, and below that of the spec, that use it."""
    from linkforge_compile.analysis import analyse_path

    old, new = _settings(spec, after, arguments)
    for other in _specs_around(spec):
        before = analyse_path(other, old).compilation
        if identity(spec) in map(identity, before.files):
            known = {(one.code, one.message) for one in before.diagnostics}
            now = analyse_path(other, new).compilation
            news = tuple(one for one in now.diagnostics if (one.code, one.message) not in known)
            yield _User(other, news, now.robot)


def _settings(spec: Path, after: str, arguments: argparse.Namespace) -> tuple[Settings, Settings]:
    """Return how specs are compiled with the spec as it is, and with a new text in its place."""
    from linkforge_compile.analysis import Settings
    from linkforge_compile.expand import Unset

    settings = Settings(packages=packages_of(arguments), unset=Unset.NOTE, allow_outside=arguments.allow_outside)
    buffers: Mapping[str, str] = {identity(spec): after}
    return settings, settings._replace(buffers=buffers)


def _specs_around(spec: Path) -> list[Path]:
    """Return the other specs below the working folder, and below that of the spec."""
    from linkforge_compile.editor.folders import TooManyFilesError, find_specs

    try:
        found = {identity(other): other for folder in (Path(), spec.parent) for other in find_specs(folder)}
    except TooManyFilesError as error:
        raise UsageError(f"there are {error} here; run it in the folder of the robots that use the spec") from error
    return [other for real, other in found.items() if real != identity(spec)]


def with_hidden_marked(
    differences: Iterable[Difference], imported: Robot, users: Iterable[Robot]
) -> tuple[Difference, ...]:
    """Return the differences of `imported` from what it was; a changed value names the overrides that hide it."""
    replacements = [one for user in users for one in replacements_in(user)]
    return tuple(_marked(one, imported, replacements) if one.kind == "changed" else one for one in differences)


def _marked(difference: Difference, imported: Robot, replacements: Sequence[Replacement]) -> Difference:
    # Explaining a value takes long, and most have no override.
    same_key = [one for one in replacements if one.key in difference.path]
    place = _written_place("/".join(difference.path), imported) if same_key else None
    if place is None:
        return difference
    hiding = [one.value for one in same_key if _is_in(place, one.replaced)]
    places = dict.fromkeys(f"{span.file.shown}:{span.line}" for span in hiding)
    if not places:
        return difference
    overrides = "override" if len(places) == 1 else "overrides"
    return replace(difference, text=f"{difference.text}, hidden by the {overrides} at {', '.join(places)}")


def _written_place(path: str, robot: Robot) -> Span | None:
    try:
        explanation = explain(robot, path)
    except UnknownPathError:
        return None
    return explanation.provenance.span if explanation.is_written and explanation.provenance else None


def _is_in(place: Span, other: Span) -> bool:
    """Whether a place lies in another one, which another compile has read."""
    file, other_file = place.file.path, other.file.path
    if file is None or other_file is None or identity(file) != identity(other_file):
        return False
    return other.start <= place.start and place.end <= other.end
