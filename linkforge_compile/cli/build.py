"""Compiles a spec, renders its outputs, compares them with existing files, and reports and writes them."""

from __future__ import annotations

import argparse
from collections import Counter, defaultdict
from collections.abc import Sequence
from itertools import zip_longest
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.banner import banner_of
from linkforge_compile.cli import FAULTY_SPEC, OK, UsageError
from linkforge_compile.cli.options import compile_spec, format_options_of
from linkforge_compile.cli.reports import errors_of, format_diagnostics, print_status, select, write_to_stderr
from linkforge_compile.cli.specs import count
from linkforge_compile.cli.targets import file_to_write
from linkforge_compile.diagnostics import Diagnostic, Note
from linkforge_compile.diagnostics.codes.formats import MISSING_OUTPUT, STALE_OUTPUT
from linkforge_compile.formats import Rendering, format_named, render_documents
from linkforge_compile.source import SourceFile, Span
from linkforge_compile.source.characters import on_one_line

if TYPE_CHECKING:
    import argparse
    from collections.abc import Iterator

    from linkforge_compile.cli.targets import Targets
    from linkforge_compile.core import Robot
    from linkforge_compile.formats.user_templates import TemplateFolder
    from linkforge_compile.pipeline import Compilation


_LONGEST_QUOTE = 120
"""The most characters of a line that a message quotes."""


class Output(NamedTuple):
    """A text and its file, None for standard output."""

    path: Path | None
    text: str


class Build(NamedTuple):
    """The outputs of one spec in a variant (None: the defaults), the files that they were made from, and diagnostics.

    There are no outputs if one of them cannot be made. `template_folders` are those of linkforge's templates that were
    rendered, empty for all: a user's templates may include any.
    """

    spec: str
    variant: str | None
    outputs: tuple[Output, ...]
    sources: tuple[Path, ...]
    diagnostics: tuple[Diagnostic, ...]
    template_folders: frozenset[str]


class BuildRequest(NamedTuple):
    """What to build: a spec with assignments to its parameters, the targets, and the user's templates if any.

    `variant` is the one of the spec, None for the defaults.
    """

    spec: str
    assignments: list[str]
    targets: Targets
    templates: TemplateFolder | None = None
    variant: str | None = None

    @property
    def template_files(self) -> tuple[Path, ...]:
        """The templates that were read so far."""
        return self.templates.files if self.templates else ()


def targets_for(robot: Robot, targets: Targets) -> tuple[Targets, tuple[Diagnostic, ...]]:
    """Return the targets for which the robot has content, and diagnostics about requested ones without."""
    missing = {name: why for name in targets.formats if (why := format_named(name).missing(robot))}
    return targets.without(missing), tuple(missing.values()) if targets.is_requested else ()


def compile_request(request: BuildRequest, arguments: argparse.Namespace) -> Compilation:
    """Compile the spec of a request with the options of `linkforge compile`."""
    folders = request.targets.folders(arguments.installed_in)
    formats, variant = request.targets.formats, request.variant
    spec, assignments = request.spec, request.assignments
    return compile_spec(spec, assignments, arguments, folders=folders, formats=formats, variant=variant)


def render_request(request: BuildRequest, compilation: Compilation, arguments: argparse.Namespace) -> Build:
    """Render the outputs of a compilation, and compare them with files for `--check`."""
    outputs, faults = ((), ()) if compilation.robot is None else _render(compilation.robot, request, arguments)
    diagnostics = compilation.diagnostics
    if faults:
        diagnostics = tuple(sorted((*diagnostics, *faults), key=lambda one: one.order))
    stale = tuple(_find_stale(outputs, request, compilation.robot)) if arguments.check else ()
    sources = (*compilation.files, *request.template_files)
    folders = frozenset[str]() if request.templates else request.targets.template_folders
    return Build(request.spec, request.variant, outputs, sources, (*diagnostics, *stale), folders)


def _render(
    robot: Robot, request: BuildRequest, arguments: argparse.Namespace
) -> tuple[tuple[Output, ...], tuple[Diagnostic, ...]]:
    """Return all outputs, or none if one cannot be rendered, and diagnostics about them."""
    targets, faults = targets_for(robot, request.targets)
    if faults:
        return (), faults
    name = Path(request.spec).name
    banner = None if request.spec == "-" else banner_of(on_one_line(name))
    options = format_options_of(arguments)
    if request.templates is None:
        rendering = Rendering(options, banner=banner, has_map=arguments.source_map)
        return tuple(_render_formats(robot, targets, rendering)), ()
    from linkforge_compile.formats.user_templates import TemplateError

    try:
        if targets.are_documents:
            texts = render_documents(robot, request.templates, options, banner or "")
            outputs = tuple(Output(path, texts[name]) for name, path in targets.paths.items())
        else:
            rendering = Rendering(options, banner=banner, templates=request.templates)
            outputs = tuple(_render_formats(robot, targets, rendering))
        return outputs, request.templates.unused
    except TemplateError as error:
        return (), error.diagnostics


def _render_formats(robot: Robot, targets: Targets, rendering: Rendering) -> Iterator[Output]:
    """Yield the documents of each format, each with its source map if that is requested."""
    for format_, target in targets.paths.items():
        documents = format_named(format_).render(robot, rendering)
        if target is None:
            if len(documents) > 1:
                raise UsageError(
                    f"{format_} is {len(documents)} files, and standard output takes one; write -o FOLDER/"
                )
            yield Output(None, documents[0].text)
            continue
        for text, name, map_ in documents:
            path = target / name  # without a name, the target itself
            yield Output(path, text)
            if map_ is not None:
                from linkforge_compile.formats.map_file import ENDING, map_text

                yield Output(path.with_name(path.name + ENDING), map_text(text, map_, path.name, path.parent))


def _find_stale(outputs: Sequence[Output], request: BuildRequest, robot: Robot | None) -> Iterator[Diagnostic]:
    """Yield a diagnostic for each file that is missing or differs from its output."""
    # Tools that collect diagnostics show only those with a place.
    place = Span(robot.source.span.file, 1, 1, 1, 1) if robot and robot.source else None
    for path, text in outputs:
        assert path is not None, "only files are compared"
        try:
            found = path.read_bytes().decode("utf-8", errors="replace")
        except FileNotFoundError:
            yield MISSING_OUTPUT.at(place, path=path, spec=request.spec)
            continue
        except OSError as error:
            raise UsageError(f"cannot read '{path}': {error.strerror}") from error
        # git may have converted line ends to those of the system.
        found = found.replace("\r\n", "\n")
        if found != text:
            yield _first_difference(SourceFile(str(path), found, path), text, request)


def _first_difference(file: SourceFile, text: str, request: BuildRequest) -> Diagnostic:
    """Return the diagnostic for a file that should contain the text, at the first line that differs."""
    pairs = zip_longest(file.text.split("\n"), text.split("\n"))
    number, found, expected = next((at, *pair) for at, pair in enumerate(pairs, 1) if pair[0] != pair[1])
    span = Span(file, number, 1, number, 1 + len(found or ""))
    notes = []
    if request.templates:
        notes = [Note(f"the templates in '{request.templates.folder}' make it of the spec, and may have changed")]
    return STALE_OUTPUT.at(span, spec=request.spec, expected=_quote(expected), notes=notes)


def _quote(line: str | None) -> str:
    line = (line or "").strip()
    if not line:
        return "nothing"
    return f"'{line if len(line) <= _LONGEST_QUOTE else line[:_LONGEST_QUOTE] + '…'}'"


_LISTED = 3
"""The most files up to date of which each has a line."""


def deliver(builds: Sequence[Build], arguments: argparse.Namespace, faults: tuple[Diagnostic, ...] = ()) -> int:
    """Report on builds, write the outputs of those without errors, and return the exit code.

    `faults` are those of the search for specs. Nothing is written if an output would replace a source of any build.
    """
    if any(build.outputs for build in builds):
        from linkforge_compile.cli.output import refuse_to_replace

        outputs = [output.path for build in builds for output in build.outputs]
        sources = dict.fromkeys(source for build in builds for source in build.sources)
        refuse_to_replace(sources, (*outputs, file_to_write(arguments.depfile)))
    chosen = select(_diagnostics_of(builds, faults), arguments)
    runs = [select(build.diagnostics, arguments) for build in builds]
    write_to_stderr(format_diagnostics(chosen, arguments, runs))
    right = [build for build, run in zip(builds, runs, strict=True) if build.outputs and not errors_of(run)]
    is_whole = len(right) == len(builds) and not faults
    if arguments.depfile is not None:
        # A build system prints its own status, and colcon shows any output on standard error as a warning.
        _write(right, _depfile(right, arguments.depfile) if is_whole else ())
    elif right or len(builds) != 1:
        written = frozenset() if arguments.check else _write(right)
        _print_status(builds, right, written, chosen, arguments)
    return OK if is_whole else FAULTY_SPEC


def _diagnostics_of(builds: Sequence[Build], faults: tuple[Diagnostic, ...]) -> tuple[Diagnostic, ...]:
    """Return the diagnostics of all builds, each once; those of some variants of a spec say of which."""
    if len(builds) == 1:
        return (*faults, *builds[0].diagnostics)
    from linkforge_compile.diagnostics.reports import merge_reports, without_repeats

    runs = defaultdict[str, dict[str, tuple[Diagnostic, ...]]](dict)
    for build in builds:
        runs[build.spec][f"variant '{build.variant}'"] = build.diagnostics
    of_specs = (one for of_variants in runs.values() for one in merge_reports(of_variants))
    return without_repeats((*faults, *of_specs))


def _print_status(
    builds: Sequence[Build],
    right: Sequence[Build],
    written: frozenset[Path],
    diagnostics: tuple[Diagnostic, ...],
    arguments: argparse.Namespace,
) -> None:
    """Print a line for each file of a single build, one summary of several builds or of many files up to date."""
    paths = [output.path for build in right for output in build.outputs if output.path is not None]
    if len(builds) == 1:
        unchanged = [path for path in paths if path not in written]
        is_short = len(unchanged) <= _LISTED
        for path in paths:
            if path in written:
                print_status(f"wrote {path}", arguments)
            elif is_short:
                print_status(f"{path} is up to date", arguments)
        if not is_short:
            print_status(f"{count(len(unchanged), 'file')} are up to date", arguments)
        return
    from linkforge_compile.diagnostics.render_text import summary

    states = Counter("written" if path in written else "up to date" for path in paths)
    files = "".join(f", {count(number, 'file')} {state}" for state, number in states.items())
    done = "checked" if arguments.check else "compiled"
    print_status(f"{done} {_right_specs(builds, right)}{files}: {summary(diagnostics)}", arguments)


def _right_specs(builds: Sequence[Build], right: Sequence[Build]) -> str:
    """Return such as "3 specs", or "1 of 3 specs" where others have errors in a variant."""
    specs = {build.spec for build in builds}
    faulty = {build.spec for build in builds if build not in right}
    if not faulty:
        return count(len(specs), "spec")
    return f"{len(specs) - len(faulty) or 'none'} of {count(len(specs), 'spec')}"


def _write(builds: Sequence[Build], further: Sequence[Output] = ()) -> frozenset[Path]:
    """Write all outputs; return the files that were written, without those that are up to date."""
    from linkforge_compile.cli.output import write_changed

    outputs = (*(output for build in builds for output in build.outputs), *further)
    texts = {output.path: output.text for output in outputs if output.path is not None}
    return write_changed(texts, next((output.text for output in outputs if output.path is None), None))


def _depfile(builds: Sequence[Build], name: str) -> tuple[Output, ...]:
    """Return the depfile, with a rule for the outputs of each spec."""
    from linkforge_compile.cli.output import inputs_of, make_rules

    def rule(build: Build) -> str:
        paths = [output.path for output in build.outputs if output.path is not None]
        return make_rules(paths, inputs_of(build.sources, build.template_folders))

    return (Output(file_to_write(name), "".join(map(rule, builds))),)
